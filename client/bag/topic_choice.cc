#include "client/bag/topic_choice.h"

#include <algorithm>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_split.h"

namespace homing::client::bag {
namespace {

constexpr char kCompressed[] = "/compressed";

using Topics = std::vector<const BagTopic*>;

bool IsImage(const BagTopic& topic) {
  return (topic.content == Content::kRawImage || topic.content == Content::kCompressedImage) &&
         !absl::EndsWith(topic.name, "/compressedDepth");
}

// True if the topic shows the same camera as another topic of the bag.
bool IsTwin(const BagTopic& topic, const std::vector<BagTopic>& topics) {
  return absl::EndsWith(topic.name, kCompressed) &&
         std::any_of(topics.begin(), topics.end(), [&](const BagTopic& other) {
           return IsImage(other) && other.name + kCompressed == topic.name;
         });
}

// "/cam_left/image" names the left side; "/bright/image" names none.
bool Names(const BagTopic& topic, const std::string& side) {
  const std::vector<std::string> words =
      absl::StrSplit(absl::AsciiStrToLower(topic.name), absl::ByAnyChar("/_-."));
  return std::any_of(words.begin(), words.end(),
                     [&](const std::string& word) { return absl::StartsWith(word, side); });
}

std::string Line(const BagTopic& topic) {
  const std::size_t count = topic.messages.size();
  std::string rate;
  if (count > 1) {
    // In double: the difference of damaged times may not fit into an integer.
    const double seconds = 1e-9 * (static_cast<double>(topic.messages.back().time_ns) -
                                   static_cast<double>(topic.messages.front().time_ns));
    if (seconds > 0) rate = absl::StrFormat(", %.1f Hz", static_cast<double>(count - 1) / seconds);
  }
  return absl::StrCat("\n  ", topic.name, "  ", topic.type, ", ", count, " messages", rate);
}

absl::Status Unclear(const std::string& what, const std::vector<BagTopic>& topics) {
  const bool any = std::any_of(topics.begin(), topics.end(), IsImage);
  if (!any && topics.empty()) return absl::InvalidArgumentError("it has no topics");
  std::string text = any ? absl::StrCat(what, "; name one as FILE#TOPIC. Image topics:")
                         : "it has no image topic; its topics:";
  for (const BagTopic& topic : topics) {
    if (IsImage(topic)) absl::StrAppend(&text, Line(topic));
    if (!any) absl::StrAppend(&text, "\n  ", topic.name, "  ", topic.type);
  }
  return absl::InvalidArgumentError(text);
}

std::string FolderOf(const std::string& name) { return name.substr(0, name.rfind('/') + 1); }

}  // namespace

absl::StatusOr<const BagTopic*> ChooseImageTopic(const std::vector<BagTopic>& topics,
                                                 const std::string& name, Side camera) {
  Topics all;
  for (const BagTopic& topic : topics) {
    if (!name.empty() && topic.name == name && IsImage(topic)) return &topic;
    if (IsImage(topic) && !topic.messages.empty() && !IsTwin(topic, topics)) all.push_back(&topic);
  }
  if (!name.empty()) return Unclear(absl::StrCat("there are no images on ", name), topics);
  const std::string side = camera == Side::kLeft ? "left" : "right";
  const std::string other = camera == Side::kLeft ? "right" : "left";
  if (all.size() == 1 && !Names(*all[0], other)) return all[0];
  std::erase_if(all, [&](const BagTopic* topic) { return !Names(*topic, side); });
  if (all.size() == 1) return all[0];
  return Unclear(absl::StrCat("it is not clear which topic is the ", side, " camera's"), topics);
}

bool IsRectified(const BagTopic& image) { return absl::StrContains(image.name, "/image_rect"); }

const BagTopic* FindCameraInfo(const std::vector<BagTopic>& topics, const BagTopic& image) {
  std::string name = image.name;
  if (absl::EndsWith(name, kCompressed)) name.resize(name.size() - sizeof(kCompressed) + 1);
  const std::string folder = FolderOf(name);
  for (const BagTopic& topic : topics) {
    if (topic.content == Content::kCameraInfo && !topic.messages.empty() &&
        FolderOf(topic.name) == folder) {
      return &topic;
    }
  }
  return nullptr;
}

}  // namespace homing::client::bag
