#include "server/rpc/field_path.h"

#include <deque>
#include <optional>
#include <vector>

#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"

namespace homing::server {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using Path = std::vector<std::string>;

// Words of "left: frame.width is 0": left, frame, width.
Path WordsOf(const std::string& message) {
  Path words;
  const Path parts = absl::StrSplit(message, ' ');
  for (const std::string& part : parts) {
    const bool goes_on = !part.empty() && part.back() == ':';
    const Path names = absl::StrSplit(goes_on ? part.substr(0, part.size() - 1) : part, '.');
    words.insert(words.end(), names.begin(), names.end());
    if (!goes_on) break;
  }
  return words;
}

// The nearest field of that name in the message or in those that it holds.
struct Found {
  Path between;
  const FieldDescriptor* field = nullptr;
};
std::optional<Found> Search(const Descriptor& message, const std::string& name) {
  constexpr std::size_t kDeepest = 4;
  std::deque<std::pair<const Descriptor*, Path>> open = {{&message, {}}};
  while (!open.empty()) {
    const auto [next, path] = open.front();
    open.pop_front();
    if (const FieldDescriptor* field = next->FindFieldByName(name)) return Found{path, field};
    for (int i = 0; i < next->field_count() && path.size() < kDeepest; ++i) {
      const FieldDescriptor* inner = next->field(i);
      if (inner->message_type() == nullptr) continue;
      Path longer = path;
      longer.push_back(inner->name());
      open.emplace_back(inner->message_type(), std::move(longer));
    }
  }
  return std::nullopt;
}

}  // namespace

std::string FieldPath(const std::string& message, const Descriptor& request) {
  Path path;
  const Descriptor* here = &request;
  std::string last;
  for (const std::string& word : WordsOf(message)) {
    const std::string name = word.substr(0, word.find('['));
    if (here == nullptr || (name == last && here->FindFieldByName(name) == nullptr)) continue;
    const auto found = Search(*here, name);
    if (!found) continue;
    path.insert(path.end(), found->between.begin(), found->between.end());
    path.push_back(found->field->is_repeated() ? word : name);
    here = found->field->message_type();
    last = name;
  }
  return absl::StrJoin(path, ".");
}

}  // namespace homing::server
