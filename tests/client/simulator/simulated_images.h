// Simulators from text, and how alike two images are.
#ifndef TESTS_CLIENT_SIMULATOR_SIMULATED_IMAGES_H_
#define TESTS_CLIENT_SIMULATOR_SIMULATED_IMAGES_H_

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "client/simulator/simulator.h"
#include "tests/support/status_matchers.h"

namespace homing::client {

inline std::unique_ptr<Simulator> Make(const std::string& text) {
  const auto spec = ParseSimulationSpec(text);
  EXPECT_THAT(spec, IsOk());
  auto simulator = Simulator::Create(spec.value());
  EXPECT_THAT(simulator, IsOk());
  return std::move(simulator).value();
}

inline bool SameBytes(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && std::equal(a.datastart, a.dataend, b.datastart);
}

inline double MeanDifference(const cv::Mat& a, const cv::Mat& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.total(); ++i) {
    sum += std::abs(int{a.data[i]} - int{b.data[i]});
  }
  return sum / static_cast<double>(a.total());
}

inline double Correlation(const cv::Mat& a, const cv::Mat& b) {
  const auto product = [](const cv::Mat& m, const cv::Mat& n) {
    const cv::Scalar mean_m = cv::mean(m);
    const cv::Scalar mean_n = cv::mean(n);
    return m.dot(n) - static_cast<double>(m.total()) * mean_m[0] * mean_n[0];
  };
  return product(a, b) / std::sqrt(product(a, a) * product(b, b));
}

}  // namespace homing::client

#endif  // TESTS_CLIENT_SIMULATOR_SIMULATED_IMAGES_H_
