// Calibration files. Input: a whole file.
#include "client/calibration_file.h"
#include "tests/fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string path = homing::fuzz::FileOf(data, size);
  for (const char* camera : {"", "#cam1"}) {
    const auto read = homing::client::ReadCalibrationFile(path + camera);
    homing::fuzz::Require(!read.ok() || homing::Validate(*read).ok());
  }
  return 0;
}
