// Tests the simulated disk: it must lose unsynced data, and nothing else.
#include "tests/faults/power_cut.h"

#include <gmock/gmock.h>
#include <signal.h>

#include <filesystem>
#include <fstream>

#include "storage/connection.h"
#include "tests/integration/program.h"
#include "tests/support/status_matchers.h"
#include "tests/support/temporary_folder.h"

namespace homing::faults {
namespace {

using storage::Connection;

constexpr int kCommits = 120;
constexpr std::uint64_t kCuts = 10;

class PowerCutTest : public ::testing::Test {
 protected:
  PowerCutTest() {
    std::filesystem::create_directories(data_);
    std::filesystem::create_directories(control_);
  }

  // Commits under the layer until killed; the last number said to be committed.
  int Commit(const std::string& synchronous) {
    Program probe({"/usr/bin/env", std::string("LD_PRELOAD=") + FAULTY_DISK,
                   "FAULTY_DISK_DIR=" + data_, "FAULTY_DISK_LOG=" + log_,
                   "FAULTY_DISK_CONTROL=" + control_, SYNC_PROBE, data_ + "/probe.db",
                   synchronous});
    for (int i = 0; i < kCommits; ++i) EXPECT_TRUE(probe.ReadLine()) << probe.Stderr();
    probe.Signal(SIGKILL);
    probe.Wait();
    return std::stoi(probe.lines().back());
  }

  // The value that SQLite finds after the cut; -1: the file is damaged.
  int NumbersAfterCut(std::uint64_t seed) {
    std::ifstream file(log_, std::ios::binary);
    std::ostringstream log;
    log << file.rdbuf();
    WriteFiles(after_, CutPower({}, log.str(), seed).files);
    int found = -1;
    auto connection = Connection::Open(after_ + "/probe.db", Connection::Access::kReadWrite, 1000);
    if (!connection.ok()) return -1;
    const absl::Status status = (*connection)->Run([&] {
      const auto count = (*connection)->Integer("SELECT count(*) FROM numbers");
      const auto last = (*connection)->Integer("SELECT ifnull(max(n), 0) FROM numbers");
      if (count == last && (*connection)->Text("PRAGMA integrity_check") == "ok") {
        found = static_cast<int>(last);
      }
      return absl::OkStatus();
    });
    return status.ok() ? found : -1;
  }

  const TemporaryFolder folder_;
  const std::string data_ = folder_.File("data");
  const std::string control_ = folder_.File("control");
  const std::string after_ = folder_.File("after");
  const std::string log_ = folder_.File("log");
};

TEST_F(PowerCutTest, NothingCommittedIsLostWithSynchronousFull) {
  const int committed = Commit("FULL");
  for (std::uint64_t seed = 0; seed < kCuts; ++seed) {
    EXPECT_GE(NumbersAfterCut(seed), committed) << "seed " << seed;
  }
}

TEST_F(PowerCutTest, ItDoesLoseDataWithSynchronousOff) {
  const int committed = Commit("OFF");
  int losses = 0;
  for (std::uint64_t seed = 0; seed < kCuts; ++seed) losses += NumbersAfterCut(seed) < committed;
  EXPECT_GT(losses, 0);
}

TEST_F(PowerCutTest, ItDoesLoseDataWhenTheDiskLies) {
  std::ofstream(control_ + "/lie");
  const int committed = Commit("FULL");
  int losses = 0;
  for (std::uint64_t seed = 0; seed < kCuts; ++seed) losses += NumbersAfterCut(seed) < committed;
  EXPECT_GT(losses, 0);
}

}  // namespace
}  // namespace homing::faults
