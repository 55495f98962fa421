// The server under valgrind: nothing is lost for good.
#include "tests/faults/checks.h"
#include "tests/faults/power_cut.h"
#include "tests/faults/robot.h"
#include "tests/faults/server_under_test.h"
#include "tests/support/temporary_folder.h"

namespace homing::faults {
namespace {

// Records, localises, exports and deletes, with flow vectors and with frames.
absl::Status UseAll(RobotOptions robot, Ledger* ledger) {
  for (robot.robot = 0; robot.robot < 2; ++robot.robot) {
    const std::string journey = JourneyOf(robot.robot, 0);
    if (absl::Status status = RecordOne(robot, journey, ledger); !status.ok()) return status;
    if (const auto share = LocalizeOn(robot, journey); !share.ok()) return share.status();
    if (const auto map = ExportOne(robot.address, journey); !map.ok()) return map.status();
  }
  return DeleteOne(robot, JourneyOf(0, 0));
}

}  // namespace

void CheckLeaks(const Programs& programs, Figures* figures) {
  const TemporaryFolder folder;
  WriteFiles(folder.File("data"), {});
  ServerUnderTest server(programs.server, folder.File("data"));
  const bool started = server.Start(
      {"valgrind", "--quiet", "--soname-synonyms=somalloc=libjemalloc*", "--leak-check=full",
       "--show-leak-kinds=definite", "--errors-for-leak-kinds=definite", "--error-exitcode=9"});
  if (!started) return figures->Failed("valgrind", "no server");
  RobotOptions robot;
  robot.address = server.address();
  robot.observations = 30;
  Ledger ledger;
  const absl::Status status = UseAll(robot, &ledger);
  if (!status.ok()) figures->Failed("valgrind", status.ToString());
  figures->AtMost("valgrind_exit_code", server.Stop(), 0);
}

}  // namespace homing::faults
