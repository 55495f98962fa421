// A plot of cost against size, both axes logarithmic, as SVG.
#ifndef TESTS_BENCHMARK_PLOT_H_
#define TESTS_BENCHMARK_PLOT_H_

#include <string>
#include <utility>
#include <vector>

namespace homing::benchmarks {

struct Curve {
  std::string name;
  // Of any CSS colour.
  std::string color;
  // Both > 0.
  std::vector<std::pair<double, double>> points;
};

// Empty if there is nothing to draw.
std::string PlotSvg(const std::string& title, const std::string& x_label,
                    const std::string& y_label, const std::vector<Curve>& curves);

}  // namespace homing::benchmarks

#endif  // TESTS_BENCHMARK_PLOT_H_
