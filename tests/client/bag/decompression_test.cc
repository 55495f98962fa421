#include "client/bag/decompression.h"

#include <bzlib.h>
#include <gtest/gtest.h>
#include <lz4frame.h>
#include <zstd.h>

#include "tests/support/status_matchers.h"

namespace homing::client::bag {
namespace {

using ::testing::_;
using ::testing::HasSubstr;

std::string Compress(const std::string& name, const std::string& bytes) {
  std::string out(bytes.size() + 1000, '\0');
  if (name == "zstd") {
    out.resize(ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 1));
  } else if (name == "lz4") {
    out.resize(LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(), nullptr));
  } else {
    auto size = static_cast<unsigned>(out.size());
    BZ2_bzBuffToBuffCompress(out.data(), &size, const_cast<char*>(bytes.data()),
                             static_cast<unsigned>(bytes.size()), 1, 0, 0);
    out.resize(size);
  }
  return out;
}

class DecompressionTest : public ::testing::TestWithParam<const char*> {
 protected:
  std::string bytes_ = std::string(3'000'000, 'a') + "end";
  std::string packed_ = Compress(GetParam(), bytes_);
};

TEST_P(DecompressionTest, GivesTheBytesBack) {
  const auto result = Decompress(GetParam(), packed_, bytes_.size());
  ASSERT_THAT(result, IsOk());
  EXPECT_EQ(*result, bytes_);
}

TEST_P(DecompressionTest, AnotherSizeThanClaimedIsDataLoss) {
  EXPECT_THAT(Decompress(GetParam(), packed_, bytes_.size() - 1),
              StatusIs(absl::StatusCode::kDataLoss, HasSubstr("more than")));
  EXPECT_THAT(Decompress(GetParam(), packed_, bytes_.size() + 1),
              StatusIs(absl::StatusCode::kDataLoss, HasSubstr("not 3000004")));
  EXPECT_THAT(Decompress(GetParam(), packed_, 0), StatusIs(absl::StatusCode::kDataLoss, _));
}

TEST_P(DecompressionTest, WhatEndsTooEarlyIsDataLoss) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{3}, packed_.size() - 1}) {
    EXPECT_THAT(Decompress(GetParam(), packed_.substr(0, size), bytes_.size()),
                StatusIs(absl::StatusCode::kDataLoss, _))
        << size;
  }
}

INSTANTIATE_TEST_SUITE_P(Names, DecompressionTest, ::testing::Values("zstd", "lz4", "bz2"));

TEST(DecompressionNamesTest, KnowsItsNames) {
  EXPECT_EQ(*Decompress("", "abc", 3), "abc");
  EXPECT_EQ(*Decompress("none", "abc", 3), "abc");
  EXPECT_THAT(Decompress("", "abc", 4), StatusIs(absl::StatusCode::kDataLoss, _));
  EXPECT_THAT(Decompress("xz", "abc", 3),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("xz")));
}

}  // namespace
}  // namespace homing::client::bag
