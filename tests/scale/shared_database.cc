#include "tests/scale/shared_database.h"

#include <array>
#include <cstdio>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/strip.h"

namespace homing::scale {

SharedDatabase::~SharedDatabase() {
  servers_.clear();
  Run("stop");
}

std::string SharedDatabase::Run(const std::string& command) const {
  const std::string line = absl::StrCat("sh ", script_, " ", command, " ",
                                        folder_.File("").substr(0, folder_.File("").size() - 1));
  std::FILE* const pipe = ::popen(line.c_str(), "r");
  if (pipe == nullptr) return "";
  std::string output;
  std::array<char, 4096> buffer{};
  while (const std::size_t size = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    output.append(buffer.data(), size);
  }
  return ::pclose(pipe) == 0 ? absl::StrCat(absl::StripSuffix(output, "\n"), " ") : "";
}

bool SharedDatabase::Start() {
  url_ = std::string(absl::StripSuffix(Run("start"), " "));
  return !url_.empty();
}

bool SharedDatabase::FailOver() const { return !Run("failover").empty(); }

bool SharedDatabase::AddReplica() const { return !Run("replica").empty(); }

bool SharedDatabase::StartServers(int count) {
  for (int i = 0; i < count; ++i) {
    servers_.push_back(std::make_unique<faults::ServerUnderTest>(
        server_program_, folder_.File(absl::StrCat("server", i)), url_));
    if (!servers_.back()->Start()) return false;
  }
  return true;
}

void SharedDatabase::StopServers() {
  for (const auto& server : servers_) server->Stop();
  servers_.clear();
}

std::string SharedDatabase::addresses() const {
  std::vector<std::string> all;
  for (const auto& server : servers_) all.push_back(server->address());
  return absl::StrJoin(all, ",");
}

}  // namespace homing::scale
