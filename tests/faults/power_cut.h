// What a disk may hold after the power went, told from the record of what it was asked to do.
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

// `before`: the files as the program found them, all on the disk. `log`: the record since. What was
// synced is there. Of the writes since, in any order, some are there, some are not, and some in
// part (by sectors of 512 bytes); the names are as after some number of the changes that were not
// synced. By chance, from `seed`.
PowerCut CutPower(const std::map<std::string, std::string>& before, const std::string& log,
                  std::uint64_t seed);

// All files of `folder`, but those that are memory or locks (-shm, -lock).
std::map<std::string, std::string> ReadFiles(const std::string& folder);
// Makes the folder hold these files and no others.
void WriteFiles(const std::string& folder, const std::map<std::string, std::string>& files);

}  // namespace homing::faults

#endif  // TESTS_FAULTS_POWER_CUT_H_
