// homing-server and homing, the real programs, over a real socket and a file of their own.
#ifndef TESTS_INTEGRATION_CLI_FIXTURE_H_
#define TESTS_INTEGRATION_CLI_FIXTURE_H_

#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/integration/program.h"
#include "tests/support/temporary_folder.h"

namespace homing {

inline constexpr char kJourney[] = "robots/a/journeys/b";

// The result of one run of a program.
struct Ran {
  int code = 0;
  std::vector<std::string> lines;
  std::string errors;

  std::vector<nlohmann::json> Json() const;
};

class CliTest : public ::testing::Test {
 protected:
  // A failed test prints the server's output, and whether it still ran.
  void TearDown() override;

  // Starts the server on `database` (a name in the test's folder); the first time on a port of its
  // choice, later on the same one. `more`: further arguments of it.
  void StartServer(const std::string& database = "homing.db",
                   const std::vector<std::string>& more = {});
  // kill -9.
  void KillServer();

  // homing --server ADDRESS ...
  std::vector<std::string> Command(std::vector<std::string> arguments) const;
  Ran Homing(const std::vector<std::string>& arguments) const;
  static Ran Run(const std::vector<std::string>& command);
  // The exported file's bytes.
  std::string Export(const std::string& journey) const;
  std::string Path(const std::string& name) const { return folder_.File(name); }

  // Gone after the server.
  TemporaryFolder folder_;
  std::string address_;
  std::unique_ptr<Program> server_;
};

}  // namespace homing

#endif  // TESTS_INTEGRATION_CLI_FIXTURE_H_
