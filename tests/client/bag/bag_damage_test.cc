#include <gtest/gtest.h>

#include "client/bag/bag.h"
#include "client/bag/bag_source.h"
#include "tests/client/bag/test_bags.h"
#include "tests/support/status_matchers.h"

namespace homing::client::bag {
namespace {

using ::testing::HasSubstr;

class DamagedBagTest : public ::testing::TestWithParam<const char*> {
 protected:
  // The right camera's frames that can be read of a file of these bytes; -1: it does not open.
  int ReadAll(const std::string& bytes) {
    WriteFile(path_, bytes);
    auto source = OpenBagSource({path_, "/cam/right/image_raw"}, Side::kRight);
    if (!source.ok()) return -1;
    damage_ = (*source)->remark();
    int good = 0;
    while (true) {
      const auto frame = (*source)->Next();
      EXPECT_THAT(frame, IsOk());
      if (!frame.ok() || !frame->has_value()) return good;
      if (!(*frame)->fault.empty()) continue;
      ++good;
      const std::string& data = (*frame)->data;
      if ((*frame)->encoding == FrameEncoding::kGray8 && intact_) {
        EXPECT_EQ(data, Pixels(static_cast<int>(((*frame)->capture_time_ns % 1'000'000'000'000) /
                                                100'000'000),
                               true));
      }
    }
  }

  TemporaryFolder folder_;
  std::string path_ = folder_.File("bag");
  std::string damage_;
  // What is read must be right.
  bool intact_ = true;
};

TEST_P(DamagedBagTest, ATruncatedFileGivesWhatComesBefore) {
  const std::string whole = ReadFile(BagPath(GetParam()));
  const bool database = std::string(GetParam()) == "rosbag2.db3";
  int before = kFrames;
  // SQLite's pages do not lie in the order of time.
  intact_ = !database;
  const std::size_t stride = whole.size() / 400 + 1;
  for (std::size_t size = whole.size() - 1; size > stride; size -= stride) {
    const int frames = ReadAll(whole.substr(0, size));
    if (database) {
      EXPECT_TRUE(frames < 0 || !damage_.empty()) << size;
      // The table itself lies in the first half.
      if (size > whole.size() / 4 * 3) {
        EXPECT_GT(frames, 0) << size;
      }
      continue;
    }
    EXPECT_LE(frames, before) << size;
    if (frames >= 0 && frames < kFrames) {
      EXPECT_NE(damage_, "") << size;
    }
    before = frames;
  }
}

TEST_P(DamagedBagTest, AChangedByteDoesNoHarm) {
  intact_ = false;
  const std::string whole = ReadFile(BagPath(GetParam()));
  const std::size_t stride = std::max<std::size_t>(1, whole.size() / 300);
  for (std::size_t at = 0; at < whole.size(); at += stride) {
    for (const char change : {'\x01', '\x80', '\xff'}) {
      std::string bytes = whole;
      bytes[at] = static_cast<char>(bytes[at] ^ change);
      EXPECT_LE(ReadAll(bytes), 2 * kFrames) << at;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Bags, DamagedBagTest, ::testing::ValuesIn(kBags),
                         [](const auto& bag) { return TestName(bag.param); });

// A record of MCAP.
std::string Record(char opcode, const std::string& content) {
  std::string record(1, opcode);
  for (int byte = 0; byte < 8; ++byte) {
    record.push_back(static_cast<char>(content.size() >> (8 * byte)));
  }
  return record + content;
}

TEST(BagBombTest, ClaimedSizesAreNotAllocated) {
  TemporaryFolder folder;
  const std::string huge(8, '\x7f');
  // A record of 9 exabytes; a chunk that claims as much.
  WriteFile(folder.File("a.mcap"), "\x89MCAP0\r\n\x05" + huge + "abc");
  const auto record = OpenBag(folder.File("a.mcap"));
  ASSERT_THAT(record, IsOk());
  EXPECT_THAT((*record)->damage(), HasSubstr("ends too early"));
  const std::string chunk = std::string(16, '\0') + huge + std::string(4, '\0') +
                            std::string("\4\0\0\0zstd\0\0\0\0\0\0\0\0", 16);
  WriteFile(folder.File("b.mcap"), "\x89MCAP0\r\n" + Record('\x06', chunk));
  const auto claimed = OpenBag(folder.File("b.mcap"));
  ASSERT_THAT(claimed, IsOk());
  EXPECT_THAT((*claimed)->damage(), HasSubstr("the limit is"));
}

TEST(BagBombTest, AWrongChecksumIsFound) {
  TemporaryFolder folder;
  std::string bytes = ReadFile(BagPath("none.mcap"));
  const std::string pixels = Pixels(3, false);
  bytes[bytes.find(pixels) + 5] ^= 1;
  WriteFile(folder.File("a.mcap"), bytes);
  auto source = OpenBagSource({folder.File("a.mcap"), ""}, Side::kLeft);
  ASSERT_THAT(source, IsOk());
  int good = 0;
  for (int i = 0; i < kFrames; ++i) {
    const auto frame = (*source)->Next();
    ASSERT_THAT(frame, IsOk());
    good += (*frame)->fault.empty() ? 1 : 0;
    if (!(*frame)->fault.empty()) {
      EXPECT_THAT((*frame)->fault, HasSubstr("checksum"));
    }
  }
  EXPECT_GE(good, kFrames - 4);
  EXPECT_LT(good, kFrames);
}

}  // namespace
}  // namespace homing::client::bag
