#include "server/access/certificate_folder.h"

#include <chrono>
#include <filesystem>
#include <optional>

#include "absl/strings/str_cat.h"
#include "homing/base/field_error.h"
#include "homing/base/file_text.h"
#include "homing/base/range_check.h"
#include "homing/base/status_macros.h"
#include "server/access/certificate_authority.h"
#include "server/access/identity.h"
#include "server/access/private_file.h"

namespace homing::server {
namespace {

namespace fs = std::filesystem;

std::string ReadOrNothing(const fs::path& path) { return ReadFile(path.string()).value_or(""); }

// The folder of certificates while a command changes it.
class Folder {
 public:
  explicit Folder(const CertificateOrder& order)
      : root_(order.folder),
        lifetime_(std::chrono::hours(24 * order.days)),
        authority_lifetime_(std::chrono::hours(24 * order.ca_days)) {}

  absl::Status OpenAuthority(bool renew) {
    const KeyAndCertificate pem = {ReadOrNothing(root_ / "ca.key"),
                                   ReadOrNothing(root_ / "ca.pem")};
    if (!pem.certificate.empty()) {
      HOMING_ASSIGN_OR_RETURN(CertificateAuthority known, CertificateAuthority::FromPem(pem));
      authority_.emplace(std::move(known));
      return renew ? RenewAuthority() : absl::OkStatus();
    }
    HOMING_ASSIGN_OR_RETURN(
        CertificateAuthority made,
        CertificateAuthority::Make("Homing test authority", authority_lifetime_));
    authority_.emplace(std::move(made));
    HOMING_ASSIGN_OR_RETURN(const KeyAndCertificate fresh, authority_->pem());
    return Write("ca", fresh);
  }

  absl::Status MakeServer(const std::vector<std::string>& hosts) {
    if (hosts.empty() && fs::exists(root_ / "server.pem")) {
      return absl::OkStatus();
    }
    CertificateRequest request = {
        "homing-server", {"DNS:localhost", "IP:127.0.0.1", "IP:::1"}, true};
    for (const std::string& host : hosts) {
      const bool is_address = host.find(':') != std::string::npos ||
                              host.find_first_not_of("0123456789.") == std::string::npos;
      request.names.push_back((is_address ? "IP:" : "DNS:") + host);
    }
    return Make("server", request);
  }

  absl::Status MakeClient(const std::string& identity) {
    return Make(identity, {identity, {"URI:" + UriOf(identity)}, false});
  }

  absl::Status Revoke(const std::vector<std::string>& identities) {
    std::vector<std::string> certificates;
    for (const std::string& identity : identities) {
      HOMING_RETURN_IF_ERROR(CheckIdentity(identity, "revoke"));
      certificates.push_back(ReadOrNothing(root_ / (identity + ".pem")));
      if (certificates.back().empty()) {
        return TextMustBe("revoke", identity, "an identity whose certificate is in the folder");
      }
    }
    const fs::path path = root_ / "crl" / "homing.pem";
    HOMING_ASSIGN_OR_RETURN(
        const std::string list,
        authority_->Revoke(ReadOrNothing(path), certificates, authority_lifetime_));
    return WriteFile(path, list);
  }

  const std::vector<std::string>& written() const { return written_; }

 private:
  absl::Status RenewAuthority() {
    HOMING_RETURN_IF_ERROR(authority_->Renew(authority_lifetime_));
    HOMING_ASSIGN_OR_RETURN(const KeyAndCertificate renewed, authority_->pem());
    return WriteFile(root_ / "ca.pem", renewed.certificate);
  }
  absl::Status Make(const std::string& name, CertificateRequest request) {
    request.ends_in = lifetime_;
    HOMING_ASSIGN_OR_RETURN(const KeyAndCertificate made, authority_->Issue(request));
    return Write(name, made);
  }
  absl::Status Write(const std::string& name, const KeyAndCertificate& pem) {
    HOMING_RETURN_IF_ERROR(WriteFile(root_ / (name + ".key"), pem.key));
    return WriteFile(root_ / (name + ".pem"), pem.certificate);
  }
  absl::Status WriteFile(const fs::path& path, const std::string& text) {
    std::error_code error;
    fs::create_directories(path.parent_path(), error);
    HOMING_RETURN_IF_ERROR(WritePrivateFile(path.string(), text));
    if (path.extension() == ".pem") {
      // Certificates and lists are not secret, and the server may run as another user.
      fs::permissions(path, fs::perms(0644), error);
    }
    written_.push_back(path.string());
    return absl::OkStatus();
  }

  const fs::path root_;
  const std::chrono::seconds lifetime_;
  const std::chrono::seconds authority_lifetime_;
  std::optional<CertificateAuthority> authority_;
  std::vector<std::string> written_;
};

// The identities that get a certificate.
absl::StatusOr<std::vector<std::string>> ClientsOf(const CertificateOrder& order) {
  std::vector<std::string> clients;
  for (const std::string& robot : order.robots) {
    clients.push_back("robots/" + robot);
    HOMING_RETURN_IF_ERROR(CheckNewIdentity(clients.back(), "robot"));
  }
  for (const std::string& name : order.operators) {
    clients.push_back("operators/" + name);
    HOMING_RETURN_IF_ERROR(CheckNewIdentity(clients.back(), "operator"));
  }
  return clients;
}

}  // namespace

absl::StatusOr<std::vector<std::string>> MakeCertificates(const CertificateOrder& order) {
  HOMING_RETURN_IF_ERROR(CheckRange("days", order.days, 1, 36'500, "days"));
  HOMING_RETURN_IF_ERROR(CheckRange("ca-days", order.ca_days, 1, 36'500, "days"));
  HOMING_ASSIGN_OR_RETURN(const std::vector<std::string> clients, ClientsOf(order));
  Folder folder(order);
  HOMING_RETURN_IF_ERROR(folder.OpenAuthority(order.renew_ca));
  // Revoke first: a certificate that this command makes must not be revoked by it.
  HOMING_RETURN_IF_ERROR(folder.Revoke(order.revoked));
  HOMING_RETURN_IF_ERROR(folder.MakeServer(order.hosts));
  for (const std::string& client : clients) {
    HOMING_RETURN_IF_ERROR(folder.MakeClient(client));
  }
  return folder.written();
}

}  // namespace homing::server
