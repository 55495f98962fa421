// Recording through kill -9 of the server and of the client: the map is that of an undisturbed run.
#include <gmock/gmock.h>
#include <signal.h>

#include "tests/integration/cli_fixture.h"

namespace homing {
namespace {

using ::testing::HasSubstr;

// Observations answered before the blow.
constexpr std::size_t kAnswered = 25;

// A drive past a street, drawn once for all tests of this program.
class CliDriveTest : public CliTest {
 protected:
  static void SetUpTestSuite() {
    if (drive_ != nullptr) return;
    drive_ = std::make_unique<TemporaryFolder>();
    const Ran ran = Run({HOMING_PROGRAM, "simulate", "--scene", "street,length=16", "--out",
                         drive_->File("drive")});
    ASSERT_EQ(ran.code, 0) << ran.errors;
  }
  static std::string Left() { return drive_->File("drive/left"); }
  static std::string Right() { return drive_->File("drive/right"); }

 private:
  static inline std::unique_ptr<TemporaryFolder> drive_;
};

class CliRestartTest : public CliDriveTest, public ::testing::WithParamInterface<std::string> {
 protected:
  std::vector<std::string> Record() const {
    return Command({"record", "--json", "--journey", kJourney, "--left", Left(), "--right", Right(),
                    "--send", GetParam(), "--writer", "robot-a", "--window", "8"});
  }
  static void ReadAnswers(Program& program, std::size_t count) {
    while (program.lines().size() < count) {
      ASSERT_TRUE(program.ReadLine().has_value()) << program.Stderr();
    }
  }
  // Recorded without a break, on another database.
  std::string Undisturbed() {
    StartServer("undisturbed.db");
    const Ran ran = Run(Record());
    EXPECT_EQ(ran.code, 0) << ran.errors;
    EXPECT_GT(ran.lines.size(), 2 * kAnswered);
    const std::string exported = Export(kJourney);
    KillServer();
    return exported;
  }
};

INSTANTIATE_TEST_SUITE_P(Sent, CliRestartTest, ::testing::Values("frames", "flow"),
                         [](const auto& sent) { return sent.param; });

TEST_P(CliRestartTest, TheServerIsKilledAndStartedAgain) {
  const std::string expected = Undisturbed();
  StartServer();
  Program record(Record());
  ReadAnswers(record, kAnswered);
  KillServer();
  StartServer();
  EXPECT_EQ(record.Wait(), 0) << record.Stderr();
  EXPECT_THAT(record.Stderr(), HasSubstr("link restored"));
  EXPECT_TRUE(Export(kJourney) == expected) << "the maps differ";
}

TEST_P(CliRestartTest, TheClientIsKilledAndRunAgain) {
  const std::string expected = Undisturbed();
  StartServer();
  {
    Program record(Record());
    ReadAnswers(record, kAnswered);
    record.Signal(SIGKILL);
    EXPECT_EQ(record.Wait(), 128 + SIGKILL);
  }
  const Ran again = Run(Record());
  EXPECT_EQ(again.code, 0) << again.errors;
  EXPECT_THAT(again.errors, HasSubstr("resuming at observation"));
  EXPECT_TRUE(Export(kJourney) == expected) << "the maps differ";
}

TEST_P(CliRestartTest, TheClientIsInterruptedAndSaysHowToGoOn) {
  const std::string expected = Undisturbed();
  StartServer();
  {
    Program record(Record());
    ReadAnswers(record, kAnswered);
    record.Signal(SIGINT);
    EXPECT_EQ(record.Wait(), 1);
    EXPECT_THAT(record.Stderr(), HasSubstr("run the same command again"));
  }
  EXPECT_EQ(Homing({"journeys", "list", "--json"}).Json().at(0)["state"], "ACTIVE");
  EXPECT_EQ(Run(Record()).code, 0);
  EXPECT_TRUE(Export(kJourney) == expected) << "the maps differ";
}

TEST_P(CliRestartTest, LocalizingResumesWhenTheServerIsKilled) {
  StartServer();
  ASSERT_EQ(Run(Record()).code, 0);
  Program localize(
      Command({"localize", "--json", "--journey", kJourney, "--left", Left(), "--right", Right(),
               "--travel", "same", "--send", GetParam(), "--window", "8"}));
  ReadAnswers(localize, kAnswered);
  KillServer();
  StartServer();
  EXPECT_EQ(localize.Wait(), 0) << localize.Stderr();
  std::int64_t sequence = 0;
  for (const std::string& line : localize.lines()) {
    EXPECT_EQ(nlohmann::json::parse(line, nullptr, false)["sequence"], sequence++);
  }
}

class CliSendTest : public CliDriveTest {};

TEST_F(CliSendTest, FramesAndFlowGiveTheSameMap) {
  StartServer();
  for (const char* send : {"frames", "flow"}) {
    const Ran ran = Homing({"record", "--journey", std::string("robots/a/journeys/") + send,
                            "--left", Left(), "--right", Right(), "--send", send});
    ASSERT_EQ(ran.code, 0) << ran.errors;
  }
  EXPECT_TRUE(Export("robots/a/journeys/frames") == Export("robots/a/journeys/flow"))
      << "the maps differ";
}

}  // namespace
}  // namespace homing
