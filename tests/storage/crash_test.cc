// Acknowledged observations survive the death of the process.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/storage/store_fixture.h"
#include "tests/support/status_matchers.h"

namespace homing::storage {
namespace {

// In the child: appends for ever and writes each acknowledged sequence to `pipe`.
[[noreturn]] void AppendUntilKilled(const std::string& url, int pipe) {
  auto store = OpenOrDie(url);
  StepMaker maker;
  while (true) {
    const JourneyStep step = maker.Next();
    if (!store->AppendSteps({AppendOf(kJourney, step)})[0].ok()) _exit(1);
    if (write(pipe, &step.step, sizeof(step.step)) != sizeof(step.step)) _exit(2);
  }
}

TEST(Crash, AcknowledgedStepsSurviveAKill) {
  const TemporaryFolder folder;
  ASSERT_THAT(OpenOrDie(folder.Database())->CreateJourney(Record(kJourney)), IsOk());
  std::int64_t acknowledged = -1;
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) AppendUntilKilled(folder.Database(), ends[1]);
  close(ends[1]);
  for (int i = 0; i < 40; ++i) {
    ASSERT_EQ(read(ends[0], &acknowledged, sizeof(acknowledged)),
              static_cast<ssize_t>(sizeof(acknowledged)));
  }
  ASSERT_EQ(kill(child, SIGKILL), 0);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  // Acknowledged before the kill arrived.
  while (read(ends[0], &acknowledged, sizeof(acknowledged)) > 0) {
  }
  close(ends[0]);

  auto store = OpenOrDie(folder.Database());
  const auto record = store->GetJourney(kJourney);
  ASSERT_THAT(record, IsOk());
  EXPECT_GE(acknowledged, 39);
  EXPECT_GE(record->next_sequence, acknowledged + 1);
  const std::vector<JourneyStep> steps = MakeSteps(static_cast<int>(record->next_sequence) + 5);
  const auto stored = static_cast<std::ptrdiff_t>(record->next_sequence);
  const auto map = store->LoadMap(kJourney);
  ASSERT_THAT(map, IsOk());
  EXPECT_TRUE(SameMap(*map, MapOf(OddSettings(), {steps.begin(), steps.begin() + stored})));
  AppendAll(*store, kJourney, {steps.begin() + stored, steps.end()});
  EXPECT_TRUE(SameMap(*store->LoadMap(kJourney), MapOf(OddSettings(), steps)));
}

}  // namespace
}  // namespace homing::storage
