#include "client/bag/mcap_writer.h"

#include <gtest/gtest.h>

#include <limits>
#include <sstream>

#include "client/bag/bag_source.h"
#include "client/bag/foxglove.pb.h"
#include "tests/client/bag/test_bags.h"
#include "tests/support/status_matchers.h"

namespace homing::client::bag {
namespace {

foxglove::RawImage Image(int frame) {
  foxglove::RawImage image;
  image.set_width(8);
  image.set_height(6);
  image.set_encoding("mono8");
  image.set_step(8);
  image.set_data(Pixels(frame, false));
  image.mutable_timestamp()->set_seconds(frame + 1);
  return image;
}

// tests/mcap reads such files with @mcap/core.
TEST(McapWriterTest, WhatItWritesIsReadBack) {
  TemporaryFolder folder;
  std::ostringstream file;
  McapWriter writer(&file);
  const auto left = writer.AddChannel("/left", foxglove::RawImage::descriptor());
  const auto notes = writer.AddChannel("/notes", foxglove::ImageAnnotations::descriptor());
  for (int i = 0; i < 100; ++i) {
    ASSERT_THAT(writer.Write(left, i + 1, Image(i)), IsOk());
    foxglove::ImageAnnotations annotations;
    // Larger than a chunk after a few.
    annotations.add_texts()->set_text(std::string(100'000, 'a'));
    ASSERT_THAT(writer.Write(notes, i + 1, annotations), IsOk());
  }
  ASSERT_THAT(writer.Finish(), IsOk());
  const std::string path = folder.File("a.mcap");
  WriteFile(path, file.str());
  const auto source = OpenBagSource({path, ""}, Side::kLeft);
  ASSERT_THAT(source, IsOk());
  EXPECT_EQ((*source)->remark(), "");
  ASSERT_EQ((*source)->size(), 100);
  for (int i = 0; i < 100; ++i) {
    const auto frame = (*source)->Next();
    ASSERT_THAT(frame, IsOk());
    EXPECT_EQ((*frame)->data, Pixels(i, false));
    EXPECT_EQ((*frame)->capture_time_ns, (i + 1) * std::int64_t{1'000'000'000});
  }
}

// Neither the stamp nor the time of recording is one.
TEST(McapWriterTest, ATimeThatCannotBeIsNotKnown) {
  TemporaryFolder folder;
  std::ostringstream file;
  McapWriter writer(&file);
  const auto left = writer.AddChannel("/left", foxglove::RawImage::descriptor());
  foxglove::RawImage image = Image(0);
  image.mutable_timestamp()->set_seconds(0);
  image.mutable_timestamp()->set_nanos(-5);
  for (const std::int64_t recorded : {std::int64_t{-7}, std::numeric_limits<std::int64_t>::max()}) {
    ASSERT_THAT(writer.Write(left, recorded, image), IsOk());
  }
  ASSERT_THAT(writer.Finish(), IsOk());
  WriteFile(folder.File("a.mcap"), file.str());
  const auto source = OpenBagSource({folder.File("a.mcap"), ""}, Side::kLeft);
  ASSERT_THAT(source, IsOk());
  EXPECT_EQ((*source)->keys().values, (std::vector<std::int64_t>{0, 0}));
  const auto frame = (*source)->Next();
  ASSERT_THAT(frame, IsOk());
  EXPECT_EQ((*frame)->fault, "");
  EXPECT_EQ((*frame)->capture_time_ns, 0);
}

TEST(McapWriterTest, ATornFileKeepsItsWholeChunks) {
  TemporaryFolder folder;
  std::ostringstream file;
  McapWriter writer(&file);
  const auto left = writer.AddChannel("/left", foxglove::RawImage::descriptor());
  // A chunk holds about ten thousand of them.
  for (int i = 0; i < 30'000; ++i) ASSERT_THAT(writer.Write(left, i, Image(i % 100)), IsOk());
  WriteFile(folder.File("a.mcap"), file.str());
  const auto source = OpenBagSource({folder.File("a.mcap"), ""}, Side::kLeft);
  ASSERT_THAT(source, IsOk());
  EXPECT_GT((*source)->size(), 10'000);
  EXPECT_NE((*source)->remark(), "");
}

TEST(McapWriterTest, AFullDiskIsAnError) {
  std::ostringstream file;
  McapWriter writer(&file);
  const auto left = writer.AddChannel("/left", foxglove::RawImage::descriptor());
  file.setstate(std::ios::badbit);
  EXPECT_THAT(writer.Write(left, 1, Image(1)),
              StatusIs(absl::StatusCode::kResourceExhausted, ::testing::_));
}

}  // namespace
}  // namespace homing::client::bag
