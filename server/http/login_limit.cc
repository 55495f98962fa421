#include "server/http/login_limit.h"

namespace homing::server {

std::map<std::string, LoginLimit::Failures>::iterator LoginLimit::Find(const std::string& address,
                                                                       Time now) {
  if (failures_.size() >= kMostAddresses) {
    std::erase_if(failures_,
                  [now](const auto& failed) { return now - failed.second.begin >= kPeriod; });
  }
  const bool full = failures_.size() >= kMostAddresses && failures_.count(address) == 0;
  const auto found = failures_.try_emplace(full ? "" : address, Failures{0, now}).first;
  if (now - found->second.begin >= kPeriod) found->second = {0, now};
  return found;
}

bool LoginLimit::MayFail(const std::string& address, Time now) {
  const MutexLock lock(mutex_);
  return ++Find(address, now)->second.count <= kMostFailures;
}

}  // namespace homing::server
