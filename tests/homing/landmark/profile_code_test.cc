#include "homing/landmark/profile_code.h"

#include <gtest/gtest.h>

#include <random>

namespace homing {
namespace {

TEST(ProfileCodeTest, RoundTripsAnyProfile) {
  std::mt19937_64 engine(3);
  for (int filled = 0; filled <= FlowProfile::kCells; ++filled) {
    FlowProfile profile;
    for (int i = 0; i < filled; ++i) {
      profile.cells[engine() % FlowProfile::kCells] = static_cast<std::uint8_t>(engine() % 256);
    }
    const std::string bytes = EncodeProfile(profile);
    EXPECT_LE(bytes.size(), 108U);
    const auto again = DecodeProfile(bytes);
    ASSERT_TRUE(again.ok()) << again.status();
    EXPECT_EQ(*again, profile);
  }
}

TEST(ProfileCodeTest, RefusesWhatIsCutLengthenedOrHasAZero) {
  FlowProfile profile;
  profile.cells[7] = 0x85;
  profile.cells[95] = 0x13;
  const std::string bytes = EncodeProfile(profile);
  ASSERT_EQ(bytes.size(), 14U);
  for (std::size_t size = 1; size < bytes.size(); ++size) {
    EXPECT_FALSE(DecodeProfile(bytes.substr(0, size)).ok()) << size;
  }
  EXPECT_FALSE(DecodeProfile(bytes + "x").ok());
  std::string zero = bytes;
  zero.back() = '\0';
  EXPECT_FALSE(DecodeProfile(zero).ok());
}

}  // namespace
}  // namespace homing
