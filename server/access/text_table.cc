#include "server/access/text_table.h"

#include <toml++/toml.h>

#include <fstream>
#include <sstream>

#include "absl/strings/str_cat.h"

namespace homing::server {
namespace {

absl::Status Bad(const std::string& flag, const std::string& path, const std::string& what) {
  return absl::InvalidArgumentError(absl::StrCat(flag, " is \"", path, "\"; ", what));
}

// The parser's description may quote a line of the file: only the place is told.
absl::StatusOr<toml::table> Parse(const std::string& flag, const std::string& path,
                                  const std::string& text) {
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    return Bad(flag, path, absl::StrCat("line ", error.source().begin.line, " is not TOML"));
  }
}

}  // namespace

absl::StatusOr<std::map<std::string, std::string>> ReadTextTable(const std::string& flag,
                                                                 const std::string& path,
                                                                 const std::string& table) {
  const std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) {
    return Bad(flag, path, "the file cannot be read");
  }
  const auto parsed = Parse(flag, path, text.str());
  if (!parsed.ok()) {
    return parsed.status();
  }
  std::map<std::string, std::string> entries;
  for (const auto& [name, node] : *parsed) {
    if (name.str() != table || !node.is_table()) {
      return Bad(flag, path, absl::StrCat("it must hold one table, [", table, "]"));
    }
    for (const auto& [key, value] : *node.as_table()) {
      if (!value.is_string()) {
        return Bad(flag, path, absl::StrCat("every value of [", table, "] must be a string"));
      }
      entries.emplace(std::string(key.str()), value.value_or(std::string()));
    }
  }
  return entries;
}

}  // namespace homing::server
