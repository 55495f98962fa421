// Lists of images with times, and names of images. Input: a whole list; its lines are the names.
#include "absl/strings/str_split.h"
#include "client/source/frame_pairing.h"
#include "client/source/image_list.h"
#include "client/source/image_names.h"
#include "tests/fuzz/fuzz_input.h"

namespace homing::client {
namespace {

// What sources do with their keys.
void Pair(const FrameKeys& keys, std::size_t size) {
  const bool ordered = keys.kind == FrameKeys::Kind::kOrder;
  fuzz::Require(keys.values.size() == (ordered ? 0 : size));
  fuzz::Require(std::is_sorted(keys.values.begin(), keys.values.end()));
  fuzz::Require(FindHoles(keys).size() <= size);
  FrameKeys half{keys.kind, {}};
  half.values.assign(keys.values.begin(),
                     keys.values.begin() + static_cast<std::ptrdiff_t>(keys.values.size() / 2));
  const auto all = static_cast<std::int64_t>(size);
  const FramePairing pairing = PairFrames(keys, all, half, all / 2);
  fuzz::Require(pairing.instants.size() >= size);
}

}  // namespace
}  // namespace homing::client

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace client = homing::client;
  const auto list = client::ReadImageList(homing::fuzz::FileOf(data, size));
  if (list.ok()) {
    homing::fuzz::Require(list->paths.size() == list->times_ns.size());
    client::Pair({client::FrameKeys::Kind::kTime, list->times_ns}, list->paths.size());
  }
  const std::string text(reinterpret_cast<const char*>(data), size);
  std::vector<std::string> names = absl::StrSplit(text, '\n');
  client::SortByName(&names);
  client::Pair(client::KeysOfNames(names), names.size());
  return 0;
}
