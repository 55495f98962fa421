#include "tests/faults/process_figures.h"

#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numeric>
#include <string>

namespace homing::faults {

ProcessFigures FiguresOf(pid_t process) {
  const std::string folder = "/proc/" + std::to_string(process);
  ProcessFigures figures;
  double all_pages = 0;
  double resident_pages = 0;
  std::ifstream(folder + "/statm") >> all_pages >> resident_pages;
  figures.resident_mib = resident_pages * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1048576;
  std::error_code error;
  const std::filesystem::directory_iterator files(folder + "/fd", error);
  if (!error) figures.descriptors = static_cast<double>(std::distance(begin(files), end(files)));
  return figures;
}

double MeanOf(const std::vector<double>& values) {
  if (values.empty()) return 0;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double SlopeOf(const std::vector<double>& values) {
  const double middle = (static_cast<double>(values.size()) - 1) / 2;
  const double mean = MeanOf(values);
  double products = 0;
  double squares = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double x = static_cast<double>(i) - middle;
    products += x * (values[i] - mean);
    squares += x * x;
  }
  return squares > 0 ? products / squares : 0;
}

double QuantileOf(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

}  // namespace homing::faults
