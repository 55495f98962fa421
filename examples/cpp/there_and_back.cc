// Records images as a journey, then localises along it with the same images.
// usage: there_and_back SERVER JOURNEY IMAGE.png...
#include <homing/client/localizer.h>
#include <homing/client/recorder.h>

#include <fstream>
#include <iostream>
#include <iterator>

namespace robot = homing::robot;

int main(int argc, char** argv) {
  const robot::Server server{argv[1]};
  auto recorder = robot::Recorder::Open(server, {argv[2], "example", {}, {}, "example.buffer"});
  robot::LocalizerOptions home{argv[2], robot::Travel::kSame};
  auto localizer = robot::Localizer::Open(server, home);
  for (const bool outbound : {true, false}) {
    for (int i = 3; i < argc; ++i) {
      std::ifstream file(argv[i], std::ios::binary);
      const std::string bytes(std::istreambuf_iterator<char>(file), {});
      robot::Observation seen;
      seen.left = {robot::Image{robot::Encoding::kPng, 0, 0, bytes.data(), bytes.size()}, {}};
      if (outbound) {
        if (const auto added = (*recorder)->Add(seen); !added.ok()) std::cerr << added.message();
      } else if (auto answer = (*localizer)->Localize(seen, std::chrono::seconds(10));
                 answer.ok()) {
        std::cout << "step " << answer->step.value_or(-1) << " p " << answer->probability << '\n';
      }
    }
    if (outbound && !(*recorder)->Finish(std::chrono::seconds(60)).ok()) return 1;
  }
}
