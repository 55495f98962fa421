#include "client/store_client.h"

#include <memory>

#include "client/chunk_file.h"
#include "homing/v1/store_service.grpc.pb.h"

namespace homing::client {

absl::Status BackUpStore(const Connection& connection, std::ostream& file,
                         const std::stop_token& stop) {
  const auto stub = v1::StoreService::NewStub(connection.channel());
  grpc::ClientContext context;
  const std::stop_callback cancel(stop, [&context] { context.TryCancel(); });
  return WriteChunks<v1::BackUpStoreResponse>(*stub->BackUpStore(&context, {}), &context, file);
}

}  // namespace homing::client
