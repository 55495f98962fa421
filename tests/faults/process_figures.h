// How much a process holds, over time.
#ifndef TESTS_FAULTS_PROCESS_FIGURES_H_
#define TESTS_FAULTS_PROCESS_FIGURES_H_

#include <sys/types.h>

#include <vector>

namespace homing::faults {

struct ProcessFigures {
  double resident_mib = 0;
  double descriptors = 0;
};

ProcessFigures FiguresOf(pid_t process);

double MeanOf(const std::vector<double>& values);
// Of the straight line that fits best, between two values.
double SlopeOf(const std::vector<double>& values);
// `share` 0..1 of the values are at most this; 0 when there are none.
double QuantileOf(std::vector<double> values, double share);

}  // namespace homing::faults

#endif  // TESTS_FAULTS_PROCESS_FIGURES_H_
