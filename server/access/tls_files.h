// The server's own certificate, its key and the clients' authorities, read again while it runs.
#ifndef SERVER_ACCESS_TLS_FILES_H_
#define SERVER_ACCESS_TLS_FILES_H_

#include <array>
#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "homing/base/mutex.h"

namespace homing::server {

// gRPC watches files: it would use half of one that is being written, and abort at an empty one. So
// it watches copies in memory, which change only to files that were checked. The copies stay until
// the process ends, since gRPC's thread may still read them after its server has ended.
// Thread-safe.
class TlsFiles {
 public:
  // PEM files; no `client_ca`: empty. INVALID_ARGUMENT naming the option (tls-cert, tls-key,
  // tls-client-ca): its file cannot be read, is not PEM to its end, or does not match the other.
  // The message holds nothing of the key.
  static absl::StatusOr<std::unique_ptr<TlsFiles>> Open(std::string certificate, std::string key,
                                                        std::string client_ca);

  // Reads the files again. An error leaves the copies as they are.
  absl::Status Reload();

  // Paths of the copies.
  std::string certificate() const { return PathOf(kCertificate); }
  std::string key() const { return PathOf(kKey); }
  std::string client_ca() const { return paths_[kClientCa].empty() ? "" : PathOf(kClientCa); }

 private:
  enum File { kCertificate, kKey, kClientCa, kFiles };
  using Contents = std::array<std::string, kFiles>;

  explicit TlsFiles(Contents paths) : paths_(std::move(paths)) {}

  absl::StatusOr<Contents> Read() const;
  absl::Status Replace(File file, const std::string& content);
  std::string PathOf(File file) const;

  const Contents paths_;
  Mutex mutex_;
  Contents contents_ HOMING_GUARDED_BY(mutex_);
  // Open files in memory; a number stays when its content changes.
  std::array<int, kFiles> copies_ = {-1, -1, -1};
};

}  // namespace homing::server

#endif  // SERVER_ACCESS_TLS_FILES_H_
