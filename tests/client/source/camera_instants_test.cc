#include "client/source/camera_instants.h"

#include <gtest/gtest.h>

#include <set>

#include "absl/strings/str_cat.h"
#include "client/camera_observations.h"
#include "tests/support/status_matchers.h"

namespace homing::client {
namespace {

using ::testing::HasSubstr;

std::optional<FlowOptions> FlowOrNone(bool flow) {
  return flow ? std::make_optional(FlowOptions()) : std::nullopt;
}

CameraObservations Observe(Cameras cameras, bool flow, const FrameChoice& choice = {}) {
  auto instants = CameraInstants::Create(std::move(cameras), choice);
  EXPECT_THAT(instants, IsOk());
  return CameraObservations(*std::move(instants), FlowOrNone(flow));
}

std::vector<std::string> Everything(CameraObservations& observations) {
  std::vector<std::string> all;
  while (true) {
    const auto next = observations.Next();
    EXPECT_THAT(next, IsOk());
    if (!next.ok() || !*next) return all;
    EXPECT_EQ((*next)->sequence(), static_cast<std::int64_t>(all.size()));
    all.push_back((*next)->SerializeAsString());
  }
}

// Frames of which some have a fault, of a known or unknown number.
class FaultyFolder : public FrameSource {
 public:
  FaultyFolder(std::int64_t size, std::set<std::int64_t> faulty, FrameKeys keys = {})
      : size_(size), faulty_(std::move(faulty)), keys_(std::move(keys)) {}

  absl::StatusOr<std::optional<SourceFrame>> Next() override {
    if (next_ == size_) return std::optional<SourceFrame>();
    SourceFrame frame{FrameEncoding::kGray8, 64, 48, std::string(64 * 48, '\0')};
    unsigned state = static_cast<unsigned>(next_) + 1;
    for (char& pixel : frame.data) pixel = static_cast<char>(state = state * 1103515245 + 12345);
    if (faulty_.contains(next_)) frame.fault = absl::StrCat("frame ", next_, " is empty");
    ++next_;
    return std::make_optional(std::move(frame));
  }
  std::int64_t size() const override { return size_; }
  bool Seek(std::int64_t index) override {
    next_ = index;
    return index <= size_;
  }
  FrameKeys keys() const override { return keys_; }

 private:
  std::int64_t size_;
  std::set<std::int64_t> faulty_;
  FrameKeys keys_;
  std::int64_t next_ = 0;
};

Cameras One(std::int64_t size, std::set<std::int64_t> faulty, FrameKeys keys = {}) {
  Cameras cameras;
  cameras[0] = std::make_unique<FaultyFolder>(size, std::move(faulty), std::move(keys));
  return cameras;
}

struct Row {
  std::int64_t frame = 0;
  bool gap = false;

  bool operator==(const Row&) const = default;
};

std::vector<Row> Rows(CameraObservations& observations) {
  std::vector<Row> rows;
  while (true) {
    const auto next = observations.Next();
    EXPECT_THAT(next, IsOk());
    if (!next.ok() || !*next) return rows;
    rows.push_back({observations.FrameOf((*next)->sequence()), (*next)->break_before()});
  }
}

TEST(CameraInstantsTest, BadFramesAreSkippedWithABreakAndReported) {
  std::vector<std::string> reports;
  FrameChoice choice;
  choice.report = [&](const std::string& text) { reports.push_back(text); };
  auto observations = Observe(One(6, {2, 5}), false, choice);
  EXPECT_EQ(Rows(observations), (std::vector<Row>{{0}, {1}, {3, true}, {4}}));
  EXPECT_EQ(reports,
            (std::vector<std::string>{"skipped: frame 2 is empty", "skipped: frame 5 is empty"}));
  auto flow = Observe(One(6, {2, 5}), true);
  // Flow never spans the gap, so it needs no break.
  EXPECT_EQ(Rows(flow), (std::vector<Row>{{1}, {4}}));
}

TEST(CameraInstantsTest, AHoleInTimeIsABreakAndReported) {
  constexpr std::int64_t kMs = 1'000'000;
  const FrameKeys keys{FrameKeys::Kind::kTime,
                       {0, 100 * kMs, 200 * kMs, 300 * kMs, 2500 * kMs, 2600 * kMs, 2700 * kMs}};
  std::vector<std::string> reports;
  FrameChoice choice;
  choice.strict = true;
  choice.report = [&](const std::string& text) { reports.push_back(text); };
  auto all = Observe(One(7, {}, keys), false, choice);
  EXPECT_EQ(Rows(all), (std::vector<Row>{{0}, {1}, {2}, {3}, {4, true}, {5}, {6}}));
  EXPECT_EQ(reports, (std::vector<std::string>{"--left has no frame for 2.2 s before frame 4; no "
                                               "step spans a part that is missing"}));
  // Where the first frame behind the hole is left out, too.
  choice.every = 3;
  auto third = Observe(One(7, {}, keys), false, choice);
  EXPECT_EQ(Rows(third), (std::vector<Row>{{0}, {3}, {6, true}}));
}

// Of two cameras, the instants count.
TEST(CameraInstantsTest, AHoleOfOneCameraIsOneOfThePair) {
  constexpr std::int64_t kMs = 1'000'000;
  Cameras cameras = One(4, {}, {FrameKeys::Kind::kTime, {0, 100 * kMs, 800 * kMs, 900 * kMs}});
  FrameKeys steady{FrameKeys::Kind::kTime, {}};
  for (std::int64_t i = 0; i < 10; ++i) steady.values.push_back(i * 100 * kMs);
  cameras[1] = std::move(One(10, {}, steady)[0]);
  auto observations = Observe(std::move(cameras), false);
  const std::vector<Row> rows = Rows(observations);
  ASSERT_EQ(rows.size(), 10U);
  for (const Row& row : rows) EXPECT_EQ(row.gap, row.frame == 8) << row.frame;
}

TEST(CameraInstantsTest, StrictEndsAtABadFrame) {
  FrameChoice choice;
  choice.strict = true;
  auto observations = Observe(One(6, {2}), false, choice);
  ASSERT_THAT(observations.Next(), IsOk());
  ASSERT_THAT(observations.Next(), IsOk());
  for (int again = 0; again < 2; ++again) {
    EXPECT_THAT(observations.Next(),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("frame 2")));
  }
}

TEST(CameraInstantsTest, NoUsableFrameIsAnError) {
  auto observations = Observe(One(3, {0, 1, 2}), false);
  EXPECT_THAT(observations.Next(),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("none of 3 frames")));
}

// A stream that begins in the middle, as after a restart, gives what one from the start gives.
TEST(CameraInstantsTest, SeekCountsUsableFramesOnly) {
  for (const bool send_flow : {false, true}) {
    auto whole = Observe(One(9, {0, 2, 6}), send_flow);
    const auto all = Everything(whole);
    ASSERT_EQ(all.size(), send_flow ? 3U : 6U);
    for (std::size_t from = 0; from < all.size(); ++from) {
      auto late = Observe(One(9, {0, 2, 6}), send_flow);
      ASSERT_TRUE(late.Seek(static_cast<std::int64_t>(from)));
      const auto next = late.Next();
      ASSERT_THAT(next, IsOk());
      v1::Observation expected;
      expected.ParseFromString(all[from]);
      EXPECT_EQ((*next)->left().SerializeAsString(), expected.left().SerializeAsString()) << from;
      EXPECT_EQ((*next)->sequence(), expected.sequence());
    }
  }
}

TEST(CameraInstantsTest, TakesEveryNthFrame) {
  FrameChoice choice;
  choice.every = 4;
  auto observations = Observe(One(10, {}), false, choice);
  EXPECT_EQ(observations.size(), 3);
  EXPECT_EQ(Rows(observations), (std::vector<Row>{{0}, {4}, {8}}));
  ASSERT_TRUE(observations.Seek(1));
  EXPECT_EQ(Rows(observations), (std::vector<Row>{{4}, {8}}));
}

FrameKeys TenASecond(std::int64_t count) {
  FrameKeys keys{FrameKeys::Kind::kTime, {}};
  for (std::int64_t i = 0; i < count; ++i) keys.values.push_back(7'000'000'000 + i * 100'000'000);
  return keys;
}

TEST(CameraInstantsTest, TakesFramesAtARateAndForATime) {
  FrameChoice choice;
  choice.fps = 4;
  choice.seconds = 1;
  auto observations = Observe(One(30, {}, TenASecond(30)), false, choice);
  EXPECT_EQ(Rows(observations), (std::vector<Row>{{0}, {3}, {5}, {8}}));
  ASSERT_TRUE(observations.Seek(2));
  EXPECT_EQ(Rows(observations), (std::vector<Row>{{5}, {8}}));
}

// As a damaged header does.
class VideoThatPromises : public FaultyFolder {
 public:
  VideoThatPromises(std::int64_t size, double fps) : FaultyFolder(size, {}), fps_(fps) {}
  std::int64_t size() const override { return -1; }
  std::int64_t promised_size() const override { return 1'000'000'000'000; }
  double fps() const override { return fps_; }

 private:
  double fps_;
};

TEST(CameraInstantsTest, VideosThatPromiseTooMuchAreReadSideBySide) {
  Cameras cameras;
  cameras[0] = std::make_unique<VideoThatPromises>(4, 10);
  cameras[1] = std::make_unique<VideoThatPromises>(4, 20);
  auto observations = Observe(std::move(cameras), false);
  EXPECT_EQ(Rows(observations), (std::vector<Row>{{0}, {1}, {2}, {3}}));
}

TEST(CameraInstantsTest, ARateNeedsTimes) {
  FrameChoice choice;
  choice.fps = 4;
  EXPECT_THAT(CameraInstants::Create(One(5, {}), choice),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("--every")));
}

TEST(CameraInstantsTest, LaterSourcesGoOnWithNumbers) {
  auto observations = Observe(One(4, {}), false);
  observations.StartAt(100);
  EXPECT_FALSE(observations.Seek(99));
  observations.ContinueAt(100);
  const auto first = observations.Next();
  ASSERT_THAT(first, IsOk());
  EXPECT_EQ((*first)->sequence(), 100);
  EXPECT_TRUE((*first)->break_before());
  EXPECT_EQ(observations.FrameOf(100), 0);
  ASSERT_TRUE(observations.Seek(102));
  EXPECT_EQ((*observations.Next())->sequence(), 102);
  EXPECT_EQ(observations.FrameOf(102), 2);
}

TEST(CameraInstantsTest, CamerasArePairedByNumber) {
  Cameras cameras = One(4, {}, {FrameKeys::Kind::kNumber, {0, 1, 2, 3}});
  cameras[1] = std::make_unique<FaultyFolder>(3, std::set<std::int64_t>(),
                                              FrameKeys{FrameKeys::Kind::kNumber, {0, 2, 3}});
  std::vector<std::string> reports;
  FrameChoice choice;
  choice.report = [&](const std::string& text) { reports.push_back(text); };
  auto observations = Observe(std::move(cameras), false, choice);
  ASSERT_EQ(reports.size(), 1U);
  EXPECT_THAT(reports[0], HasSubstr("paired by number: 1 of 4 frames of --left and 0 of 3"));
  std::vector<bool> has_right;
  while (true) {
    const auto next = observations.Next();
    if (!next.ok() || !*next) break;
    EXPECT_TRUE((*next)->has_left());
    has_right.push_back((*next)->has_right());
  }
  EXPECT_EQ(has_right, (std::vector<bool>{true, false, true, true}));
}
}  // namespace
}  // namespace homing::client
