// Exit codes of `homing`: 0 done, 1 the work failed, 2 wrong usage, 3 server unreachable.
#include <gmock/gmock.h>

#include <fstream>

#include "tests/integration/cli_fixture.h"

namespace homing {
namespace {

using ::testing::HasSubstr;

constexpr char kShortScene[] = "sim:street,length=2";

class CliExitCodeTest : public CliTest {};

TEST_F(CliExitCodeTest, HelpAndVersionAreDone) {
  const Ran help = Run({HOMING_PROGRAM, "--help"});
  EXPECT_EQ(help.code, 0);
  EXPECT_FALSE(help.lines.empty());
  for (const char* command : {"record", "localize", "match", "journeys", "train", "simulate",
                              "draw", "evaluate", "backup"}) {
    EXPECT_EQ(Run({HOMING_PROGRAM, command, "--help"}).code, 0) << command;
  }
  EXPECT_THAT(Run({HOMING_PROGRAM, "--version"}).lines.at(0), HasSubstr("homing 0."));
}

TEST_F(CliExitCodeTest, WrongUsageIsTwo) {
  const std::vector<std::vector<std::string>> wrong = {
      {},
      {"fly"},
      {"record"},
      {"record", "--journey", kJourney},
      {"record", "--journey", "b", "--left", kShortScene},
      {"record", "--journey", kJourney, "--left", "sim:moon"},
      {"record", "--journey", kJourney, "--left", "sim:street,length=-3"},
      {"record", "--journey", kJourney, "--left", kShortScene, "--send", "pigeons"},
      {"record", "--journey", kJourney, "--left", kShortScene, "--left-camera", "1,2"},
      {"record", "--journey", kJourney, "--left", kShortScene, "--no-such-flag"},
      {"localize", "--journey", kJourney, "--left", kShortScene, "--threshold", "7"},
      {"localize", "--journey", kJourney, "--left", kShortScene, "--threshold", "nan"},
      {"record", "--journey", kJourney, "--left", kShortScene, "--fps", "nan"},
      {"localize", "--journey", kJourney, "--left", kShortScene, "--travel", "sideways"},
      {"match", "--journey", kJourney, "--left", "only_one.png"},
      {"journeys"},
      {"journeys", "show"},
      {"train", "--width", "320"},
      {"simulate", "--scene", "moon", "--out", "/tmp"},
      {"simulate", "--scene", "street,length=1", "--out", ""},
      {"draw", "--out", "a.svg"},
  };
  for (const auto& arguments : wrong) {
    std::vector<std::string> command = {HOMING_PROGRAM};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const Ran ran = Run(command);
    EXPECT_EQ(ran.code, 2) << ::testing::PrintToString(arguments) << ran.errors;
    EXPECT_FALSE(ran.errors.empty()) << ::testing::PrintToString(arguments);
  }
}

TEST_F(CliExitCodeTest, TheLoadGeneratorHasTheSameCodes) {
  EXPECT_EQ(Run({HOMING_BENCH_PROGRAM, "--help"}).code, 0);
  EXPECT_THAT(Run({HOMING_BENCH_PROGRAM, "--version"}).lines.at(0), HasSubstr("homing-bench 0."));
  EXPECT_EQ(Run({HOMING_BENCH_PROGRAM, "--no-such-flag"}).code, 2);
  EXPECT_EQ(Run({HOMING_BENCH_PROGRAM, "--send", "pigeons"}).code, 2);
  StartServer();
  const Ran ran = Run(
      {HOMING_BENCH_PROGRAM, "--server", address_, "--json", "--robots", "2", "--seconds", "1"});
  EXPECT_EQ(ran.code, 0) << ran.errors;
  EXPECT_EQ(ran.Json().at(0).at("dropped"), 0);
}

TEST_F(CliExitCodeTest, AnUnreachableServerIsThreeAndNamed) {
  address_ = "127.0.0.1:1";
  const std::vector<std::vector<std::string>> commands = {
      {"record", "--journey", kJourney, "--left", kShortScene},
      {"localize", "--journey", kJourney, "--left", kShortScene},
      {"journeys", "list"},
      {"journeys", "show", kJourney},
      {"train", "--width", "320", "--height", "240"},
      {"draw", "--journey", kJourney, "--out", Path("a.svg")}};
  for (const auto& arguments : commands) {
    const Ran ran = Homing(arguments);
    EXPECT_EQ(ran.code, 3) << ran.errors;
    EXPECT_THAT(ran.errors, HasSubstr("127.0.0.1:1"));
  }
}

// As by nss-mdns: the name is in no DNS.
TEST_F(CliExitCodeTest, NamesAreResolvedAsByOtherPrograms) {
  StartServer();
  std::ofstream(Path("hosts")) << "127.0.0.1 base.local\n";
  const auto run = [&](std::vector<std::string> command) {
    command.insert(command.begin(), {"/usr/bin/env", "LD_PRELOAD=libnss_wrapper.so",
                                     "NSS_WRAPPER_HOSTS=" + Path("hosts")});
    return Run(command);
  };
  if (run({"getent", "hosts", "base.local"}).code != 0) {
    GTEST_SKIP() << "SKIPPED: libnss-wrapper is not installed";
  }
  const std::string port = address_.substr(address_.rfind(':'));
  const Ran ran = run({HOMING_PROGRAM, "--server", "base.local" + port, "journeys", "list"});
  EXPECT_EQ(ran.code, 0) << ran.errors;
}

TEST_F(CliExitCodeTest, AnUnknownJourneyIsOne) {
  StartServer();
  for (const auto& arguments : std::vector<std::vector<std::string>>{
           {"localize", "--journey", "robots/a/journeys/none", "--left", kShortScene},
           {"journeys", "show", "robots/a/journeys/none"},
           {"journeys", "delete", "robots/a/journeys/none"},
           {"journeys", "export", "robots/a/journeys/none", Path("none")}}) {
    const Ran ran = Homing(arguments);
    EXPECT_EQ(ran.code, 1) << ran.errors;
    EXPECT_THAT(ran.errors, HasSubstr("NOT_FOUND"));
  }
  EXPECT_FALSE(std::filesystem::exists(Path("none")));
  EXPECT_FALSE(std::filesystem::exists(Path("none.part")));
}

TEST_F(CliExitCodeTest, SourcesWithoutFramesAreOneAndNamed) {
  StartServer();
  std::filesystem::create_directories(Path("empty"));
  std::ofstream(Path("film.mp4")) << "no film";
  std::ofstream(Path("hollow.avi"));
  for (const char* source : {"empty", "film.mp4", "hollow.avi", "absent", "absent*.png"}) {
    const Ran ran = Homing({"record", "--journey", kJourney, "--left", Path(source)});
    EXPECT_EQ(ran.code, 1) << source;
    EXPECT_THAT(ran.errors, HasSubstr(source));
  }
  EXPECT_EQ(Homing({"journeys", "list", "--json"}).lines.size(), 0U);
}

TEST_F(CliExitCodeTest, AFinishedJourneyIsNotRecordedAgain) {
  StartServer();
  ASSERT_EQ(Homing({"record", "--journey", kJourney, "--left", kShortScene}).code, 0);
  const Ran again = Homing({"record", "--journey", kJourney, "--left", kShortScene});
  EXPECT_EQ(again.code, 1);
  EXPECT_THAT(again.errors, HasSubstr("ALREADY_EXISTS"));
}

}  // namespace
}  // namespace homing
