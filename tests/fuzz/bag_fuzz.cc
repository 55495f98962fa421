// Bags. Input: a whole file; its first bytes choose the format.
#include "client/bag/bag_source.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  namespace bag = homing::client::bag;
  const std::string path = homing::fuzz::FileOf(data, size);
  bag::BagLimits limits;
  limits.max_chunk = 4 << 20;
  const auto opened = bag::OpenBag(path, limits);
  if (!opened.ok()) return 0;
  for (const bag::BagTopic& topic : (*opened)->topics()) {
    if (topic.messages.empty()) continue;
    const auto source = bag::OpenBagSource({path, topic.name}, homing::Side::kLeft, limits);
    if (!source.ok()) continue;
    const std::int64_t count = (*source)->size();
    // Chunks are decompressed again for each message that lies in another one.
    for (std::int64_t i = 0; i < std::min<std::int64_t>(count, 20); ++i) {
      const auto frame = (*source)->Next();
      homing::fuzz::Require(frame.ok() && frame->has_value());
    }
    if (count <= 20) {
      const std::vector<std::int64_t> keys = (*source)->keys().values;
      homing::fuzz::Require(keys.size() == static_cast<std::size_t>(count));
      homing::fuzz::Require(std::is_sorted(keys.begin(), keys.end()));
      homing::fuzz::Require(keys.empty() || keys.front() >= 0);
    }
    homing::fuzz::Require((*source)->Seek(count));
    const auto end = (*source)->Next();
    homing::fuzz::Require(end.ok() && !end->has_value());
  }
  return 0;
}
