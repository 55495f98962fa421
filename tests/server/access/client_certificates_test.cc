// Certificates that are good, run out, of another authority, or revoked.
#include "server/access/client_certificates.h"

#include <filesystem>
#include <fstream>

#include "server/access/certificate_authority.h"
#include "tests/support/status_matchers.h"
#include "tests/support/temporary_folder.h"

namespace homing::server {
namespace {

using ::testing::HasSubstr;

constexpr std::chrono::hours kDay{24};

CertificateAuthority MakeAuthority() {
  return CertificateAuthority::Make("test authority", 10 * kDay).value();
}

class ClientCertificatesTest : public ::testing::Test {
 protected:
  ClientCertificatesTest() {
    Write("ca.pem", authority_.pem()->certificate);
    std::filesystem::create_directory(folder_.File("crl"));
  }
  void Write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.File(name)) << text;
  }
  void Revoke(const std::vector<std::string>& certificates, std::chrono::seconds lifetime = kDay) {
    Write("crl/list.pem", authority_.Revoke("", certificates, lifetime).value());
  }
  std::string Issue(std::chrono::seconds begins_in = -kDay, std::chrono::seconds ends_in = kDay,
                    bool is_server = false) {
    CertificateRequest request = {"r1", {"URI:homing:robots/r1"}, is_server, begins_in, ends_in};
    return authority_.Issue(request)->certificate;
  }
  std::unique_ptr<ClientCertificates> Open(const std::string& crl_dir = "") {
    auto opened = ClientCertificates::Open(folder_.File("ca.pem"), crl_dir);
    EXPECT_THAT(opened, IsOk());
    return *std::move(opened);
  }

  TemporaryFolder folder_;
  CertificateAuthority authority_ = MakeAuthority();
};

MATCHER_P(IsRefused, why, "") {
  return ::testing::ExplainMatchResult(StatusIs(absl::StatusCode::kUnauthenticated, HasSubstr(why)),
                                       arg, result_listener);
}

TEST_F(ClientCertificatesTest, OnlyThoseOfTheAuthorityWithinTheirDatesAreGood) {
  const auto certificates = Open();
  EXPECT_THAT(certificates->Check(Issue()), IsOk());
  EXPECT_THAT(certificates->Check(Issue(-2 * kDay, -kDay)), IsRefused("expired"));
  EXPECT_THAT(certificates->Check(Issue(kDay, 2 * kDay)), IsRefused("not yet valid"));
  EXPECT_THAT(certificates->Check(Issue(-kDay, kDay, true)), IsRefused("purpose"));
  const std::string foreign = MakeAuthority().Issue({"r1", {"URI:homing:robots/r1"}})->certificate;
  EXPECT_THAT(certificates->Check(foreign), IsRefused("refused"));
  EXPECT_THAT(certificates->Check("nonsense"), IsRefused("cannot be read"));
}

TEST_F(ClientCertificatesTest, ARevokedOneIsRefusedAfterTheNextReload) {
  const std::string good = Issue();
  const std::string lost = Issue();
  Revoke({});
  const auto certificates = Open(folder_.File("crl"));
  EXPECT_THAT(certificates->Check(good), IsOk());
  EXPECT_THAT(certificates->Check(lost), IsOk());
  Revoke({lost});
  ASSERT_THAT(certificates->Reload(), IsOk());
  EXPECT_THAT(certificates->Check(good), IsOk());
  EXPECT_THAT(certificates->Check(lost), IsRefused("revoked"));
}

TEST_F(ClientCertificatesTest, WithoutAValidListEveryCertificateIsRefused) {
  Revoke({}, -std::chrono::hours(1));
  EXPECT_THAT(Open(folder_.File("crl"))->Check(Issue()), IsRefused("CRL has expired"));
  Write("crl/list.pem", MakeAuthority().Revoke("", {}, kDay).value());
  EXPECT_FALSE(Open(folder_.File("crl"))->Check(Issue()).ok());
  std::filesystem::remove(folder_.File("crl/list.pem"));
  EXPECT_THAT(ClientCertificates::Open(folder_.File("ca.pem"), folder_.File("crl")),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("tls-crl-dir")));
}

TEST_F(ClientCertificatesTest, AnUnreadableFileKeepsThePreviousContent) {
  const auto certificates = Open();
  const std::string good = Issue();
  Write("ca.pem", "nonsense");
  EXPECT_THAT(certificates->Reload(),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("tls-client-ca")));
  EXPECT_THAT(certificates->Check(good), IsOk());
}

TEST_F(ClientCertificatesTest, RevokingMoreKeepsThoseRevokedBefore) {
  const std::string first = Issue();
  const std::string second = Issue();
  const std::string one = authority_.Revoke("", {first}, kDay).value();
  Write("crl/list.pem", authority_.Revoke(one, {second}, kDay).value());
  const auto certificates = Open(folder_.File("crl"));
  EXPECT_THAT(certificates->Check(first), IsRefused("revoked"));
  EXPECT_THAT(certificates->Check(second), IsRefused("revoked"));
}

}  // namespace
}  // namespace homing::server
