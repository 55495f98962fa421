// JourneyService.ExportJourney and ImportJourney: a map as one file, in chunks.
#ifndef SERVER_SERVICE_ARCHIVE_STREAMS_H_
#define SERVER_SERVICE_ARCHIVE_STREAMS_H_

#include <grpcpp/support/server_callback.h>

#include <atomic>
#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "homing/v1/journey_service.pb.h"
#include "server/rpc/chunk_stream.h"
#include "server/rpc/incoming_call.h"
#include "server/rpc/service_core.h"
#include "server/rpc/stream_watch.h"

namespace homing::server {

class ExportStream final : public ChunkStream<v1::ExportJourneyRequest, v1::ExportJourneyResponse> {
 public:
  ExportStream(ServiceCore* core, grpc::CallbackServerContext* context)
      : ChunkStream(core, context, Rpc::kExportJourney, &core->archives) {}

 private:
  absl::Status Prepare(const v1::ExportJourneyRequest& request, ServiceCore* core,
                       IncomingCall* call) override;
  absl::StatusOr<std::string> NextChunk() override;
  void Release(ServiceCore* core) override { core->export_bytes -= bytes_; }

  std::string file_;
  std::size_t written_ = 0;
  // This stream's part of core->export_bytes.
  std::int64_t bytes_ = 0;
};

// The stream owns itself until gRPC calls OnDone.
class ImportStream final
    : public grpc::ServerBidiReactor<grpc::ByteBuffer, v1::ImportJourneyResponse>,
      public OpenStream,
      public std::enable_shared_from_this<ImportStream> {
 public:
  ImportStream(ServiceCore* core, grpc::CallbackServerContext* context)
      : core_(core), call_(core, *context, Rpc::kImportJourney), watch_(core, context) {}

  void Open();
  void Drain() override {}
  void Tick() override;
  void OnReadDone(bool ok) override;
  void OnDone() override;

 private:
  void ReadNext();
  absl::Status TakeMessage();
  absl::Status Take(const v1::ImportJourneyRequest& request);
  absl::Status TakeChunk(const std::string& chunk);
  absl::Status Store();
  void Complete();
  void FinishWith(const absl::Status& status);
  void FreeFile();

  ServiceCore* const core_;
  IncomingCall call_;
  StreamWatch watch_;
  std::shared_ptr<ImportStream> self_;
  grpc::ByteBuffer bytes_;
  v1::ImportJourneyResponse response_;
  // True while the stream waits for the client. The thread that sets it to false continues the
  // stream.
  std::atomic<bool> reading_ = false;
  std::string name_;
  std::string file_;
  // This stream's part of core_->import_bytes.
  std::int64_t taken_ = 0;
};

}  // namespace homing::server

#endif  // SERVER_SERVICE_ARCHIVE_STREAMS_H_
