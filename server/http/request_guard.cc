#include "server/http/request_guard.h"

#include <algorithm>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_split.h"
#include "absl/strings/strip.h"

namespace homing::server {
namespace {

// The header's host without the port; an IPv6 address keeps its brackets.
std::string HostOnly(const std::string& host) {
  if (!host.empty() && host.front() == '[') return host.substr(0, host.find(']') + 1);
  return host.substr(0, host.rfind(':'));
}

bool IsAddress(const std::string& host) {
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') return true;
  return std::count(host.begin(), host.end(), '.') == 3 &&
         host.find_first_not_of("0123456789.") == std::string::npos;
}

}  // namespace

bool IsKnownHost(const std::string& host, const std::string& names) {
  const std::string name = absl::AsciiStrToLower(HostOnly(host));
  if (name == "localhost" || IsAddress(name)) return true;
  for (const absl::string_view known : absl::StrSplit(names, ',')) {
    const std::string stripped = absl::AsciiStrToLower(absl::StripAsciiWhitespace(known));
    if (!stripped.empty() && stripped == name) return true;
  }
  return false;
}

bool IsSameOrigin(const std::string& origin, const std::string& host) {
  if (origin.empty()) return true;
  absl::string_view rest = origin;
  if (!absl::ConsumePrefix(&rest, "https://") && !absl::ConsumePrefix(&rest, "http://")) {
    return false;
  }
  return absl::EqualsIgnoreCase(rest, host);
}

std::string CookieOf(const std::string& cookies, const std::string& name) {
  for (absl::string_view cookie : absl::StrSplit(cookies, ';')) {
    cookie = absl::StripAsciiWhitespace(cookie);
    if (absl::ConsumePrefix(&cookie, name) && absl::ConsumePrefix(&cookie, "=")) {
      return std::string(cookie);
    }
  }
  return "";
}

}  // namespace homing::server
