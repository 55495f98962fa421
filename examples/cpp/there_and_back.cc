// Records images as a journey, then localises along it. usage: there_and_back SERVER JOURNEY
// IMAGE.png...
#include <homing/client/localizer.h>
#include <homing/client/recorder.h>

#include <fstream>
#include <iostream>
#include <iterator>

namespace robot = homing::robot;

int main(int argc, char** argv) {
  if (argc < 4) return 2;
  auto recorder = robot::Recorder::Open({argv[1]}, {argv[2], "example", {}, {}, "example.buffer"});
  auto localizer = robot::Localizer::Open({argv[1]}, {argv[2], robot::Travel::kSame});
  for (int i = 3; recorder.ok() && localizer.ok() && i < 2 * argc - 3; ++i) {
    std::ifstream file(argv[i < argc ? i : i - argc + 3], std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(file), {});
    robot::Observation seen;
    seen.left = {robot::Image{robot::Encoding::kPng, 0, 0, bytes.data(), bytes.size()}, {}};
    if (i < argc) {
      robot::Status done = (*recorder)->Add(seen);
      if (i == argc - 1) done = (*recorder)->Finish(std::chrono::seconds(60));
      if (!done.ok()) std::cerr << done.message() << '\n';
    } else if (auto answer = (*localizer)->Localize(seen, std::chrono::seconds(10)); answer.ok()) {
      std::cout << "step " << answer->step.value_or(-1) << " p " << answer->probability << '\n';
    } else {
      std::cerr << answer.status().message() << '\n';
    }
  }
  std::cerr << recorder.status().message() << localizer.status().message();
}
