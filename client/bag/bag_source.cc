#include "client/bag/bag_source.h"

#include <algorithm>
#include <array>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/bag/image_message.h"
#include "client/bag/topic_choice.h"
#include "homing/base/range_check.h"
#include "homing/base/status_macros.h"

namespace homing::client::bag {
namespace {

constexpr std::string_view kPrefix = "mcap:";
constexpr std::array<std::string_view, 3> kEndings = {".mcap", ".bag", ".db3"};

// The first of the times, nanoseconds, that is one; 0: none. Damaged messages have any number: the
// difference of two times must fit into 64 bits.
std::int64_t FirstTime(std::int64_t stamp, std::int64_t recorded) {
  constexpr std::int64_t kLatest = std::int64_t{1} << 62;
  for (const std::int64_t time : {stamp, recorded}) {
    if (time > 0 && time < kLatest) return time;
  }
  return 0;
}

class BagSource : public FrameSource {
 public:
  BagSource(std::string path, std::unique_ptr<Bag> bag, const BagTopic* topic)
      : path_(std::move(path)), bag_(std::move(bag)), topic_(topic) {}

  absl::StatusOr<std::optional<SourceFrame>> Next() override {
    if (next_ == topic_->messages.size()) return std::optional<SourceFrame>();
    const std::size_t index = next_++;
    const MessagePlace& place = topic_->messages[index];
    auto frame = ReadFrame(place);
    if (!frame.ok()) {
      SourceFrame bad;
      bad.fault =
          absl::StrCat(name(), ", message ", index, ": ", std::string(frame.status().message()));
      frame = std::move(bad);
    }
    frame->capture_time_ns = FirstTime(frame->capture_time_ns, place.time_ns);
    return std::make_optional(*std::move(frame));
  }

  std::int64_t size() const override { return static_cast<std::int64_t>(topic_->messages.size()); }

  bool Seek(std::int64_t index) override {
    if (index < 0 || index > size()) return false;
    next_ = static_cast<std::size_t>(index);
    return true;
  }

  // The keys are the messages' stamps: the times of recording differ between cameras by the
  // messages' delays. This reads each message.
  FrameKeys keys() const override {
    FrameKeys keys{FrameKeys::Kind::kTime, {}};
    keys.values.reserve(topic_->messages.size());
    for (const MessagePlace& place : topic_->messages) {
      const auto bytes = bag_->Read(place);
      const std::int64_t stamp = bytes.ok() ? StampOf(*topic_, *bytes) : 0;
      const std::int64_t key = FirstTime(stamp, place.time_ns);
      keys.values.push_back(keys.values.empty() ? key : std::max(key, keys.values.back()));
    }
    return keys;
  }

  std::string name() const override { return absl::StrCat(path_, "#", topic_->name); }
  std::optional<Camera> camera() const override { return camera_; }
  std::string remark() const override { return bag_->damage(); }

  // Reads the camera from the first message of the camera_info topic; an uncalibrated camera gives
  // none.
  absl::Status ReadCamera() {
    const BagTopic* const info_topic = FindCameraInfo(bag_->topics(), *topic_);
    if (info_topic == nullptr) return absl::OkStatus();
    return Within(absl::StrCat(path_, "#", info_topic->name), ReadCameraFrom(*info_topic));
  }

 private:
  absl::Status ReadCameraFrom(const BagTopic& info_topic) {
    HOMING_ASSIGN_OR_RETURN(const std::string bytes, bag_->Read(info_topic.messages.front()));
    HOMING_ASSIGN_OR_RETURN(const CameraInfo info, DecodeCameraInfo(info_topic, bytes));
    const bool calibrated = std::any_of(info.matrix.begin(), info.matrix.end(),
                                        [](double value) { return value != 0; });
    if (!calibrated) return absl::OkStatus();
    HOMING_ASSIGN_OR_RETURN(camera_, ToCamera(info, IsRectified(*topic_)));
    return absl::OkStatus();
  }
  absl::StatusOr<SourceFrame> ReadFrame(const MessagePlace& place) {
    HOMING_ASSIGN_OR_RETURN(const std::string bytes, bag_->Read(place));
    return DecodeImage(*topic_, bytes);
  }

  std::string path_;
  std::unique_ptr<Bag> bag_;
  // Points into bag_.
  const BagTopic* topic_;
  std::size_t next_ = 0;
  std::optional<Camera> camera_;
};

}  // namespace

std::optional<BagName> ParseBagName(const std::string& source) {
  const bool prefixed = source.starts_with(kPrefix);
  const std::string text = prefixed ? source.substr(kPrefix.size()) : source;
  for (const std::string_view ending : kEndings) {
    const std::size_t at = text.find(std::string(ending) + "#");
    if (at != std::string::npos) {
      const std::size_t hash = at + ending.size();
      return BagName{text.substr(0, hash), text.substr(hash + 1)};
    }
    if (text.ends_with(ending)) return BagName{text, ""};
  }
  if (!prefixed) return std::nullopt;
  const std::size_t hash = text.find('#');
  if (hash == std::string::npos) return BagName{text, ""};
  return BagName{text.substr(0, hash), text.substr(hash + 1)};
}

absl::StatusOr<std::unique_ptr<FrameSource>> OpenBagSource(const BagName& name, Side camera,
                                                           const BagLimits& limits) {
  HOMING_ASSIGN_OR_RETURN(auto bag, OpenBag(name.path, limits));
  const auto topic = ChooseImageTopic(bag->topics(), name.topic, camera);
  if (!topic.ok()) {
    const std::string damage = bag->damage().empty() ? "" : absl::StrCat("\n", bag->damage());
    return absl::Status(
        topic.status().code(),
        absl::StrCat(name.path, ": ", std::string(topic.status().message()), damage));
  }
  auto source = std::make_unique<BagSource>(name.path, std::move(bag), *topic);
  HOMING_RETURN_IF_ERROR(source->ReadCamera());
  return source;
}

}  // namespace homing::client::bag
