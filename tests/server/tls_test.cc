// TLS over a real socket: refused and accepted clients, and files that change while the server
// runs.
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "server/access/certificate_authority.h"
#include "server/access/certificate_folder.h"
#include "server/access/token_book.h"
#include "server/config/health_check.h"
#include "tests/server/every_rpc.h"
#include "tests/server/server_fixture.h"
#include "tests/support/status_matchers.h"

namespace homing::server {
namespace {

using ::testing::HasSubstr;

constexpr char kOwn[] = "robots/r1/journeys/out";

std::string Read(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

class TlsTest : public ServerTest {
 protected:
  TlsTest() {
    CertificateOrder order;
    order.folder = pki();
    order.robots = {"r1", "r2"};
    order.operators = {"anna"};
    EXPECT_THAT(MakeCertificates(order), IsOk());
    options_.tls_cert = pki("server.pem");
    options_.tls_key = pki("server.key");
    options_.tls_client_ca = pki("ca.pem");
    options_.tls_crl_dir = pki("crl");
    options_.reload_s = 1;
    StartServer();
  }

  std::string pki(const std::string& name = "") { return folder_.File("pki/" + name); }

  std::shared_ptr<grpc::Channel> Dial(const KeyAndCertificate& client, const std::string& ca) {
    grpc::SslCredentialsOptions tls;
    tls.pem_root_certs = ca;
    tls.pem_private_key = client.key;
    tls.pem_cert_chain = client.certificate;
    grpc::ChannelArguments own_connection;
    own_connection.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
    return grpc::CreateCustomChannel(server_->address(), grpc::SslCredentials(tls), own_connection);
  }
  std::shared_ptr<grpc::Channel> DialAs(const std::string& identity) {
    return Dial({Read(pki(identity + ".key")), Read(pki(identity + ".pem"))}, Read(pki("ca.pem")));
  }
  // One of the authority's own making.
  KeyAndCertificate Issue(const CertificateRequest& request) {
    const KeyAndCertificate ca = {Read(pki("ca.key")), Read(pki("ca.pem"))};
    return CertificateAuthority::FromPem(ca)->Issue(request).value();
  }
  static grpc::Status Get(const std::shared_ptr<grpc::Channel>& channel) {
    return EveryRpc(channel, "").Call(Rpc::kGetDeviationModel, kOwn);
  }
  // Until `done`, which a reload brings about; a test that hangs is ended by the runner.
  static void Await(const std::function<bool()>& done) {
    while (!done()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  }
};

TEST_F(TlsTest, ACertificateSaysWhichRobotCalls) {
  EveryRpc r1(DialAs("robots/r1"), "");
  EveryRpc r2(DialAs("robots/r2"), "");
  EveryRpc anna(DialAs("operators/anna"), "");
  EXPECT_THAT(r1.Create(kOwn, {}), IsGrpcOk());
  EXPECT_THAT(r1.Record(kOwn), IsGrpcOk());
  EXPECT_THAT(r2.Record(kOwn), GrpcStatusIs(grpc::StatusCode::PERMISSION_DENIED,
                                            HasSubstr("robots/r2 (robot) is not allowed")));
  EXPECT_THAT(r2.Create("robots/r1/journeys/forged", {}),
              GrpcStatusIs(grpc::StatusCode::PERMISSION_DENIED, HasSubstr("r2")));
  EXPECT_THAT(anna.Call(Rpc::kExportJourney, kOwn), IsGrpcOk());
  EXPECT_THAT(anna.Record(kOwn), GrpcStatusIs(grpc::StatusCode::PERMISSION_DENIED, HasSubstr("")));
  EXPECT_THAT(anna.Call(Rpc::kDeleteJourney, kOwn), IsGrpcOk());
}

TEST_F(TlsTest, PlainTextIsRefused) {
  const auto plain = grpc::CreateChannel(server_->address(), grpc::InsecureChannelCredentials());
  EXPECT_EQ(Get(plain).error_code(), grpc::StatusCode::UNAVAILABLE);
}

TEST_F(TlsTest, WithoutACertificateNoClientConnects) {
  const std::string ca = Read(pki("ca.pem"));
  EXPECT_EQ(Get(Dial({}, ca)).error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_FALSE(CheckHealth(server_->address(), {pki("ca.pem"), "", "", ""}).ok());
  EXPECT_THAT(CheckHealth(server_->address(), {pki("ca.pem"), "", pki("operators/anna.pem"),
                                               pki("operators/anna.key")}),
              IsOk());
}

TEST_F(TlsTest, HealthCheckMayTrustTheServersCertificateItself) {
  const std::string cert = pki("operators/anna.pem");
  const std::string key = pki("operators/anna.key");
  EXPECT_THAT(CheckHealth(server_->address(), {"", pki("server.pem"), cert, key}), IsOk());
  EXPECT_FALSE(CheckHealth(server_->address(), {"", cert, cert, key}).ok());
}

TEST_F(TlsTest, ExpiredForeignAndRevokedCertificatesAreRefused) {
  const std::string ca = Read(pki("ca.pem"));
  CertificateRequest request = {"r1", {"URI:homing:robots/r1"}};
  EXPECT_THAT(Get(Dial(Issue(request), ca)), IsGrpcOk());
  request.begins_in = -std::chrono::hours(48);
  request.ends_in = -std::chrono::hours(24);
  EXPECT_EQ(Get(Dial(Issue(request), ca)).error_code(), grpc::StatusCode::UNAVAILABLE);
  const auto foreign = CertificateAuthority::Make("Homing test authority", std::chrono::hours(24))
                           ->Issue({"r1", {"URI:homing:robots/r1"}})
                           .value();
  EXPECT_EQ(Get(Dial(foreign, ca)).error_code(), grpc::StatusCode::UNAVAILABLE);
  CertificateOrder order;
  order.folder = pki();
  order.revoked = {"robots/r2"};
  EXPECT_THAT(Get(DialAs("robots/r2")), IsGrpcOk());
  ASSERT_THAT(MakeCertificates(order), IsOk());
  Await([&] { return Get(DialAs("robots/r2")).error_code() == grpc::StatusCode::UNAVAILABLE; });
  EXPECT_THAT(Get(DialAs("robots/r1")), IsGrpcOk());
}

TEST_F(TlsTest, ARevokedRobotIsCutOffThoughItsConnectionIsOpen) {
  const auto channel = DialAs("robots/r2");
  grpc::ClientContext context;
  const auto stub = v1::HomingService::NewStub(channel);
  const auto stream = stub->Localize(&context);
  EXPECT_THAT(Get(channel), IsGrpcOk());
  CertificateOrder order;
  order.folder = pki();
  order.revoked = {"robots/r2"};
  ASSERT_THAT(MakeCertificates(order), IsOk());
  v1::LocalizeResponse response;
  EXPECT_FALSE(stream->Read(&response));
  EXPECT_THAT(stream->Finish(),
              GrpcStatusIs(grpc::StatusCode::UNAUTHENTICATED, HasSubstr("revoked")));
  EXPECT_THAT(Get(channel), GrpcStatusIs(grpc::StatusCode::UNAUTHENTICATED, HasSubstr("revoked")));
}

TEST_F(TlsTest, ACertificateWithoutAnIdentityIsRefused) {
  const std::string ca = Read(pki("ca.pem"));
  for (const std::vector<std::string>& names : {std::vector<std::string>{},
                                                {"DNS:robots"},
                                                {"URI:homing:robots/r1", "URI:homing:robots/r2"},
                                                {"URI:robots/r1"}}) {
    EXPECT_THAT(Get(Dial(Issue({"robots/r1", names}), ca)),
                GrpcStatusIs(grpc::StatusCode::UNAUTHENTICATED, HasSubstr("certificate")));
  }
}

TEST_F(TlsTest, TheServersCertificateIsExchangedWithoutARestart) {
  const std::string old_ca = Read(pki("ca.pem"));
  const auto open = DialAs("robots/r1");
  ASSERT_THAT(Get(open), IsGrpcOk());
  for (const char* name : {"ca.pem", "ca.key", "crl/homing.pem"}) {
    std::filesystem::remove(pki(name));
  }
  CertificateOrder order;
  order.folder = pki();
  order.robots = {"r1"};
  order.hosts = {"localhost"};
  ASSERT_THAT(MakeCertificates(order), IsOk());
  ASSERT_NE(Read(pki("ca.pem")), old_ca);
  Await([&] { return Get(DialAs("robots/r1")).ok(); });
  // Certificates of the previous authority are refused, also on an open connection.
  Await([&] { return Get(open).error_code() == grpc::StatusCode::UNAUTHENTICATED; });
  EXPECT_THAT(Create("more"), GrpcStatusIs(grpc::StatusCode::UNAVAILABLE, HasSubstr("")));
}

TEST_F(TlsTest, AFileThatIsBeingWrittenLeavesTheOldOneInUse) {
  const std::string authority = Read(pki("ca.pem"));
  const KeyAndCertificate robot = {Read(pki("robots/r1.key")), Read(pki("robots/r1.pem"))};
  const std::string other = CertificateAuthority::Make("Another", std::chrono::hours(24))
                                ->Issue({"s", {"DNS:localhost"}, true})
                                ->certificate;
  for (const std::string name : {"server.pem", "server.key", "ca.pem"}) {
    const std::string whole = Read(pki(name));
    for (const std::string& content : {std::string(), whole.substr(0, whole.size() / 2), other}) {
      // Other authorities are no mistake that anyone could notice.
      if (name == "ca.pem" && content == other) continue;
      std::ofstream(pki(name)) << content;
      server_->Reload();
      // gRPC looks at its files each second.
      std::this_thread::sleep_for(std::chrono::milliseconds(1300));
      EXPECT_THAT(Get(Dial(robot, authority)), IsGrpcOk())
          << name << " of " << content.size() << " bytes";
    }
    std::ofstream(pki(name)) << whole;
  }
}

TEST_F(TlsTest, WithTokensACertificateMayBeMissingButNotAnothers) {
  options_.tokens = folder_.File("tokens.toml");
  ASSERT_THAT(AddToken(options_.tokens, "robots/r9", HashToken("token-of-r9")), IsOk());
  StartServer();
  const auto bare = Dial({}, Read(pki("ca.pem")));
  EXPECT_THAT(EveryRpc(bare, "token-of-r9").Create("robots/r9/journeys/out", {}), IsGrpcOk());
  EXPECT_THAT(Get(bare),
              GrpcStatusIs(grpc::StatusCode::UNAUTHENTICATED, HasSubstr("no credentials")));
  EXPECT_THAT(EveryRpc(DialAs("robots/r1"), "token-of-r9").Create(kOwn, {}),
              GrpcStatusIs(grpc::StatusCode::UNAUTHENTICATED, HasSubstr("different identities")));
  EXPECT_THAT(EveryRpc(DialAs("robots/r1"), "").Create(kOwn, {}), IsGrpcOk());
  const auto foreign = CertificateAuthority::Make("x", std::chrono::hours(24))
                           ->Issue({"r1", {"URI:homing:robots/r1"}})
                           .value();
  EXPECT_EQ(EveryRpc(Dial(foreign, Read(pki("ca.pem"))), "token-of-r9")
                .Create("robots/r9/journeys/two", {})
                .error_code(),
            grpc::StatusCode::UNAVAILABLE);
}

TEST_F(TlsTest, BadFilesAreReportedAtTheStart) {
  options_.listen = "127.0.0.1:0";
  options_.database = "sqlite:" + folder_.File("other.db");
  ServerOptions bad = options_;
  bad.tls_key = pki("robots/r1.key");
  EXPECT_THAT(HomingServer::Start(bad),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("tls-key")));
  bad = options_;
  bad.tls_client_ca = pki("ca.key");
  EXPECT_THAT(HomingServer::Start(bad),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("tls-client-ca")));
  bad = options_;
  bad.tls_crl_dir = pki("robots");
  EXPECT_THAT(HomingServer::Start(bad),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("tls-crl-dir")));
  bad = options_;
  bad.roles = pki("none");
  EXPECT_THAT(HomingServer::Start(bad),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("roles")));
}

}  // namespace
}  // namespace homing::server
