#include "server/access/tls_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <sstream>

#include "server/access/certificate_authority.h"
#include "tests/support/status_matchers.h"
#include "tests/support/temporary_folder.h"

namespace homing::server {
namespace {

using ::testing::HasSubstr;

class TlsFilesTest : public ::testing::Test {
 protected:
  TlsFilesTest() {
    Write("server.pem", pair_.certificate);
    Write("server.key", pair_.key);
    Write("ca.pem", ca_);
  }
  void Write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.File(name)) << text;
  }
  absl::StatusOr<std::unique_ptr<TlsFiles>> Open(const std::string& certificate = "server.pem",
                                                 const std::string& key = "server.key") {
    return TlsFiles::Open(folder_.File(certificate), folder_.File(key), folder_.File("ca.pem"));
  }
  static std::string Read(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  }
  auto IsRefused(const std::string& why) {
    return StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(why));
  }

  TemporaryFolder folder_;
  CertificateAuthority authority_ =
      *CertificateAuthority::Make("Homing test authority", std::chrono::hours(24));
  const KeyAndCertificate pair_ = *authority_.Issue({"s", {"DNS:localhost"}, true});
  const KeyAndCertificate other_ = *authority_.Issue({"s", {"DNS:localhost"}, true});
  const std::string ca_ = authority_.pem()->certificate;
};

TEST_F(TlsFilesTest, AKeyMustBeItsCertificates) {
  Write("other.key", other_.key);
  EXPECT_THAT(Open(), IsOk());
  EXPECT_THAT(Open("server.pem", "other.key"), IsRefused("not the key"));
  EXPECT_THAT(Open("server.key", "server.key"), IsRefused("tls-cert"));
  EXPECT_THAT(Open("server.pem", "none"), IsRefused("tls-key"));
}

TEST_F(TlsFilesTest, CopiesChangeToAWholePairOnly) {
  const auto files = Open();
  ASSERT_THAT(files, IsOk());
  const std::string certificate = (*files)->certificate();
  Write("server.pem", other_.certificate);
  EXPECT_THAT((*files)->Reload(), IsRefused("not the key"));
  EXPECT_EQ(Read(certificate), pair_.certificate);
  Write("server.key", other_.key);
  EXPECT_THAT((*files)->Reload(), IsOk());
  EXPECT_EQ((*files)->certificate(), certificate);
  EXPECT_EQ(Read(certificate), other_.certificate);
  EXPECT_EQ(Read((*files)->key()), other_.key);
  EXPECT_EQ(Read((*files)->client_ca()), ca_);
}

// An authority, and the certificates above the server's, may follow; each may be cut off.
TEST_F(TlsFilesTest, AFileCutAnywhereIsRefused) {
  const std::string chain = pair_.certificate + ca_;
  Write("server.pem", chain);
  const auto files = Open();
  ASSERT_THAT(files, IsOk());
  for (std::size_t length = 0; length + 1 < chain.size(); length += 37) {
    // A chain without its last certificate is whole too.
    if (length >= pair_.certificate.size() - 1 && length <= pair_.certificate.size() + 10) continue;
    Write("server.pem", chain.substr(0, length));
    EXPECT_THAT((*files)->Reload(), IsRefused("tls-cert")) << length;
  }
  Write("server.pem", chain);
  for (std::size_t length = 0; length + 1 < ca_.size(); length += 37) {
    Write("ca.pem", ca_.substr(0, length));
    EXPECT_THAT((*files)->Reload(), IsRefused("tls-client-ca")) << length;
  }
  EXPECT_EQ(Read((*files)->certificate()), chain);
  EXPECT_EQ(Read((*files)->client_ca()), ca_);
}

}  // namespace
}  // namespace homing::server
