#include "server/service/store_service.h"

#include <istream>
#include <memory>
#include <string>

#include "homing/base/status_macros.h"
#include "server/rpc/chunk_stream.h"

namespace homing::server {
namespace {

class BackUpStream final : public ChunkStream<v1::BackUpStoreRequest, v1::BackUpStoreResponse> {
 public:
  BackUpStream(ServiceCore* core, grpc::CallbackServerContext* context)
      : ChunkStream(core, context, Rpc::kBackUpStore, &core->store_reads) {}

 private:
  absl::Status Prepare(const v1::BackUpStoreRequest& /*request*/, ServiceCore* core,
                       IncomingCall* call) override {
    HOMING_RETURN_IF_ERROR(call->Authorize(""));
    HOMING_ASSIGN_OR_RETURN(copy_, core->store->BackUp());
    return absl::OkStatus();
  }

  absl::StatusOr<std::string> NextChunk() override {
    std::string chunk(kChunkBytes, '\0');
    copy_->read(chunk.data(), static_cast<std::streamsize>(chunk.size()));
    if (copy_->bad()) {
      return absl::UnavailableError("the copy cannot be read");
    }
    chunk.resize(static_cast<std::size_t>(copy_->gcount()));
    return chunk;
  }

  std::unique_ptr<std::istream> copy_;
};

}  // namespace

StoreServiceHandler::StoreServiceHandler(ServiceCore* core) : ApiService(core) {
  AddStream<BackUpStream, v1::BackUpStoreResponse>(Rpc::kBackUpStore);
}

}  // namespace homing::server
