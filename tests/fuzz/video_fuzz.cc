// Videos. Input: a whole file.
#include "client/opencv/video_source.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto source = homing::client::OpenVideo(homing::fuzz::FileOf(data, size));
  if (!source.ok()) return 0;
  for (int pass = 0; pass < 2; ++pass) {
    for (int i = 0; i < 20; ++i) {
      const auto frame = (*source)->Next();
      if (!frame.ok() || !frame->has_value()) break;
      const auto pixels = std::int64_t{(*frame)->width} * (*frame)->height;
      homing::fuzz::Require(static_cast<std::int64_t>((*frame)->data.size()) == pixels);
    }
    homing::fuzz::Require(!(*source)->live());
    if (!(*source)->Seek(0)) return 0;
  }
  return 0;
}
