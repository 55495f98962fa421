#include "tests/integration/cli_fixture.h"

#include <signal.h>

#include <fstream>
#include <iostream>
#include <sstream>

namespace homing {
namespace {

constexpr char kListening[] = "listening on ";

}  // namespace

std::vector<nlohmann::json> Ran::Json() const {
  std::vector<nlohmann::json> objects;
  for (const std::string& line : lines) {
    objects.push_back(nlohmann::json::parse(line, nullptr, false));
    EXPECT_TRUE(objects.back().is_object()) << line;
  }
  return objects;
}

void CliTest::TearDown() {
  if (!HasFailure() || server_ == nullptr) return;
  server_->Signal(SIGTERM);
  const int code = server_->Wait();
  std::cerr << "homing-server at " << address_ << " ended with " << code << ":\n"
            << server_->Stderr();
}

void CliTest::StartServer(const std::string& database, const std::vector<std::string>& more) {
  const std::string listen = address_.empty() ? "127.0.0.1:0" : address_;
  std::vector<std::string> command = {HOMING_SERVER_PROGRAM, "--listen", listen, "--database",
                                      "sqlite:" + Path(database)};
  command.insert(command.end(), more.begin(), more.end());
  server_ = std::make_unique<Program>(command);
  while (const auto line = server_->ReadLine()) {
    const std::size_t found = line->find(kListening);
    if (found == std::string::npos) continue;
    const std::string address = line->substr(found + sizeof(kListening) - 1);
    address_ = address.substr(0, address.find_first_of(" ,\""));
    return;
  }
  FAIL() << "homing-server did not start: " << server_->Stderr();
}

void CliTest::KillServer() {
  server_->Signal(SIGKILL);
  server_->Wait();
  server_.reset();
}

std::vector<std::string> CliTest::Command(std::vector<std::string> arguments) const {
  std::vector<std::string> command = {HOMING_PROGRAM, "--server", address_};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return command;
}

Ran CliTest::Run(const std::vector<std::string>& command) {
  Program program(command);
  Ran ran;
  ran.code = program.Wait();
  ran.lines = program.lines();
  ran.errors = program.Stderr();
  return ran;
}

Ran CliTest::Homing(const std::vector<std::string>& arguments) const {
  return Run(Command(arguments));
}

std::string CliTest::Export(const std::string& journey) const {
  const std::string path = Path("exported");
  const Ran ran = Homing({"journeys", "export", journey, path});
  EXPECT_EQ(ran.code, 0) << ran.errors;
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  EXPECT_FALSE(bytes.str().empty());
  return bytes.str();
}

}  // namespace homing
