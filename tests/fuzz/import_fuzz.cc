// Journey files. The first byte selects the input: 0: the whole file; odd: the message of a file of
// version 1; even: of version 2. The target adds header and checksum to a message.
#include <zlib.h>

#include "server/service/journey_archive.h"
#include "tests/fuzz/fuzz_input.h"

namespace {

constexpr std::size_t kVersionAt = 7;
constexpr char kVersion = 2;

std::string FileAround(std::string_view message, char version) {
  std::string file = "HOMINGJ" + std::string(1, version) + std::string(message);
  const auto sum = static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(file.data()), static_cast<uInt>(file.size())));
  for (int shift = 0; shift < 32; shift += 8) file.push_back(static_cast<char>(sum >> shift));
  return file;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  homing::fuzz::FuzzInput input(data, size);
  const auto kind = input.Take<std::uint8_t>();
  const std::string file =
      kind == 0 ? std::string(input.rest())
                : FileAround(input.rest(), static_cast<char>(kind % 2 == 1 ? 1 : kVersion));
  const auto journey = homing::server::DecodeJourney(file);
  if (journey.ok()) {
    const auto again = homing::server::EncodeJourney(journey->record, journey->map);
    // A file of version 1 is written as one of version 2.
    homing::fuzz::Require(again.ok() && (*again == file || file[kVersionAt] != kVersion));
    if (*again != file) {
      const auto once_more = homing::server::DecodeJourney(*again);
      homing::fuzz::Require(once_more.ok());
      const auto same = homing::server::EncodeJourney(once_more->record, once_more->map);
      homing::fuzz::Require(same.ok() && *same == *again);
    }
  }
  return 0;
}
