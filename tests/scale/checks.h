// The checks of tests/scale/run.sh; each writes its lines.
#ifndef TESTS_SCALE_CHECKS_H_
#define TESTS_SCALE_CHECKS_H_

#include <string>

#include "tests/faults/figures.h"

namespace homing::scale {

struct Programs {
  std::string server;
  // homing-bench.
  std::string bench;
  // database.sh, and patroni.sh.
  std::string database;
  std::string patroni;
};

// Robots record and localise through three servers on one database, while servers are killed and
// paused and the database is killed and its replica promoted, `rounds` times. Compares all maps
// with those of an undisturbed run on SQLite. The longest gaps may be `tolerance` times their
// bounds.
void CheckRounds(const Programs& programs, int rounds, double tolerance, faults::Figures* figures);

// The same with PostgreSQL under Patroni, whose leader is killed `rounds` times; nothing else
// happens.
void CheckPatroni(const Programs& programs, int rounds, double tolerance, faults::Figures* figures);

// Durable observations a second with SQLite, with one, two and three servers on PostgreSQL, and
// with no server at all. `seconds` each.
void CheckThroughput(const Programs& programs, int seconds, faults::Figures* figures);

}  // namespace homing::scale

#endif  // TESTS_SCALE_CHECKS_H_
