// The checks of tests/faults/run.sh; each writes its lines.
#ifndef TESTS_FAULTS_CHECKS_H_
#define TESTS_FAULTS_CHECKS_H_

#include <cstdint>
#include <string>

#include "tests/faults/figures.h"

namespace homing::faults {

struct Programs {
  std::string server;
  // faulty_disk.cc, for LD_PRELOAD.
  std::string faulty_disk;
};

// Kills the server `kills` times while 8 robots record. Compares the database with the acknowledged
// observations each time, and at the end all maps with those of undisturbed runs. `power`: the disk
// also loses unsynced data.
void CheckKills(const Programs& programs, int kills, bool power, std::uint64_t seed,
                Figures* figures);

// The disk fills up while robots record, and is emptied again. `folder`: a small file system of its
// own; empty: a faulty disk that says that it is full.
void CheckFullDisk(const Programs& programs, const std::string& folder, Figures* figures);

// EIO on write, sync and read, a file system that turns read-only, a wall clock that jumps.
void CheckBadDisk(const Programs& programs, Figures* figures);

// The database is moved away under robots that record, and put back.
void CheckLostFile(const Programs& programs, Figures* figures);

// File descriptors used up; HTTP requests that never end; headers without end, through nginx.
void CheckSockets(const Programs& programs, Figures* figures);

// Small requests that want much memory: maps, queries, exports and images.
void CheckMemory(const Programs& programs, Figures* figures);

// 200 robots record, finish, localise and delete for `minutes`, through restarts, cut links and bad
// clients.
void CheckSoak(const Programs& programs, double minutes, int robots, Figures* figures);

// Memory that is lost for good, or used wrongly, under valgrind.
void CheckLeaks(const Programs& programs, Figures* figures);

}  // namespace homing::faults

#endif  // TESTS_FAULTS_CHECKS_H_
