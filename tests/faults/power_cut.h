// The states of a disk after a power cut, computed from the record of its requests.
#ifndef TESTS_FAULTS_POWER_CUT_H_
#define TESTS_FAULTS_POWER_CUT_H_

#include <cstdint>
#include <map>
#include <string>

namespace homing::faults {

struct PowerCut {
  // Files after the cut, by name.
  std::map<std::string, std::string> files;
  // Writes that were not synced: how many there were, and how many of them were lost, whole or in
  // part.
  int unsynced = 0;
  int lost = 0;
};

// `before`: the files when the program started, all of them durable. `log`: the record since.
// Synced data is there. Of the later writes, in any order, some are there, some are not, and some
// in part (by sectors of 512 bytes). Names are as after some number of the unsynced changes.
// Random, from `seed`.
PowerCut CutPower(const std::map<std::string, std::string>& before, const std::string& log,
                  std::uint64_t seed);

// All files of `folder`, but those that are memory or locks (-shm, -lock).
std::map<std::string, std::string> ReadFiles(const std::string& folder);
// Makes the folder hold these files and no others.
void WriteFiles(const std::string& folder, const std::map<std::string, std::string>& files);

}  // namespace homing::faults

#endif  // TESTS_FAULTS_POWER_CUT_H_
