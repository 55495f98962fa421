#include "homing/landmark/profile_code.h"

#include <gtest/gtest.h>

#include <random>

namespace homing {
namespace {

TEST(ProfileCodeTest, RoundTripsAnyProfile) {
  std::mt19937_64 engine(3);
  for (int trial = 0; trial < 200; ++trial) {
    FlowProfile profile;
    profile.odometer = {.median_x = static_cast<std::int16_t>(engine()),
                        .expansion = static_cast<std::int16_t>(engine()),
                        .length_code = static_cast<std::uint8_t>(engine()),
                        .spread_code = static_cast<std::uint8_t>(engine()),
                        .turn_code = static_cast<std::int16_t>(engine())};
    // Two cells beside each other share a parallax code.
    for (std::size_t cell = 0; cell < FlowProfile::kCells; cell += 2) {
      const auto parallax = static_cast<std::uint8_t>(engine() % 16 << 4);
      profile.cells[cell] = static_cast<std::uint8_t>(parallax | engine() % 16);
      profile.cells[cell + 1] = static_cast<std::uint8_t>(parallax | engine() % 16);
    }
    const std::string bytes = EncodeProfile(profile);
    EXPECT_EQ(bytes.size(), kProfileBytes);
    const auto again = DecodeProfile(bytes);
    ASSERT_TRUE(again.ok()) << again.status();
    EXPECT_EQ(*again, profile);
  }
}

TEST(ProfileCodeTest, NothingSeenIsNoBytes) {
  EXPECT_EQ(EncodeProfile({}), "");
  EXPECT_EQ(DecodeProfile("").value(), FlowProfile{});
}

// The first format: cells 7 and 95 of 12 x 8.
std::string OldBytes() {
  std::string bytes(12, '\0');
  bytes[0] = static_cast<char>(0x80);
  bytes[11] = static_cast<char>(0x80);
  return bytes + "\x85\x13";
}

TEST(ProfileCodeTest, ReadsTheFirstFormatAtTheSamePlaces) {
  const auto profile = DecodeProfile(OldBytes());
  ASSERT_TRUE(profile.ok()) << profile.status();
  EXPECT_FALSE(profile->odometer.has_value());
  const int last = FlowProfile::kCells - 1;
  EXPECT_GT(profile->count_code(last), 0);
  EXPECT_EQ(profile->parallax_code(last), 1);
  // Column 7 of 12 covers columns 9 and 10 of 16.
  EXPECT_GT(profile->count_code(9), 0);
  EXPECT_GT(profile->count_code(10), 0);
  EXPECT_EQ(profile->parallax_code(9), 8);
  EXPECT_EQ(profile->count_code(0), 0);
}

TEST(ProfileCodeTest, ReadsTheFormatWithoutATurn) {
  FlowProfile profile;
  profile.cells[8] = profile.cells[9] = 0x85;
  profile.odometer.length_code = 7;
  std::string bytes = EncodeProfile(profile);
  EXPECT_EQ(DecodeProfile(bytes.erase(6, 2)).value(), profile);
}

TEST(ProfileCodeTest, RefusesWhatIsCutLengthenedOrHasAZero) {
  FlowProfile profile;
  profile.cells[8] = 0x85;
  profile.cells[9] = 0x83;
  // An older profile of as many bytes would have other bits in its bitmap.
  for (const std::string& bytes : {OldBytes(), EncodeProfile(profile)}) {
    for (std::size_t size = 1; size < bytes.size(); ++size) {
      // Two bytes less are the format without a turn.
      if (size + 2 == kProfileBytes) continue;
      EXPECT_FALSE(DecodeProfile(bytes.substr(0, size)).ok()) << size;
    }
    EXPECT_FALSE(DecodeProfile(bytes + "x").ok());
  }
  std::string zero = OldBytes();
  zero.back() = '\0';
  EXPECT_FALSE(DecodeProfile(zero).ok());
}

}  // namespace
}  // namespace homing
