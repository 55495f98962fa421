#include "client/source/image_list.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "client/png_file.h"
#include "client/source/image_names.h"
#include "tests/support/status_matchers.h"
#include "tests/support/temporary_folder.h"

namespace homing::client {
namespace {

using ::testing::HasSubstr;

class ImageListTest : public ::testing::Test {
 protected:
  std::string Write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.File(name)) << text;
    return folder_.File(name);
  }
  void Image(const std::string& name) {
    std::filesystem::create_directories(std::filesystem::path(folder_.File(name)).parent_path());
    const std::string pixels(64 * 48, 'a');
    ASSERT_THAT(WritePng(folder_.File(name), {FrameEncoding::kGray8, 64, 48, pixels}), IsOk());
  }

  TemporaryFolder folder_;
};

TEST_F(ImageListTest, Times) {
  EXPECT_EQ(ParseTime("1305031102.175304"), 1305031102175304000);
  EXPECT_EQ(ParseTime("1403636579763555584"), 1403636579763555584);
  EXPECT_EQ(ParseTime("1403636579763555"), 1403636579763555000);
  EXPECT_EQ(ParseTime("1403636579763"), 1403636579763000000);
  EXPECT_EQ(ParseTime("12"), 12000000000);
  EXPECT_EQ(ParseTime("0.5"), 500000000);
  for (const char* wrong : {"", "a.png", "-1", "1.", ".5", "1e9"}) {
    EXPECT_FALSE(ParseTime(wrong)) << wrong;
  }
}

// As TUM has it.
TEST_F(ImageListTest, SecondsAndFiles) {
  Image("rgb/a.png");
  Image("rgb/b b.png");
  const std::string path =
      Write("rgb.txt", "# color images\n\n100.5 rgb/a.png\n101.25 rgb/b b.png\n");
  const auto list = ReadImageList(path);
  ASSERT_THAT(list, IsOk());
  EXPECT_EQ(list->times_ns, (std::vector<std::int64_t>{100500000000, 101250000000}));
  EXPECT_EQ(list->paths[1], folder_.File("rgb/b b.png"));
  const auto source = OpenFrameSource(path, Side::kLeft);
  ASSERT_THAT(source, IsOk());
  EXPECT_EQ((*source)->keys().kind, FrameKeys::Kind::kTime);
  ASSERT_THAT((*source)->Next(), IsOk());
  const auto second = (*source)->Next();
  ASSERT_THAT(second, IsOk());
  ASSERT_TRUE(*second);
  EXPECT_EQ((**second).fault, "");
  EXPECT_EQ((**second).capture_time_ns, 101250000000);
}

// As EuRoC has it: CRLF, headings, the files in data/.
TEST_F(ImageListTest, NanosecondsWithCommas) {
  Image("data/1403636579763555584.png");
  const auto list = ReadImageList(Write("data.csv",
                                        "timestamp [ns],filename\r\n1403636579763555584,"
                                        "1403636579763555584.png\r\n"));
  ASSERT_THAT(list, IsOk());
  EXPECT_EQ(list->paths[0], folder_.File("data/1403636579763555584.png"));
}

TEST_F(ImageListTest, TheFileMayComeFirst) {
  const auto list = ReadImageList(Write("a.lst", "x.png 1.0\ny.png 2.0\n"));
  ASSERT_THAT(list, IsOk());
  EXPECT_EQ(list->paths[1], folder_.File("y.png"));
}

TEST_F(ImageListTest, WrongLinesAreNamed) {
  const auto expect = [this](const std::string& text, const std::string& message) {
    EXPECT_THAT(ReadImageList(Write("a.txt", text)),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(message)))
        << text;
  };
  expect("1.0 a.png\nb.png\n", "line 2: b.png must be a time");
  expect("1.0 a.png\n1.0 b.png\n", "line 2: 1.0 b.png must have a later time");
  expect("/data/0.png\n", "line 1");
  expect("# nothing\n", "names no images");
  expect("", "names no images");
  EXPECT_THAT(ReadImageList(folder_.File("none.txt")),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("none.txt")));
}

TEST_F(ImageListTest, AMissingImageIsAFrameWithAFault) {
  const auto source = OpenFrameSource(Write("a.txt", "1.0 missing.png\n"), Side::kLeft);
  ASSERT_THAT(source, IsOk());
  const auto frame = (*source)->Next();
  ASSERT_THAT(frame, IsOk());
  ASSERT_TRUE(*frame);
  EXPECT_THAT((**frame).fault, HasSubstr("missing.png"));
}

}  // namespace
}  // namespace homing::client
