// Checks of a browser's request that do not depend on the login: the site that sends it, and the
// host name that it uses.
#ifndef SERVER_HTTP_REQUEST_GUARD_H_
#define SERVER_HTTP_REQUEST_GUARD_H_

#include <string>

namespace homing::server {

// Against DNS rebinding: the header Host is an address, "localhost" or one of `names` (separated by
// commas), with any port. A foreign name that resolves to this machine is none of these.
bool IsKnownHost(const std::string& host, const std::string& names);

// The header Origin, if there is one, names the same host and port as `host`. Its scheme may
// differ: a proxy may add TLS.
bool IsSameOrigin(const std::string& origin, const std::string& host);

// The value of `name` in the header Cookie; empty: none.
std::string CookieOf(const std::string& cookies, const std::string& name);

}  // namespace homing::server

#endif  // SERVER_HTTP_REQUEST_GUARD_H_
