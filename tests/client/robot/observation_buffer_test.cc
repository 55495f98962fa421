#include "client/robot/observation_buffer.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <thread>
#include <vector>

#include "tests/support/status_matchers.h"
#include "tests/support/temporary_folder.h"

namespace homing::robot {
namespace {

constexpr std::int64_t kBytes = 1000;

// Its capture time tells it from others.
v1::Observation Seen(std::int64_t second) {
  v1::Observation observation;
  observation.mutable_capture_time()->set_seconds(second);
  observation.mutable_left()->mutable_flow_vectors()->set_width(7);
  return observation;
}

class ObservationBufferTest : public ::testing::Test {
 protected:
  void Open(int in_memory, std::int64_t max_bytes = kBytes) {
    buffer_.reset();
    auto file = ObservationFile::Open(folder_.File("buffer"), "robots/r/journeys/out");
    ASSERT_THAT(file.status(), IsOk());
    auto buffer = ObservationBuffer::Create({max_bytes, 100, in_memory}, *std::move(file));
    ASSERT_THAT(buffer.status(), IsOk());
    buffer_ = *std::move(buffer);
  }

  void Add(std::int64_t first, std::int64_t end) {
    for (std::int64_t i = first; i < end; ++i) EXPECT_THAT(buffer_->Add(Seen(i)).status(), IsOk());
  }

  v1::Observation Next() {
    const auto next = buffer_->Next();
    EXPECT_THAT(next.status(), IsOk());
    return next.ok() && *next ? **next : v1::Observation();
  }

  // The next ones have these numbers, and were seen from second `seen` on.
  void Expect(std::int64_t first, std::int64_t end, std::int64_t seen) {
    for (std::int64_t i = first; i < end; ++i) {
      const v1::Observation next = Next();
      EXPECT_EQ(next.sequence(), i);
      EXPECT_EQ(next.capture_time().seconds(), seen + i - first);
    }
  }

  TemporaryFolder folder_;
  std::unique_ptr<ObservationBuffer> buffer_;
};

TEST_F(ObservationBufferTest, GivesThemInOrderFromDiskAndMemory) {
  Open(/*in_memory=*/3);
  Add(0, 10);
  EXPECT_EQ(buffer_->pending(), 10);
  Expect(0, 10, 0);
  EXPECT_TRUE(buffer_->Seek(4));
  Expect(4, 6, 4);
  buffer_->Acknowledge(8, 5);
  EXPECT_EQ(buffer_->pending(), 2);
  EXPECT_FALSE(buffer_->Seek(6));
  EXPECT_TRUE(buffer_->Seek(5));
  EXPECT_EQ(Next().sequence(), 5);
  EXPECT_EQ(Next().sequence(), 8);
}

TEST_F(ObservationBufferTest, ARestartLosesNothing) {
  Open(/*in_memory=*/100);
  Add(0, 5);
  Open(/*in_memory=*/0);
  EXPECT_EQ(buffer_->pending(), 5);
  Add(5, 7);
  EXPECT_EQ(buffer_->Align(2).value(), 0);
  Expect(2, 5, 2);
  const v1::Observation first_new = Next();
  EXPECT_EQ(first_new.sequence(), 5);
  EXPECT_TRUE(first_new.break_before());
  EXPECT_FALSE(Next().break_before());
}

// What was in memory when the program was killed had reached the server.
TEST_F(ObservationBufferTest, NewOnesGetTheNumbersThatTheServerExpects) {
  for (const int in_memory : {0, 100}) {
    Open(in_memory);
    Add(20, 23);
    EXPECT_EQ(buffer_->Align(12).value(), 0);
    Expect(12, 15, 20);
    EXPECT_EQ(buffer_->pending(), 3);
    EXPECT_EQ(*buffer_->Add(Seen(23)), 15);
    buffer_->Acknowledge(16, 16);
  }
}

// The server was restored from an older backup.
TEST_F(ObservationBufferTest, BehindObservationsThatTheServerLostTheOthersFollowAtOnce) {
  for (const std::int64_t reference : {7, 4}) {
    Open(/*in_memory=*/0);
    Add(0, 10);
    buffer_->Acknowledge(8, reference);
    Open(/*in_memory=*/0);
    Add(10, 11);
    const std::int64_t first = reference == 7 ? 7 : 8;
    EXPECT_EQ(buffer_->Align(2).value(), first - 2);
    // The program ends before it has sent anything.
    Open(/*in_memory=*/0);
    EXPECT_EQ(buffer_->Align(2).value(), 0);
    EXPECT_EQ(buffer_->pending(), 11 - first);
    v1::Observation next = Next();
    EXPECT_EQ(next.sequence(), 2);
    EXPECT_EQ(next.capture_time().seconds(), first);
    EXPECT_TRUE(next.break_before());
    Expect(3, 2 + 11 - first, first + 1);
    EXPECT_EQ(*buffer_->Add(Seen(11)), 2 + 11 - first);
    buffer_->Acknowledge(100, 100);
  }
}

TEST_F(ObservationBufferTest, AGapIsABreakBesideThatOfTheNewProgram) {
  Open(/*in_memory=*/0);
  Add(0, 10);
  buffer_->Acknowledge(8, 8);
  Open(/*in_memory=*/0);
  Add(10, 12);
  EXPECT_EQ(buffer_->Align(2).value(), 6);
  buffer_->ContinueAt(2);
  for (const bool is_break : {true, false, true, false}) {
    EXPECT_EQ(Next().break_before(), is_break);
  }
}

// Files of this process cannot grow meanwhile.
class FullDisk {
 public:
  FullDisk() {
    ignored_ = std::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit none = {0, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &none);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, ignored_);
  }

 private:
  rlimit before_{};
  void (*ignored_)(int) = nullptr;
};

TEST_F(ObservationBufferTest, OnAFullDiskWhatIsRefusedIsNotKept) {
  Open(/*in_memory=*/3);
  Add(0, 3);
  {
    const FullDisk full;
    for (int i = 0; i < 3; ++i) EXPECT_FALSE(buffer_->Add(Seen(3)).ok());
  }
  EXPECT_EQ(buffer_->pending(), 3);
  Add(3, 6);
  Expect(0, 6, 0);
}

TEST_F(ObservationBufferTest, OnAFullDiskAcknowledgedOnesStayInTheFile) {
  Open(/*in_memory=*/1);
  Add(0, 10);
  {
    const FullDisk full;
    buffer_->Acknowledge(6, 5);
  }
  EXPECT_EQ(buffer_->pending(), 4);
  EXPECT_TRUE(buffer_->Seek(6));
  Expect(6, 10, 6);
  buffer_->Acknowledge(7, 6);
  EXPECT_FALSE(buffer_->Seek(5));
}

TEST_F(ObservationBufferTest, IsBoundedAndMarksWhereFlowIsMissing) {
  Open(/*in_memory=*/2, /*max_bytes=*/100);
  std::int64_t count = 0;
  while (buffer_->Add(Seen(count)).ok()) ++count;
  EXPECT_GT(count, 2);
  EXPECT_LT(count, 20);
  EXPECT_THAT(buffer_->Add(Seen(0)).status(),
              StatusIs(absl::StatusCode::kResourceExhausted, ::testing::HasSubstr("full")));
  buffer_->Acknowledge(count, count - 1);
  Add(count, count + 1);
  EXPECT_TRUE(buffer_->Seek(count));
  EXPECT_TRUE(Next().break_before());
}

TEST_F(ObservationBufferTest, WaitsUntilClosed) {
  Open(/*in_memory=*/10);
  std::thread later([this] {
    Add(0, 1);
    buffer_->Close();
  });
  EXPECT_EQ(Next().capture_time().seconds(), 0);
  const auto end = buffer_->Next();
  ASSERT_THAT(end.status(), IsOk());
  EXPECT_FALSE(*end);
  later.join();
  EXPECT_THAT(buffer_->Add(Seen(1)).status(),
              StatusIs(absl::StatusCode::kFailedPrecondition, ::testing::HasSubstr("closed")));
}

TEST_F(ObservationBufferTest, StopWakesTheReader) {
  Open(/*in_memory=*/10);
  std::thread later([this] { buffer_->Stop(); });
  const auto end = buffer_->Next();
  ASSERT_THAT(end.status(), IsOk());
  EXPECT_FALSE(*end);
  later.join();
}

}  // namespace
}  // namespace homing::robot
