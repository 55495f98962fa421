// Files of journeys. Input: the message inside; the beginning and the checksum are put around it,
// or (first byte 0) the whole file.
#include <zlib.h>

#include "server/service/journey_archive.h"
#include "tests/fuzz/fuzz_input.h"

namespace {

std::string FileAround(std::string_view message) {
  std::string file = "HOMINGJ\x01" + std::string(message);
  const auto sum = static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(file.data()), static_cast<uInt>(file.size())));
  for (int shift = 0; shift < 32; shift += 8) file.push_back(static_cast<char>(sum >> shift));
  return file;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  homing::fuzz::FuzzInput input(data, size);
  const bool whole = input.Take<std::uint8_t>() == 0;
  const std::string file = whole ? std::string(input.rest()) : FileAround(input.rest());
  const auto journey = homing::server::DecodeJourney(file);
  if (journey.ok()) {
    const auto again = homing::server::EncodeJourney(journey->record, journey->map);
    homing::fuzz::Require(again.ok() && *again == file);
  }
  return 0;
}
