#include "server/access/text_table.h"

#include <toml++/toml.h>

#include "absl/strings/str_cat.h"
#include "homing/base/status_macros.h"
#include "server/access/flag_file.h"

namespace homing::server {
namespace {

// Only the line number is reported: the parser's description may quote a secret from the file.
absl::StatusOr<toml::table> Parse(const std::string& flag, const std::string& path,
                                  const std::string& text) {
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    return FlagFileError(flag, path,
                         absl::StrCat("is not TOML in line ", error.source().begin.line));
  }
}

}  // namespace

absl::Status NoTable(const std::string& flag, const std::string& path, const std::string& table) {
  return FlagFileError(flag, path, absl::StrCat("is empty and must hold [", table, "]"));
}

absl::StatusOr<TextTable> ReadTextTable(const std::string& flag, const std::string& path,
                                        const std::string& table) {
  HOMING_ASSIGN_OR_RETURN(const std::string text, ReadFlagFile(flag, path));
  const auto parsed = Parse(flag, path, text);
  if (!parsed.ok()) {
    return parsed.status();
  }
  TextTable read;
  for (const auto& [name, node] : *parsed) {
    if (name.str() != table || !node.is_table()) {
      return FlagFileError(flag, path, absl::StrCat("must hold one table, [", table, "]"));
    }
    read.is_present = true;
    for (const auto& [key, value] : *node.as_table()) {
      if (!value.is_string()) {
        return FlagFileError(flag, path,
                             absl::StrCat("has a value in [", table, "] that is not a string"));
      }
      read.entries.emplace(std::string(key.str()), value.value_or(std::string()));
    }
  }
  return read;
}

}  // namespace homing::server
