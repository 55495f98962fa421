// usage: homing_scale SERVER BENCH DATABASE_SH PATRONI_SH [--quick] [--loaded]
// [--only rounds|patroni|throughput] [--rounds N]
#include <CLI/CLI.hpp>
#include <string>

#include "tests/scale/checks.h"

int main(int argc, char** argv) {
  homing::scale::Programs programs;
  bool quick = false;
  bool loaded = false;
  std::string only;
  int rounds = 0;
  CLI::App app("Many servers on one PostgreSQL, a line each.");
  app.add_option("server", programs.server)->required();
  app.add_option("bench", programs.bench)->required();
  app.add_option("database", programs.database)->required();
  app.add_option("patroni", programs.patroni)->required();
  app.add_flag("--quick", quick, "Few rounds, for CI");
  app.add_flag("--loaded", loaded, "Other work runs beside: gaps may be longer by half");
  app.add_option("--only", only, "One part");
  app.add_option("--rounds", rounds, "Rounds of kills");
  CLI11_PARSE(app, argc, argv);
  const int leaders = rounds > 0 ? rounds : quick ? 1 : 3;
  if (rounds == 0) rounds = quick ? 2 : 20;
  homing::faults::Figures figures;
  if (only.empty() || only == "rounds") {
    homing::scale::CheckRounds(programs, rounds, loaded ? 1.5 : 1.0, &figures);
  }
  if (only.empty() || only == "patroni") {
    homing::scale::CheckPatroni(programs, leaders, loaded ? 1.5 : 1.0, &figures);
  }
  if (only.empty() || only == "throughput") {
    homing::scale::CheckThroughput(programs, quick ? 4 : 20, &figures);
  }
  return figures.all_ok() ? 0 : 1;
}
