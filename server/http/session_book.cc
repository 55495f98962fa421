#include "server/http/session_book.h"

#include <algorithm>
#include <utility>

#include "homing/base/status_macros.h"

namespace homing::server {
namespace {

constexpr std::size_t kMaxSessions = 1000;
// Most sessions of one token. A further one ends the oldest, so that one caller cannot lock out the
// others.
constexpr std::ptrdiff_t kMaxOfOneToken = 20;

}  // namespace

void SessionBook::MakeRoomFor(const std::string& token) {
  const auto is_its = [&](const auto& session) { return session.second.login.token == token; };
  while (std::count_if(sessions_.begin(), sessions_.end(), is_its) >= kMaxOfOneToken) {
    auto oldest = sessions_.end();
    for (auto i = sessions_.begin(); i != sessions_.end(); ++i) {
      if (is_its(*i) && (oldest == sessions_.end() || i->second.end < oldest->second.end))
        oldest = i;
    }
    sessions_.erase(oldest);
  }
}

void SessionBook::RemoveExpired() {
  const auto now = clock_();
  for (auto i = sessions_.begin(); i != sessions_.end();) {
    if (i->second.end > now) {
      ++i;
      continue;
    }
    if (i->second.lent) access_->WithdrawToken(i->second.login.token);
    i = sessions_.erase(i);
  }
  std::erase_if(links_, [now](const auto& link) { return link.second.end <= now; });
}

absl::StatusOr<std::string> SessionBook::Add(const std::string& token, bool lent) {
  HOMING_ASSIGN_OR_RETURN(const std::string cookie, MakeToken());
  HOMING_ASSIGN_OR_RETURN(const std::string csrf, MakeToken());
  const MutexLock lock(mutex_);
  RemoveExpired();
  MakeRoomFor(token);
  if (sessions_.size() >= kMaxSessions) {
    return absl::ResourceExhaustedError("too many browsers are logged in");
  }
  sessions_[HashToken(cookie)] = {{token, csrf}, lent, clock_() + kLife};
  return cookie;
}

absl::StatusOr<std::string> SessionBook::Open(const std::string& token) {
  Credentials credentials;
  credentials.authorizations = {"Bearer " + token};
  HOMING_RETURN_IF_ERROR(access_->Identify(credentials).status());
  return Add(token, false);
}

std::optional<Login> SessionBook::Find(const std::string& cookie) {
  const MutexLock lock(mutex_);
  RemoveExpired();
  const auto found = sessions_.find(HashToken(cookie));
  return found == sessions_.end() ? std::nullopt : std::optional(found->second.login);
}

void SessionBook::Close(const std::string& cookie) {
  const MutexLock lock(mutex_);
  const auto found = sessions_.find(HashToken(cookie));
  if (found == sessions_.end()) return;
  if (found->second.lent) access_->WithdrawToken(found->second.login.token);
  sessions_.erase(found);
}

absl::StatusOr<Login> SessionBook::OfUser(const std::string& identity) {
  {
    const MutexLock lock(mutex_);
    if (const auto found = users_.find(identity); found != users_.end()) return found->second;
    if (users_.size() >= kMaxSessions) {
      return absl::ResourceExhaustedError("the proxy names too many users");
    }
  }
  HOMING_ASSIGN_OR_RETURN(const std::string token, access_->LendToken(identity));
  HOMING_ASSIGN_OR_RETURN(const std::string csrf, MakeToken());
  const MutexLock lock(mutex_);
  return users_.try_emplace(identity, Login{token, csrf}).first->second;
}

absl::StatusOr<Login> SessionBook::OfAnybody() {
  {
    const MutexLock lock(mutex_);
    if (const auto found = users_.find(""); found != users_.end()) return found->second;
  }
  HOMING_ASSIGN_OR_RETURN(const std::string csrf, MakeToken());
  const MutexLock lock(mutex_);
  return users_.try_emplace("", Login{"", csrf}).first->second;
}

absl::StatusOr<std::string> SessionBook::MakeLink(const std::string& identity) {
  HOMING_ASSIGN_OR_RETURN(std::string secret, MakeToken());
  const MutexLock lock(mutex_);
  links_[HashToken(secret)] = {identity, clock_() + kLinkLife};
  return secret;
}

absl::StatusOr<std::string> SessionBook::TakeLink(const std::string& secret) {
  std::string identity;
  {
    const MutexLock lock(mutex_);
    RemoveExpired();
    const auto found = links_.find(HashToken(secret));
    if (found == links_.end()) {
      return absl::UnauthenticatedError("this link was used, or is older than 15 minutes");
    }
    identity = found->second.identity;
    links_.erase(found);
  }
  HOMING_ASSIGN_OR_RETURN(const std::string token, access_->LendToken(identity));
  return Add(token, true);
}

}  // namespace homing::server
