// Receives a file in chunks.
#ifndef CLIENT_CHUNK_FILE_H_
#define CLIENT_CHUNK_FILE_H_

#include <grpcpp/client_context.h>
#include <grpcpp/support/sync_stream.h>

#include <cerrno>
#include <ostream>

#include "absl/status/status.h"
#include "client/rpc_status.h"

namespace homing::client {

// Errors of the call; the system's, if `file` cannot be written.
template <typename Response>
absl::Status WriteChunks(grpc::ClientReaderInterface<Response>& reader,
                         grpc::ClientContext* context, std::ostream& file) {
  Response response;
  int error = 0;
  while (reader.Read(&response)) {
    errno = 0;
    file.write(response.chunk().data(), static_cast<std::streamsize>(response.chunk().size()));
    if (!file && error == 0) error = errno == 0 ? ENOSPC : errno;
    if (!file) context->TryCancel();
  }
  absl::Status status = FromGrpc(reader.Finish());
  return error == 0 ? status : absl::ErrnoToStatus(error, "cannot write the file");
}

}  // namespace homing::client

#endif  // CLIENT_CHUNK_FILE_H_
