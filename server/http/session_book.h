// Logins of browsers: a cookie stands for a bearer token, which stays in the server.
#ifndef SERVER_HTTP_SESSION_BOOK_H_
#define SERVER_HTTP_SESSION_BOOK_H_

#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "homing/base/mutex.h"
#include "server/access/access_control.h"

namespace homing::server {

struct Login {
  // Sent with each call; empty where no credentials are needed.
  std::string token;
  // Each change must repeat it, so that no other site can make the browser send one.
  std::string csrf;
};

// Thread-safe.
class SessionBook {
 public:
  using Clock = std::function<std::chrono::steady_clock::time_point()>;
  static constexpr std::chrono::hours kLife{12};
  static constexpr std::chrono::minutes kLinkLife{15};

  // `access` must outlive it.
  SessionBook(AccessControl* access, Clock clock) : access_(access), clock_(std::move(clock)) {}

  // A session for a caller's own token; returns the cookie. UNAUTHENTICATED.
  absl::StatusOr<std::string> Open(const std::string& token);
  // The login of the cookie's session; std::nullopt: the cookie is unknown or has expired.
  std::optional<Login> Find(const std::string& cookie);
  void Close(const std::string& cookie);
  // The login of a user that a proxy names.
  absl::StatusOr<Login> OfUser(const std::string& identity);
  // The login that all browsers share if no credentials are needed.
  absl::StatusOr<Login> OfAnybody();

  // The secret of a link that logs `identity` in once.
  absl::StatusOr<std::string> MakeLink(const std::string& identity);
  // The cookie of a new session. UNAUTHENTICATED: the link was used or has expired.
  absl::StatusOr<std::string> TakeLink(const std::string& secret);

 private:
  struct Session {
    Login login;
    // The token was lent for this session.
    bool lent = false;
    std::chrono::steady_clock::time_point end;
  };
  struct Link {
    std::string identity;
    std::chrono::steady_clock::time_point end;
  };

  absl::StatusOr<std::string> Add(const std::string& token, bool lent);
  void RemoveExpired() HOMING_REQUIRES(mutex_);
  void MakeRoomFor(const std::string& token) HOMING_REQUIRES(mutex_);

  AccessControl* const access_;
  const Clock clock_;
  Mutex mutex_;
  // Cookies and secrets are kept as hashes, and searched by them.
  std::map<TokenHash, Session> sessions_ HOMING_GUARDED_BY(mutex_);
  std::map<TokenHash, Link> links_ HOMING_GUARDED_BY(mutex_);
  std::map<std::string, Login> users_ HOMING_GUARDED_BY(mutex_);
};

}  // namespace homing::server

#endif  // SERVER_HTTP_SESSION_BOOK_H_
