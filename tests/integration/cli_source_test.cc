// What real sources do to a recording: bad frames, other sources, pipes, names of files.
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/stat.h>

#include <fstream>

#include "tests/integration/cli_fixture.h"

namespace homing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class CliSourceTest : public CliTest {
 protected:
  void SetUp() override {
    StartServer();
    const Ran ran =
        Run({HOMING_PROGRAM, "simulate", "--scene", "street,length=2", "--out", Path("drive")});
    ASSERT_EQ(ran.code, 0) << ran.errors;
  }
  Ran Record(const std::string& source, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"record", "--journey", kJourney, "--left", source};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Homing(arguments);
  }
  nlohmann::json Shown() const {
    return Homing({"--json", "journeys", "show", kJourney}).Json().at(0);
  }
};

TEST_F(CliSourceTest, AnEmptyFrameIsSkippedAndTheJourneyFinished) {
  std::ofstream(Path("drive/left/000003.png"), std::ios::trunc);
  const Ran ran = Record(Path("drive/left"), {"--json"});
  EXPECT_EQ(ran.code, 0);
  EXPECT_THAT(ran.errors, HasSubstr("000003.png is empty"));
  EXPECT_EQ(Shown()["state"], "FINISHED");
  EXPECT_EQ(ran.Json().at(3)["sequence"], 3);
  EXPECT_EQ(ran.Json().at(3)["frame"], 4);
}

TEST_F(CliSourceTest, StrictRefusesABadFrameAndKeepsWhatIsBeforeIt) {
  std::ofstream(Path("drive/left/000003.png"), std::ios::trunc);
  const Ran ran = Record(Path("drive/left"), {"--strict"});
  EXPECT_EQ(ran.code, 1);
  EXPECT_THAT(ran.errors, HasSubstr("000003.png is empty"));
  EXPECT_EQ(Shown()["next_sequence"], 3);
}

TEST_F(CliSourceTest, NoUsableFrameLeavesNoJourney) {
  std::filesystem::create_directories(Path("bad"));
  std::ofstream(Path("bad/0.png")) << "\x89PNG and nothing more";
  const Ran ran = Record(Path("bad"));
  EXPECT_EQ(ran.code, 1);
  EXPECT_THAT(ran.errors, HasSubstr("0.png is damaged"));
  EXPECT_EQ(Homing({"journeys", "list", "--json"}).lines.size(), 0U);
}

TEST_F(CliSourceTest, AnotherSourceNeedsResume) {
  ASSERT_EQ(Record("sim:street,length=2", {"--no-finish"}).code, 0);
  const std::int64_t first = Shown()["next_sequence"];
  // The same source continues without --resume.
  ASSERT_EQ(Record("sim:street,length=2", {"--no-finish"}).code, 0);
  EXPECT_EQ(Shown()["next_sequence"], first);
  const Ran other = Record(Path("drive/left"));
  EXPECT_EQ(other.code, 1);
  EXPECT_THAT(other.errors, HasSubstr("--resume"));
  EXPECT_EQ(Shown()["next_sequence"], first);
  ASSERT_EQ(Record(Path("drive/left"), {"--resume", "--no-finish"}).code, 0);
  const std::int64_t both = Shown()["next_sequence"];
  EXPECT_GT(both, first);
  // The second source, begun again, continues where it stopped too.
  ASSERT_EQ(Record(Path("drive/left"), {"--no-finish"}).code, 0);
  EXPECT_EQ(Shown()["next_sequence"], both);
}

TEST_F(CliSourceTest, ANameThatIsTakenIsExplained) {
  ASSERT_EQ(Record("sim:street,length=2").code, 0);
  const Ran again = Record("sim:street,length=2");
  EXPECT_EQ(again.code, 1);
  EXPECT_THAT(again.errors, HasSubstr("give another name"));
}

TEST_F(CliSourceTest, FinishClosesAJourneyThatNobodyRecords) {
  ASSERT_EQ(Record("sim:street,length=2", {"--no-finish"}).code, 0);
  const Ran ran = Homing({"journeys", "finish", kJourney});
  EXPECT_EQ(ran.code, 0) << ran.errors;
  EXPECT_EQ(Shown()["state"], "FINISHED");
  EXPECT_EQ(Homing({"journeys", "finish", "robots/a/journeys/none"}).code, 1);
}

TEST_F(CliSourceTest, FinishNeedsForceWhileAStreamRecords) {
  Program record(Command({"record", "--json", "--journey", kJourney, "--left",
                          "sim:street,length=900", "--window", "1"}));
  ASSERT_TRUE(record.ReadLine().has_value());
  const Ran refused = Homing({"journeys", "finish", kJourney});
  EXPECT_EQ(refused.code, 1);
  EXPECT_THAT(refused.errors, HasSubstr("force"));
  EXPECT_EQ(Homing({"journeys", "finish", "--force", kJourney}).code, 0);
  EXPECT_EQ(record.Wait(), 1);
  EXPECT_EQ(Shown()["state"], "FINISHED");
}

TEST_F(CliSourceTest, ReadersCanBeChanged) {
  ASSERT_EQ(Record("sim:street,length=2").code, 0);
  ASSERT_EQ(Homing({"journeys", "set-readers", kJourney, "robots/b", "*"}).code, 0);
  EXPECT_EQ(Shown()["readers"], (std::vector<std::string>{"robots/b", "*"}));
  EXPECT_EQ(Homing({"journeys", "set-readers", kJourney, "b"}).code, 1);
  ASSERT_EQ(Homing({"journeys", "set-readers", kJourney}).code, 0);
  EXPECT_TRUE(Shown()["readers"].empty());
}

TEST_F(CliSourceTest, AMapWithoutUseSaysSo) {
  std::filesystem::create_directories(Path("still"));
  for (const char* name : {"still/0.png", "still/1.png", "still/2.png", "still/3.png"}) {
    std::filesystem::copy_file(Path("drive/left/000000.png"), Path(name));
  }
  const Ran ran = Record(Path("still"));
  EXPECT_EQ(ran.code, 0);
  EXPECT_THAT(ran.errors, HasSubstr("POOR: "));
  EXPECT_EQ(Shown()["quality"], "POOR");
}

TEST_F(CliSourceTest, ErrorsOfLocalFilesAreTheSystems) {
  ASSERT_EQ(Record("sim:street,length=2").code, 0);
  const std::vector<std::vector<std::string>> commands = {
      {"draw", "--journey", kJourney, "--out", Path("nodir/a.png")},
      {"draw", "--journey", kJourney, "--out", Path("nodir/a.svg")},
      {"journeys", "export", kJourney, Path("nodir/a.homing")},
      {"journeys", "import", "robots/a/journeys/c", Path("nodir/a.homing")},
      {"backup", Path("nodir/a.db")},
  };
  for (const auto& arguments : commands) {
    const Ran ran = Homing(arguments);
    EXPECT_EQ(ran.code, 1) << arguments[0];
    EXPECT_THAT(ran.errors, HasSubstr("No such file or directory"));
    EXPECT_THAT(ran.errors, Not(HasSubstr("role")));
  }
}

TEST_F(CliSourceTest, ExportAndBackupKeepLinksAndWriteIntoDevices) {
  ASSERT_EQ(Record("sim:street,length=2").code, 0);
  const std::vector<std::string> exporting = {"journeys", "export", kJourney};
  for (std::vector<std::string> command : {exporting, {"backup"}}) {
    std::ofstream(Path("target")) << "old";
    std::filesystem::create_symlink(Path("target"), Path("link"));
    command.push_back(Path("link"));
    EXPECT_EQ(Homing(command).code, 0);
    EXPECT_TRUE(std::filesystem::is_symlink(Path("link")));
    EXPECT_GT(std::filesystem::file_size(Path("target")), 3U);
    std::filesystem::remove(Path("link"));
    command.back() = "/dev/null";
    const Ran ran = Homing(command);
    EXPECT_EQ(ran.code, 0) << ran.errors;
    EXPECT_EQ(ran.lines, std::vector<std::string>{"/dev/null: written"});
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  }
}

TEST_F(CliSourceTest, ExportRefusesReadOnlyFiles) {
  ASSERT_EQ(Record("sim:street,length=2").code, 0);
  std::ofstream(Path("kept")) << "kept";
  std::filesystem::permissions(Path("kept"), std::filesystem::perms::owner_read);
  const Ran refused = Homing({"journeys", "export", kJourney, Path("kept")});
  EXPECT_EQ(refused.code, 1);
  EXPECT_THAT(refused.errors, HasSubstr("Permission denied"));
  EXPECT_EQ(std::filesystem::file_size(Path("kept")), 4U);
}

TEST_F(CliSourceTest, AFullDiskBehindStandardOutputIsAnError) {
  ASSERT_EQ(Record("sim:street,length=2").code, 0);
  const std::string program = std::string(HOMING_PROGRAM) + " --server " + address_;
  for (const std::string& command : {" journeys export " + std::string(kJourney) + " - >/dev/full",
                                     std::string(" backup - >/dev/full")}) {
    const Ran ran = Run({"/bin/sh", "-c", program + command});
    EXPECT_EQ(ran.code, 1) << command;
    EXPECT_THAT(ran.errors, HasSubstr("No space left on device")) << command;
  }
}

TEST_F(CliSourceTest, TheServersProgramReportsItToo) {
  const std::string program = HOMING_SERVER_PROGRAM;
  for (const std::string& command : {std::string(" --check-config >/dev/full"),
                                     " doctor " + Path("homing.db") + " >/dev/full"}) {
    const Ran ran = Run({"/bin/sh", "-c", program + command});
    EXPECT_EQ(ran.code, 1) << command;
    EXPECT_THAT(ran.errors, HasSubstr("standard output: not all of it")) << command;
  }
}

TEST_F(CliSourceTest, ABackupDoesNotReplaceADatabaseInUse) {
  ASSERT_EQ(Record("sim:street,length=2").code, 0);
  const Ran refused = Homing({"backup", Path("homing.db")});
  EXPECT_EQ(refused.code, 1);
  EXPECT_THAT(refused.errors, HasSubstr("is a database in use"));
  EXPECT_EQ(Homing({"journeys", "show", kJourney}).code, 0);
}

TEST_F(CliSourceTest, ExportWritesIntoAPipe) {
  ASSERT_EQ(Record("sim:street,length=2").code, 0);
  ASSERT_EQ(::mkfifo(Path("pipe").c_str(), 0600), 0);
  Program stopped(Command({"journeys", "export", kJourney, Path("pipe")}));
  stopped.Signal(SIGTERM);
  EXPECT_NE(stopped.Wait(), 0);
  Program exported(Command({"journeys", "export", kJourney, Path("pipe")}));
  const Ran read = Run({"/bin/sh", "-c", "wc -c < " + Path("pipe")});
  EXPECT_EQ(exported.Wait(), 0) << exported.Stderr();
  EXPECT_GT(std::stoll(read.lines.at(0)), 100);
  EXPECT_TRUE(std::filesystem::is_fifo(Path("pipe")));
}

TEST_F(CliSourceTest, SimulateDoesNotMixTwoDrives) {
  const Ran again =
      Run({HOMING_PROGRAM, "simulate", "--scene", "street,length=1", "--out", Path("drive")});
  EXPECT_EQ(again.code, 1);
  EXPECT_THAT(again.errors, HasSubstr("holds a drive already"));
}

TEST_F(CliSourceTest, AGlobWithoutQuotesIsExplained) {
  const Ran ran = Record(Path("drive/left/000000.png"), {Path("drive/left/000001.png")});
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.errors, HasSubstr("quotes"));
}

TEST_F(CliSourceTest, AddressesHaveAPort) {
  for (const char* address : {"127.0.0.1", "http://127.0.0.1:50551", "127.0.0.1:99999", "::1:5"}) {
    const Ran ran = Run({HOMING_PROGRAM, "--server", address, "journeys", "list"});
    EXPECT_EQ(ran.code, 2) << address;
    EXPECT_THAT(ran.errors, HasSubstr("HOST:PORT"));
  }
}

}  // namespace
}  // namespace homing
