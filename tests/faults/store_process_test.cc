// The server and its commands as processes, on whole, damaged, read-only and unreadable files.
#include <gmock/gmock.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <thread>

#include "storage/connection.h"
#include "tests/faults/await_health.h"
#include "tests/faults/power_cut.h"
#include "tests/faults/robot.h"
#include "tests/faults/server_under_test.h"
#include "tests/support/status_matchers.h"
#include "tests/support/temporary_folder.h"

namespace homing::faults {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr char kJourney[] = "robots/r/journeys/a";

struct Ran {
  int code = 0;
  std::string out;
  std::string errors;
};

Ran RunServer(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), HOMING_SERVER_PROGRAM);
  Program program(arguments);
  Ran ran;
  ran.code = program.Wait();
  for (const std::string& line : program.lines()) ran.out += line + '\n';
  ran.errors = program.Stderr();
  return ran;
}

class StoreProcessTest : public ::testing::Test {
 protected:
  StoreProcessTest() : server_(HOMING_SERVER_PROGRAM, folder_.File("data")) {
    WriteFiles(server_.folder(), {});
    WriteFiles(control_, {});
    robot_.pace = std::chrono::milliseconds(0);
    robot_.observations = 40;
    robot_.retry_for = std::chrono::milliseconds(0);
  }

  void Start(const std::vector<std::string>& flags = {}) {
    ASSERT_TRUE(server_.Start({"LD_PRELOAD=" FAULTY_DISK, "FAULTY_DISK_DIR=" + server_.folder(),
                               "FAULTY_DISK_CONTROL=" + control_},
                              flags));
    robot_.address = server_.address();
  }
  absl::Status Record(const std::string& journey = kJourney) {
    return RecordOne(robot_, journey, &ledger_);
  }
  std::string Export(const std::string& journey = kJourney) {
    const auto file = ExportOne(server_.address(), journey);
    EXPECT_THAT(file, IsOk());
    return file.value_or("");
  }
  void Set(const std::string& fault, const std::string& text = "") const {
    std::ofstream(control_ + "/" + fault) << text;
  }
  void Clear(const std::string& fault) const { fs::remove(control_ + "/" + fault); }

  const TemporaryFolder folder_;
  const std::string control_ = folder_.File("control");
  ServerUnderTest server_;
  const std::string database_ = server_.folder() + "/homing.db";
  RobotOptions robot_;
  Ledger ledger_;
};

TEST_F(StoreProcessTest, ABackupOfARunningServerIsRestored) {
  Start();
  ASSERT_THAT(Record(), IsOk());
  const std::string expected = Export();
  const std::string copy = folder_.File("copy.db");
  const Ran backup = RunServer({"backup", copy, "--database", server_.Url()});
  EXPECT_EQ(backup.code, 0) << backup.errors;
  EXPECT_EQ(RunServer({"backup", copy, "--database", server_.Url()}).code, 1)
      << "must not replace it";
  EXPECT_EQ(server_.Stop(), 0);
  // As docs/operations.md says.
  WriteFiles(server_.folder(), {});
  fs::rename(copy, database_);
  Start();
  EXPECT_TRUE(Export() == expected);
  EXPECT_THAT(Record("robots/r/journeys/b"), IsOk());
  EXPECT_EQ(server_.Stop(), 0);
}

TEST_F(StoreProcessTest, ReadOnlyLocalisesAndLeavesEveryByte) {
  Start();
  ASSERT_THAT(Record(), IsOk());
  const std::string expected = Export();
  ASSERT_EQ(server_.Stop(), 0);
  const auto before = ReadFiles(server_.folder());
  const auto changed = fs::last_write_time(database_);
  // The medium itself would refuse as well.
  Set("read-only");
  Start({"--readonly"});
  EXPECT_THAT(LocalizeOn(robot_, kJourney), IsOk());
  EXPECT_GT(LocalizeOn(robot_, kJourney).value_or(0), 0.5);
  EXPECT_TRUE(Export() == expected);
  EXPECT_THAT(Record("robots/r/journeys/b"),
              StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("read-only")));
  EXPECT_THAT(DeleteOne(robot_, kJourney),
              StatusIs(absl::StatusCode::kFailedPrecondition, HasSubstr("read-only")));
  EXPECT_THAT(server::CheckHealth(server_.address()), IsOk());
  EXPECT_EQ(server_.Stop(), 0);
  EXPECT_TRUE(ReadFiles(server_.folder()) == before);
  EXPECT_EQ(fs::last_write_time(database_), changed);
}

TEST_F(StoreProcessTest, ReadOnlyAfterAKillIsRefusedUntilItWasStartedOnce) {
  Start();
  ASSERT_THAT(Record(), IsOk());
  server_.Kill();
  const Ran refused =
      RunServer({"--listen", "127.0.0.1:0", "--database", server_.Url(), "--readonly"});
  EXPECT_EQ(refused.code, 1);
  EXPECT_THAT(refused.errors, HasSubstr("not closed cleanly"));
  Start();
  ASSERT_EQ(server_.Stop(), 0);
  Start({"--readonly"});
  EXPECT_THAT(LocalizeOn(robot_, kJourney), IsOk());
  EXPECT_EQ(server_.Stop(), 0);
}

TEST_F(StoreProcessTest, ADamagedFileIsReportedAndSalvaged) {
  // Enough for pages of their own.
  robot_.observations = 400;
  Start();
  ASSERT_THAT(Record(), IsOk());
  ASSERT_THAT(Record("robots/r/journeys/b"), IsOk());
  const std::string expected = Export();
  ASSERT_EQ(server_.Stop(), 0);
  const Ran whole = RunServer({"doctor", database_});
  EXPECT_EQ(whole.code, 0) << whole.out << whole.errors;
  EXPECT_THAT(whole.out, HasSubstr("the file is whole"));
  // The last page holds the end of the last recording.
  std::fstream file(database_, std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(static_cast<std::streamoff>(fs::file_size(database_)) - 4096);
  file << std::string(4096, 'x');
  file.close();
  const std::string saved = folder_.File("saved.db");
  const Ran damaged = RunServer({"doctor", "--database", server_.Url(), "--salvage", saved});
  EXPECT_EQ(damaged.code, 1);
  EXPECT_THAT(damaged.out, HasSubstr("DAMAGED"));
  EXPECT_THAT(damaged.out, HasSubstr("1 damaged"));
  WriteFiles(server_.folder(), {});
  fs::rename(saved, database_);
  Start();
  EXPECT_TRUE(Export() == expected);
  EXPECT_EQ(server_.Stop(), 0);
}

TEST_F(StoreProcessTest, WhereNothingCanBeWrittenItSaysSoAndEnds) {
  Set("read-only");
  const Ran ran = [&] {
    Program program({"/usr/bin/env", "LD_PRELOAD=" FAULTY_DISK,
                     "FAULTY_DISK_DIR=" + server_.folder(), "FAULTY_DISK_CONTROL=" + control_,
                     HOMING_SERVER_PROGRAM, "--listen", "127.0.0.1:0", "--database",
                     server_.Url()});
    const int code = program.Wait();
    return Ran{code, "", program.Stderr()};
  }();
  EXPECT_EQ(ran.code, 1);
  EXPECT_THAT(ran.errors, HasSubstr("unable to open database file"));
}

TEST_F(StoreProcessTest, AFailedReadIsRetriedLater) {
  Start();
  ASSERT_THAT(Record(), IsOk());
  ASSERT_EQ(server_.Stop(), 0);
  Start();
  Set("bad-read");
  EXPECT_THAT(LocalizeOn(robot_, kJourney),
              StatusIs(absl::StatusCode::kUnavailable, HasSubstr("I/O error")));
  Clear("bad-read");
  EXPECT_THAT(LocalizeOn(robot_, kJourney), IsOk());
  EXPECT_EQ(server_.Stop(), 0);
}

TEST_F(StoreProcessTest, AFileThatAnotherProgramKeepsLockedIsWaitedFor) {
  Start();
  auto other = storage::Connection::Open(database_, storage::Connection::Access::kReadWrite, 100);
  ASSERT_THAT(other, IsOk());
  EXPECT_THAT((*other)->Write([&] {
    EXPECT_THAT(Record(), StatusIs(absl::StatusCode::kUnavailable, HasSubstr("locked")));
    EXPECT_TRUE(AwaitHealth(server_.address(), false));
    return absl::OkStatus();
  }),
              IsOk());
  EXPECT_TRUE(AwaitHealth(server_.address(), true));
  EXPECT_THAT(Record(), IsOk());
  EXPECT_EQ(server_.Stop(), 0);
}

TEST_F(StoreProcessTest, AWallClockThatJumpsChangesNothing) {
  Start();
  ASSERT_THAT(Record(), IsOk());
  const std::string expected = Export();
  robot_.pace = std::chrono::milliseconds(10);
  std::thread jumps([this] {
    for (const char* seconds : {"315360000", "-315360000", "0"}) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      Set("clock", seconds);
    }
  });
  EXPECT_THAT(Record("robots/r/journeys/b"), IsOk());
  jumps.join();
  EXPECT_TRUE(Export("robots/r/journeys/b") == expected);
  EXPECT_EQ(server_.Stop(), 0);
}

}  // namespace
}  // namespace homing::faults
