// Addresses as text: HOST:PORT and unix:PATH.
#ifndef HOMING_BASE_HOST_PORT_H_
#define HOMING_BASE_HOST_PORT_H_

#include <algorithm>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "homing/base/field_error.h"

namespace homing {

struct HostPort {
  // Without the brackets of an IPv6 address.
  std::string host;
  int port = 0;
};

// An address "unix:PATH".
inline bool IsUnixSocket(const std::string& address) { return absl::StartsWith(address, "unix:"); }

// "host:port", "[IPv6]:port". INVALID_ARGUMENT naming `field`: another form, no port, or one
// outside [`lowest_port`, 65535].
inline absl::StatusOr<HostPort> ParseHostPort(const std::string& field, const std::string& text,
                                              int lowest_port) {
  const auto error = [&](const std::string& what) { return TextMustBe(field, text, what); };
  if (absl::StrContains(text, "://")) {
    return error(absl::StrCat("HOST:PORT, without ", text.substr(0, text.find("://") + 3)));
  }
  const std::size_t colon = text.rfind(':');
  const bool bracketed = !text.empty() && text[0] == '[';
  const std::size_t bracket = text.rfind(']');
  if (colon == std::string::npos || (bracketed && bracket != colon - 1)) {
    return error("HOST:PORT; the port is missing");
  }
  HostPort result;
  result.host = bracketed ? text.substr(1, bracket - 1) : text.substr(0, colon);
  if (!bracketed && absl::StrContains(result.host, ":")) {
    return error("HOST:PORT; an IPv6 address stands in brackets, as in [::1]:50551");
  }
  const bool plain = std::all_of(result.host.begin(), result.host.end(), absl::ascii_isgraph);
  if (result.host.empty() || !plain || absl::StrContains(result.host, "/")) {
    return error("HOST:PORT; the host is missing or has characters that no host has");
  }
  const std::string port = text.substr(colon + 1);
  const bool digits = !port.empty() && std::all_of(port.begin(), port.end(), absl::ascii_isdigit);
  if (!digits || !absl::SimpleAtoi(port, &result.port) || result.port < lowest_port ||
      result.port > 65535) {
    return error(absl::StrCat("HOST:PORT with a port in [", lowest_port, ", 65535]"));
  }
  return result;
}

}  // namespace homing

#endif  // HOMING_BASE_HOST_PORT_H_
