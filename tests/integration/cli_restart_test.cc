// Recording through kill -9 of the server and of the client: the map is that of an undisturbed run.
#include <gmock/gmock.h>
#include <signal.h>

#include <algorithm>
#include <filesystem>

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

// 0.8 km/h at 60 frames a second: the reference is some frames back.
constexpr char kSlow[] = "sim:street,length=1,seed=9,speed=0.8,fps=60";

TEST_P(CliRestartTest, ASlowRobotsServerAndClientAreKilled) {
  const auto record = [this](const std::string& journey) {
    return Command({"record", "--json", "--journey", journey, "--left", kSlow, "--send", GetParam(),
                    "--writer", "robot-a", "--window", "8"});
  };
  StartServer();
  ASSERT_EQ(Run(record("robots/a/journeys/whole")).code, 0);
  {
    Program killed(record(kJourney));
    ReadAnswers(killed, kAnswered);
    KillServer();
    StartServer();
    ReadAnswers(killed, 2 * kAnswered + 3);
    killed.Signal(SIGKILL);
    killed.Wait();
  }
  EXPECT_EQ(Run(record(kJourney)).code, 0);
  EXPECT_TRUE(Export(kJourney) == Export("robots/a/journeys/whole")) << "the maps differ";
}

class CliSendTest : public CliDriveTest {};

TEST_F(CliSendTest, FramesAndFlowOfASlowRobotGiveTheSameMap) {
  StartServer();
  for (const char* send : {"frames", "flow"}) {
    const Ran ran = Homing({"record", "--journey", std::string("robots/a/journeys/") + send,
                            "--left", kSlow, "--send", send});
    ASSERT_EQ(ran.code, 0) << ran.errors;
  }
  EXPECT_TRUE(Export("robots/a/journeys/frames") == Export("robots/a/journeys/flow"))
      << "the maps differ";
}

// A step ends with the first frame beyond the threshold: many frames a step, hardly any excess.
TEST_F(CliSendTest, ASlowRobotMakesAsManyStepsAtTwiceTheFrameRate) {
  StartServer();
  std::vector<double> steps;
  for (const char* fps : {"30", "60"}) {
    const std::string journey = std::string("robots/a/journeys/") + fps;
    const Ran ran = Homing({"record", "--journey", journey, "--left",
                            std::string("sim:street,length=1,seed=9,speed=0.2,fps=") + fps});
    ASSERT_EQ(ran.code, 0) << ran.errors;
    const auto shown = Homing({"journeys", "show", "--json", journey}).Json().at(0);
    EXPECT_GT(shown["fingerprint_count"], shown["step_count"]);
    steps.push_back(shown["step_count"].get<double>());
  }
  EXPECT_GT(steps[0], 50);
  EXPECT_NEAR(steps[1] / steps[0], 1, 0.08);
}

// A camera that stands, and one that gives each fifth frame twice.
TEST_F(CliSendTest, RepeatedFramesMakeNoStepAndTheMapRecognisesItself) {
  StartServer();
  std::filesystem::create_directories(Path("twice"));
  std::filesystem::create_directories(Path("still"));
  int number = 100;
  const auto frame_at = [](int i) {
    return Left() + "/" + std::to_string(1'000'000 + i).substr(1) + ".png";
  };
  for (int i = 0; std::filesystem::exists(frame_at(i)); ++i) {
    for (int copy = 0; copy < (i % 5 == 4 ? 2 : 1); ++copy) {
      std::filesystem::create_symlink(frame_at(i),
                                      Path("twice/" + std::to_string(number++) + ".png"));
    }
    std::filesystem::create_symlink(frame_at(0), Path("still/" + std::to_string(100 + i) + ".png"));
  }
  const auto record = [this](const std::string& id, const std::string& folder) {
    const std::string journey = "robots/a/journeys/" + id;
    EXPECT_EQ(Homing({"record", "--journey", journey, "--left", folder}).code, 0);
    return Homing({"journeys", "show", "--json", journey}).Json().at(0)["step_count"];
  };
  EXPECT_EQ(record("still", Path("still")), 0);
  EXPECT_EQ(record("twice", Path("twice")), record("once", Left()));
  const auto share = [this](const std::string& id, const std::string& folder) {
    const auto lines = Homing({"localize", "--json", "--travel", "same", "--journey",
                               "robots/a/journeys/" + id, "--left", folder})
                           .Json();
    const auto matches = std::ranges::count_if(
        lines, [](const nlohmann::json& line) { return line["outcome"] == "MATCH"; });
    return static_cast<double>(matches) / static_cast<double>(lines.size());
  };
  EXPECT_NEAR(share("twice", Path("twice")), share("once", Left()), 0.1);
}

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
