// Receives a file in chunks.
#ifndef CLIENT_CHUNK_FILE_H_
#define CLIENT_CHUNK_FILE_H_

#include <grpcpp/client_context.h>
#include <grpcpp/support/sync_stream.h>

#include <ostream>

#include "absl/status/status.h"
#include "client/rpc_status.h"

namespace homing::client {

// Errors of the call; RESOURCE_EXHAUSTED: `file` cannot be written.
template <typename Response>
absl::Status WriteChunks(grpc::ClientReaderInterface<Response>& reader,
                         grpc::ClientContext* context, std::ostream& file) {
  Response response;
  while (reader.Read(&response)) {
    file.write(response.chunk().data(), static_cast<std::streamsize>(response.chunk().size()));
    if (!file) context->TryCancel();
  }
  absl::Status status = FromGrpc(reader.Finish());
  return file ? status : absl::ResourceExhaustedError("cannot write the file");
}

}  // namespace homing::client

#endif  // CLIENT_CHUNK_FILE_H_
