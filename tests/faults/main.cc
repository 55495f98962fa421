// usage: homing_faults SERVER FAULTY_DISK [--quick] [--seed N] [--soak MINUTES]
//                      [--only kill|power|full|bad|lost|sockets|memory|leaks|soak]
//                      [--small-disk FOLDER]
#include <cstring>
#include <random>

#include <CLI/CLI.hpp>

#include "tests/faults/checks.h"

namespace {

struct Arguments {
  homing::faults::Programs programs;
  bool quick = false;
  std::string only;
  std::uint64_t seed = 0;
  double soak_minutes = 0;
  int robots = 200;
  bool valgrind = false;
  std::string small_disk;
};

void Run(const Arguments& a, homing::faults::Figures* figures) {
  using namespace homing::faults;  // NOLINT(google-build-using-namespace)
  const auto wanted = [&](const char* part) { return a.only.empty() || a.only == part; };
  if (wanted("kill")) CheckKills(a.programs, a.quick ? 10 : 200, false, a.seed, figures);
  if (wanted("power")) CheckKills(a.programs, a.quick ? 10 : 50, true, a.seed + 1, figures);
  if (wanted("full")) CheckFullDisk(a.programs, a.small_disk, figures);
  if (wanted("bad")) CheckBadDisk(a.programs, figures);
  if (wanted("lost")) CheckLostFile(a.programs, figures);
  if (wanted("sockets")) CheckSockets(a.programs, figures);
  if (wanted("memory")) CheckMemory(a.programs, figures);
  if (wanted("leaks") && a.valgrind && !a.quick) CheckLeaks(a.programs, figures);
  if (a.soak_minutes > 0 && wanted("soak")) {
    CheckSoak(a.programs, a.soak_minutes, a.robots, figures);
  }
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  arguments.seed = std::random_device{}();
  CLI::App app("Faults: what the server must live through, a line each.");
  app.add_option("server", arguments.programs.server)->required();
  app.add_option("faulty_disk", arguments.programs.faulty_disk)->required();
  app.add_flag("--quick", arguments.quick, "Few of each, for CI");
  app.add_option("--only", arguments.only, "One part");
  app.add_option("--seed", arguments.seed, "By default another each time");
  app.add_option("--soak", arguments.soak_minutes, "Minutes of soak");
  app.add_option("--robots", arguments.robots, "Robots of the soak");
  app.add_flag("--valgrind", arguments.valgrind, "It is installed: look for leaks with it");
  app.add_option("--small-disk", arguments.small_disk, "A file system of a few MiB, empty");
  CLI11_PARSE(app, argc, argv);
  std::cerr << "seed " << arguments.seed << '\n';
  homing::faults::Figures figures;
  Run(arguments, &figures);
  return figures.all_ok() ? 0 : 1;
}
