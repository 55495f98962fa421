// Lines "name figure bound ok|short": a bound and the measured figure.
#ifndef TESTS_FAULTS_FIGURES_H_
#define TESTS_FAULTS_FIGURES_H_

#include <iomanip>
#include <iostream>
#include <string>

namespace homing::faults {

// Prints each figure as it comes and remembers whether any was short.
class Figures {
 public:
  void AtMost(const std::string& name, double figure, double bound) {
    Tell(name, figure, "<=", bound, figure <= bound);
  }
  void AtLeast(const std::string& name, double figure, double bound) {
    Tell(name, figure, ">=", bound, figure >= bound);
  }
  // A check without a figure: `held` or not.
  void Holds(const std::string& name, bool held) { AtLeast(name, held ? 1 : 0, 1); }
  // A part that could not be done.
  void Failed(const std::string& name, const std::string& why) {
    std::cerr << name << ": " << why << '\n';
    Holds(name, false);
  }
  bool all_ok() const { return all_ok_; }

 private:
  void Tell(const std::string& name, double figure, const char* relation, double bound, bool ok) {
    all_ok_ = all_ok_ && ok;
    std::cout << name << ' ' << std::setprecision(6) << figure << ' ' << relation << bound << ' '
              << (ok ? "ok" : "short") << std::endl;
  }

  bool all_ok_ = true;
};

}  // namespace homing::faults

#endif  // TESTS_FAULTS_FIGURES_H_
