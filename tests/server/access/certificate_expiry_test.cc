// Certificates end: the server warns in time, and the authority can be renewed.
#include "server/access/certificate_expiry.h"

#include <gmock/gmock.h>

#include <chrono>

#include "homing/base/file_text.h"
#include "server/access/certificate_authority.h"
#include "server/access/certificate_folder.h"
#include "server/access/client_certificates.h"
#include "tests/support/status_matchers.h"
#include "tests/support/temporary_folder.h"

namespace homing::server {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr std::int64_t kDayS = 86'400;

std::int64_t NowS() {
  return std::chrono::duration_cast<std::chrono::seconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

class CertificateExpiryTest : public ::testing::Test {
 protected:
  CertificateExpiryTest() {
    order_.folder = Path("");
    order_.robots = {"r1"};
  }
  std::string Path(const std::string& name) { return folder_.File("pki/" + name); }
  CertificateFiles Files() { return {Path("server.pem"), Path("ca.pem"), Path("crl")}; }

  TemporaryFolder folder_;
  CertificateOrder order_;
};

TEST_F(CertificateExpiryTest, TheAuthorityAndItsListOutliveTheCertificates) {
  ASSERT_THAT(MakeCertificates(order_), IsOk());
  const auto expiries = ReadExpiries(Files());
  ASSERT_THAT(expiries, SizeIs(3));
  const std::int64_t now = NowS();
  EXPECT_NEAR(static_cast<double>(expiries[0].end_s - now) / kDayS, 365, 1);
  EXPECT_NEAR(static_cast<double>(expiries[1].end_s - now) / kDayS, 3650, 1);
  EXPECT_NEAR(static_cast<double>(expiries[2].end_s - now) / kDayS, 3650, 1);
}

TEST_F(CertificateExpiryTest, WarnsThirtyDaysAhead) {
  const CertificateExpiry expiry{"tls-cert", "server.pem", 100 * kDayS};
  EXPECT_EQ(ExpiryWarning(expiry, 70 * kDayS), "");
  EXPECT_THAT(ExpiryWarning(expiry, 71 * kDayS), HasSubstr("server.pem ends in 29 days"));
  EXPECT_THAT(ExpiryWarning(expiry, 100 * kDayS), HasSubstr("has expired"));
}

TEST_F(CertificateExpiryTest, CertificatesStayValidWhenTheAuthorityIsRenewed) {
  order_.ca_days = 1;
  ASSERT_THAT(MakeCertificates(order_), IsOk());
  const std::string robot = ReadFile(Path("robots/r1.pem")).value();
  order_ = {};
  order_.folder = Path("");
  order_.renew_ca = true;
  ASSERT_THAT(MakeCertificates(order_), IsOk());
  EXPECT_EQ(ReadFile(Path("robots/r1.pem")).value(), robot);
  EXPECT_GT(ReadExpiries(Files())[1].end_s, NowS() + 3000 * kDayS);
  const auto certificates = ClientCertificates::Open(Path("ca.pem"), Path("crl"));
  ASSERT_THAT(certificates, IsOk());
  EXPECT_THAT((*certificates)->Check(robot), IsOk());
}

}  // namespace
}  // namespace homing::server
