// The observations of a robot and the answers to them, as an MCAP file for Foxglove's panels.
#ifndef CLIENT_COMMAND_ANSWER_BAG_H_
#define CLIENT_COMMAND_ANSWER_BAG_H_

#include <array>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "absl/status/statusor.h"
#include "client/bag/foxglove.pb.h"
#include "client/bag/mcap_writer.h"
#include "client/observation_stream.h"
#include "homing/base/mutex.h"
#include "homing/flow/observation.h"
#include "homing/v1/homing_service.pb.h"

namespace homing::client {

// Topics: /homing/answer (homing.v1.LocalizeResponse), and for each camera /homing/left/image (if
// frames are sent) and /homing/left/annotations with flow vectors, landmarks and the answer in
// words. Thread-safe.
class AnswerBag {
 public:
  // Replaces the content. `flow` is how flow is computed. Errors as of OpenGrowingFile.
  static absl::StatusOr<std::unique_ptr<AnswerBag>> Open(const std::string& path,
                                                         const FlowOptions& flow,
                                                         const std::stop_token& stop = {});

  // Passes on the same observations, and keeps their images and flow until their answers. REQUIRES:
  // `inner` and the bag outlive the result.
  std::unique_ptr<ObservationStream> Watch(ObservationStream* inner);

  // The error of the system that stops the file, RESOURCE_EXHAUSTED if the disk is full: once.
  // Later answers are left out.
  absl::Status Add(const v1::LocalizeResponse& answer);
  // Also the error that Add returned.
  absl::Status Finish();

 private:
  friend class WatchedObservations;
  // The image and flow of one camera at one instant.
  struct Picture {
    std::unique_ptr<google::protobuf::Message> image;
    std::optional<foxglove::ImageAnnotations> annotations;
  };
  struct Seen {
    std::int64_t time_ns = 0;
    std::array<Picture, 2> pictures;
  };

  AnswerBag(std::string path, std::ofstream file, const FlowOptions& flow);
  absl::Status Write(const v1::LocalizeResponse& answer) HOMING_REQUIRES(mutex_);
  // An error of the writer as the system's, with the file's name.
  absl::Status Named(const absl::Status& status) const;
  void Keep(const v1::Observation& observation);
  void ForgetFlow();
  absl::Status WritePictures(const v1::LocalizeResponse& answer, Seen seen) HOMING_REQUIRES(mutex_);
  std::uint16_t Channel(const std::string& topic, const google::protobuf::Message& message)
      HOMING_REQUIRES(mutex_);

  Mutex mutex_;
  const std::string path_;
  std::ofstream file_;
  // The first error.
  absl::Status failed_ HOMING_GUARDED_BY(mutex_);
  bag::McapWriter writer_ HOMING_GUARDED_BY(mutex_);
  std::map<std::string, std::uint16_t> channels_ HOMING_GUARDED_BY(mutex_);
  FlowOptions flow_options_;
  ObservationFlow flow_ HOMING_GUARDED_BY(mutex_);
  // Start time of observations without a time, which count as a tenth of a second apart.
  std::int64_t start_ns_;
  // Not answered yet.
  std::map<std::int64_t, Seen> seen_ HOMING_GUARDED_BY(mutex_);
};

}  // namespace homing::client

#endif  // CLIENT_COMMAND_ANSWER_BAG_H_
