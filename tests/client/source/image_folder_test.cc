#include "client/source/image_folder.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "client/png_file.h"
#include "client/source/image_names.h"
#include "homing/image/frame.h"
#include "tests/support/status_matchers.h"

namespace homing::client {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class ImageFolderTest : public ::testing::Test {
 protected:
  ImageFolderTest()
      : folder_(std::filesystem::temp_directory_path() /
                ("homing_images_" + std::to_string(::getpid()))) {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~ImageFolderTest() override { std::filesystem::remove_all(folder_); }

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }
  void Write(const std::string& name, const std::string& bytes) const {
    std::ofstream(Path(name), std::ios::binary) << bytes;
  }
  std::vector<std::string> Names(const std::string& source) const {
    std::vector<std::string> names;
    const auto paths = ListImages(source);
    EXPECT_THAT(paths, IsOk());
    if (!paths.ok()) return names;
    for (const std::string& path : paths->paths) {
      names.push_back(std::filesystem::path(path).filename().string());
    }
    return names;
  }

  // A frame of 30 x 20 pixels that differs with `seed`.
  static SourceFrame Gray(int seed) {
    SourceFrame frame{FrameEncoding::kGray8, 30, 20, std::string(30 * 20, '\0'), 0};
    for (std::size_t i = 0; i < frame.data.size(); ++i) {
      frame.data[i] = static_cast<char>((static_cast<int>(i) + 1) * (7 * seed + 31));
    }
    return frame;
  }

  std::filesystem::path folder_;
};

TEST_F(ImageFolderTest, OrdersNumbersAsNumbers) {
  for (const char* name : {"10.png", "2.png", "0.png", "1.png", "notes.txt"}) Write(name, "x");
  EXPECT_EQ(Names(folder_.string()),
            (std::vector<std::string>{"0.png", "1.png", "2.png", "10.png"}));
}

TEST_F(ImageFolderTest, OrdersPrefixedAndPaddedNumbers) {
  EXPECT_TRUE(NaturalLess("frame2_a.png", "frame10_a.png"));
  EXPECT_TRUE(NaturalLess("frame002.png", "frame10.png"));
  EXPECT_TRUE(NaturalLess("a1b2.png", "a1b10.png"));
  EXPECT_FALSE(NaturalLess("frame10.png", "frame2.png"));
  EXPECT_FALSE(NaturalLess("same.png", "same.png"));
  EXPECT_NE(NaturalLess("01.png", "1.png"), NaturalLess("1.png", "01.png"));
  EXPECT_TRUE(NaturalLess("99999999999999999998.png", "99999999999999999999.png"));
}

TEST_F(ImageFolderTest, TakesTheFilesOfAGlob) {
  for (const char* name : {"left1.png", "left2.png", "right1.png"}) Write(name, "x");
  EXPECT_EQ(Names(Path("left*.png")), (std::vector<std::string>{"left1.png", "left2.png"}));
}

TEST_F(ImageFolderTest, AnEmptyFolderIsNotFound) {
  EXPECT_THAT(ListImages(folder_.string()),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr(folder_.string())));
}

TEST_F(ImageFolderTest, PassesPngOnUnchanged) {
  const SourceFrame image = Gray(1);
  ASSERT_THAT(WritePng(Path("a.png"), image), IsOk());
  const auto frame = ReadImage(Path("a.png"));
  ASSERT_THAT(frame, IsOk());
  EXPECT_EQ(frame->encoding, FrameEncoding::kPng);
  EXPECT_EQ(frame->data.size(), std::filesystem::file_size(Path("a.png")));
  const auto gray = DecodeGray(frame->view());
  ASSERT_THAT(gray, IsOk());
  ASSERT_TRUE(gray->isContinuous());
  EXPECT_EQ(std::string(reinterpret_cast<const char*>(gray->data), gray->total()), image.data);
}

TEST_F(ImageFolderTest, KnowsJpegByItsBytesNotItsName) {
  Write("wrongly_named.png", "\xff\xd8\xff\xe0 and so on");
  const auto frame = ReadImage(Path("wrongly_named.png"));
  ASSERT_THAT(frame, IsOk());
  EXPECT_EQ(frame->encoding, FrameEncoding::kJpeg);
}

TEST_F(ImageFolderTest, SaysWhichFileIsNoImage) {
  Write("broken.pgm", "nothing like an image");
  EXPECT_THAT(ReadImage(Path("broken.pgm")),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("broken.pgm")));
}

TEST_F(ImageFolderTest, AFileWithoutAnEndIsRefused) {
  std::filesystem::create_symlink("/dev/zero", Path("mask.png"));
  EXPECT_THAT(ReadImage(Path("mask.png")),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("not a regular file")));
}

TEST_F(ImageFolderTest, AFolderIsNoImage) {
  std::filesystem::create_directory(Path("a.png"));
  EXPECT_THAT(ReadImage(Path("a.png")), Not(IsOk()));
}

#ifdef HOMING_OPENCV_READERS
TEST_F(ImageFolderTest, ReadsOtherFormatsAsGray) {
  Write("a.pgm", "P5 3 2 255\nabcdef");
  const auto frame = ReadImage(Path("a.pgm"));
  ASSERT_THAT(frame, IsOk());
  EXPECT_EQ(frame->encoding, FrameEncoding::kGray8);
  EXPECT_EQ(frame->width, 3);
  EXPECT_EQ(frame->height, 2);
  EXPECT_EQ(frame->data, "abcdef");
}
#endif

TEST_F(ImageFolderTest, SeekGoesToAnyFrame) {
  for (int i = 0; i < 3; ++i) {
    ASSERT_THAT(WritePng(Path(std::to_string(i) + ".png"), Gray(i)), IsOk());
  }
  const auto source = MakeImageFolder(*ListImages(folder_.string()));
  EXPECT_EQ(source->size(), 3);
  const auto first = source->Next();
  ASSERT_TRUE(source->Seek(2));
  const auto third = source->Next();
  EXPECT_NE((*third)->data, (*first)->data);
  EXPECT_FALSE(source->Next()->has_value());
  ASSERT_TRUE(source->Seek(0));
  EXPECT_EQ((*source->Next())->data, (*first)->data);
  EXPECT_FALSE(source->Seek(4));
}

TEST_F(ImageFolderTest, BadFilesAreFramesWithAFault) {
  for (const int i : {0, 6}) {
    ASSERT_THAT(WritePng(Path(std::to_string(i) + ".png"), Gray(i)), IsOk());
  }
  std::ifstream whole(Path("0.png"), std::ios::binary);
  std::string bytes((std::istreambuf_iterator<char>(whole)), std::istreambuf_iterator<char>());
  Write("1.png", "");
  Write("2.png", bytes.substr(0, bytes.size() / 2));
  Write("3.jpg", "\xff\xd8 and nothing more");
  std::filesystem::create_symlink(Path("nowhere"), Path("4.png"));
  SourceFrame large{FrameEncoding::kGray8, 60, 40, std::string(60 * 40, 'x')};
  ASSERT_THAT(WritePng(Path("5.png"), large), IsOk());
  Write("._0.png", "what macOS leaves");
  Write("7.heic", "a phone's");
  const auto source = MakeImageFolder(*ListImages(folder_.string()));
  ASSERT_EQ(source->size(), 7);
  const std::vector<std::string> faults = {"",
                                           "1.png is empty",
                                           "2.png is damaged",
                                           "3.jpg is damaged",
                                           "4.png: No such file",
                                           "5.png is 60 x 40 pixels, the first image 30 x 20",
                                           ""};
  for (const std::string& fault : faults) {
    const auto frame = source->Next();
    ASSERT_THAT(frame, IsOk());
    ASSERT_TRUE(frame->has_value());
    EXPECT_THAT((*frame)->fault, HasSubstr(fault));
    EXPECT_EQ((*frame)->fault.empty(), fault.empty());
  }
  EXPECT_FALSE(source->Next()->has_value());
  EXPECT_THAT(source->remark(), HasSubstr("1 hidden files"));
  EXPECT_THAT(source->remark(), HasSubstr("1 files of a kind"));
}

TEST_F(ImageFolderTest, AnImageIsNoVideo) {
  ASSERT_THAT(WritePng(Path("0.png"), Gray(0)), IsOk());
  EXPECT_THAT(OpenFrameSource(Path("0.png"), Side::kLeft),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("is one image")));
}

#ifdef HOMING_OPENCV_READERS
TEST_F(ImageFolderTest, TextsAreNoVideos) {
  for (const char* name : {"list.txt", "film.nfo", "frames.csv", "noending"}) {
    std::string text;
    for (int i = 0; i < 90; ++i) text += "/data/left/" + std::to_string(i) + ".png\n";
    Write(name, text);
    EXPECT_THAT(OpenFrameSource(Path(name), Side::kLeft),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(name)));
  }
}
#endif

TEST_F(ImageFolderTest, OpenFrameSourceNamesTheProblem) {
  EXPECT_THAT(OpenFrameSource("", Side::kLeft),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("empty")));
  EXPECT_THAT(OpenFrameSource("sim:nowhere", Side::kLeft),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("nowhere")));
  EXPECT_THAT(OpenFrameSource("/no/such/folder", Side::kLeft),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("/no/such/folder")));
  Write("film.avi", "no film");
  const auto status = OpenFrameSource(Path("film.avi"), Side::kLeft).status();
  EXPECT_FALSE(status.ok());
  EXPECT_THAT(std::string(status.message()), HasSubstr("film.avi"));
}

}  // namespace
}  // namespace homing::client
