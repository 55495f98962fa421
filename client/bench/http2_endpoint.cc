#include "client/bench/http2_endpoint.h"

#include <netdb.h>
#include <netinet/tcp.h>
#include <openssl/err.h>
#include <openssl/x509v3.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "absl/strings/str_cat.h"
#include "homing/base/field_error.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

std::string TlsError() {
  std::array<char, 256> text{};
  ERR_error_string_n(ERR_get_error(), text.data(), text.size());
  return text.data();
}

}  // namespace

absl::StatusOr<Http2Endpoint> Http2Endpoint::Make(const ConnectionOptions& options) {
  Http2Endpoint endpoint;
  const std::size_t colon = options.address.rfind(':');
  if (colon == std::string::npos || colon == 0 || colon + 1 == options.address.size()) {
    return TextMustBe("--server", options.address, "host:port");
  }
  endpoint.authority_ = options.address;
  endpoint.host_ = options.address.substr(0, colon);
  endpoint.port_ = options.address.substr(colon + 1);
  if (endpoint.host_.front() == '[' && endpoint.host_.back() == ']') {
    endpoint.host_ = endpoint.host_.substr(1, endpoint.host_.size() - 2);
  }
  HOMING_ASSIGN_OR_RETURN(endpoint.token_, ReadToken(options));
  if (!UsesTls(options)) return endpoint;
  endpoint.tls_.reset(SSL_CTX_new(TLS_client_method()), SSL_CTX_free);
  SSL_CTX* const tls = endpoint.tls_.get();
  SSL_CTX_set_verify(tls, SSL_VERIFY_PEER, nullptr);
  SSL_CTX_set_mode(tls, SSL_MODE_ENABLE_PARTIAL_WRITE | SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER);
  // Reads all available data in one call; otherwise each record takes two, one for its header.
  SSL_CTX_set_read_ahead(tls, 1);
  constexpr std::array<unsigned char, 3> kHttp2{2, 'h', '2'};
  SSL_CTX_set_alpn_protos(tls, kHttp2.data(), kHttp2.size());
  const bool trusted = options.tls_ca.empty()
                           ? SSL_CTX_set_default_verify_paths(tls) == 1
                           : SSL_CTX_load_verify_file(tls, options.tls_ca.c_str()) == 1;
  if (!trusted) return absl::NotFoundError(absl::StrCat("--tls-ca: ", TlsError()));
  if (!options.tls_cert.empty() &&
      (SSL_CTX_use_certificate_chain_file(tls, options.tls_cert.c_str()) != 1 ||
       SSL_CTX_use_PrivateKey_file(tls, options.tls_key.c_str(), SSL_FILETYPE_PEM) != 1)) {
    return absl::NotFoundError(absl::StrCat("--tls-cert, --tls-key: ", TlsError()));
  }
  return endpoint;
}

absl::StatusOr<int> Http2Endpoint::Dial() const {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (const int error = getaddrinfo(host_.c_str(), port_.c_str(), &hints, &found); error != 0) {
    return absl::UnavailableError(absl::StrCat(authority_, ": ", gai_strerror(error)));
  }
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> owner(found, freeaddrinfo);
  int error = 0;
  for (const addrinfo* a = found; a != nullptr; a = a->ai_next) {
    const int fd = ::socket(a->ai_family, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (fd >= 0 && connect(fd, a->ai_addr, a->ai_addrlen) == 0) {
      constexpr int kOn = 1;
      setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &kOn, sizeof kOn);
      return fd;
    }
    error = errno;
    if (fd >= 0) close(fd);
  }
  return absl::UnavailableError(absl::StrCat(authority_, ": ", std::strerror(error)));
}

absl::StatusOr<std::shared_ptr<SSL>> Http2Endpoint::Secure(int socket) const {
  if (tls_ == nullptr) return std::shared_ptr<SSL>();
  std::shared_ptr<SSL> tls(SSL_new(tls_.get()), SSL_free);
  SSL_set_fd(tls.get(), socket);
  // A host that is not an address is a name; one of the two is always checked.
  if (X509_VERIFY_PARAM_set1_ip_asc(SSL_get0_param(tls.get()), host_.c_str()) != 1) {
    if (SSL_set1_host(tls.get(), host_.c_str()) != 1) {
      return absl::InvalidArgumentError(absl::StrCat("--server: no host name in ", authority_));
    }
    SSL_set_tlsext_host_name(tls.get(), host_.c_str());
  }
  if (SSL_connect(tls.get()) != 1) {
    return absl::UnavailableError(absl::StrCat(authority_, ": TLS: ", TlsError()));
  }
  return tls;
}

}  // namespace homing::client
