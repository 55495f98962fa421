// Files of tokens and of roles.
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <future>
#include <sstream>

#include "server/access/certificate_folder.h"
#include "server/access/identity.h"
#include "server/access/private_file.h"
#include "server/access/role_book.h"
#include "server/access/token_book.h"
#include "tests/support/status_matchers.h"
#include "tests/support/temporary_folder.h"

namespace homing::server {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class IdentityFilesTest : public ::testing::Test {
 protected:
  std::string Write(const std::string& text) {
    const std::string path = folder_.File("file.toml");
    std::ofstream(path) << text;
    return path;
  }
  static std::string Read(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  }
  TemporaryFolder folder_;
};

TEST_F(IdentityFilesTest, ATokenFindsWhoseItIsAndItsFileDoesNotHoldIt) {
  const std::string path = folder_.File("tokens.toml");
  const std::string first = MakeToken().value();
  const std::string second = MakeToken().value();
  ASSERT_THAT(AddToken(path, "robots/r1", HashToken(first)), IsOk());
  ASSERT_THAT(AddToken(path, "operators/anna", HashToken(second)), IsOk());
  const auto book = TokenBook::Read(path);
  ASSERT_THAT(book, IsOk());
  EXPECT_EQ(book->Find(first), "robots/r1");
  EXPECT_EQ(book->Find(second), "operators/anna");
  EXPECT_EQ(book->Find(""), std::nullopt);
  EXPECT_EQ(book->Find(first + "x"), std::nullopt);
  EXPECT_EQ(book->Find(ToText(HashToken(first))), std::nullopt);
  EXPECT_THAT(Read(path), AllOf(Not(HasSubstr(first)), Not(HasSubstr(second))));
  EXPECT_NE(first, second);
  EXPECT_GE(first.size(), 43u);
}

TEST_F(IdentityFilesTest, NeitherAPipeNorADeviceIsWaitedFor) {
  const std::string pipe = folder_.File("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  for (const std::string& path : {pipe, std::string("/dev/zero"), folder_.File("")}) {
    EXPECT_THAT(TokenBook::Read(path).status(),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("is not a regular file")))
        << path;
  }
}

TEST_F(IdentityFilesTest, SeveralTokensMayBeOneIdentitys) {
  const std::string path = folder_.File("tokens.toml");
  ASSERT_THAT(AddToken(path, "robots/r1", HashToken("old")), IsOk());
  ASSERT_THAT(AddToken(path, "robots/r1", HashToken("new")), IsOk());
  const auto book = TokenBook::Read(path);
  ASSERT_THAT(book, IsOk());
  EXPECT_EQ(book->Find("old"), "robots/r1");
  EXPECT_EQ(book->Find("new"), "robots/r1");
}

TEST_F(IdentityFilesTest, TheHashIsSha256) {
  // printf abc | sha256sum
  EXPECT_EQ(ToText(HashToken("abc")),
            "sha256:ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST_F(IdentityFilesTest, FilesWithSecretsAreTheirOwnersAlone) {
  const std::string path = folder_.File("secret");
  std::ofstream(path) << "open to all";
  ASSERT_EQ(::chmod(path.c_str(), 0644), 0);
  ASSERT_THAT(WritePrivateFile(path, "secret"), IsOk());
  struct stat status {};
  ASSERT_EQ(::stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0600u);
  EXPECT_EQ(Read(path), "secret");
  EXPECT_THAT(WritePrivateFile(folder_.File("none/secret"), "x"),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("cannot be written")));
}

TEST_F(IdentityFilesTest, LinksAndPipesAreKept) {
  std::ofstream(folder_.File("target")) << "old";
  std::filesystem::create_symlink(folder_.File("target"), folder_.File("link"));
  ASSERT_THAT(WritePrivateFile(folder_.File("link"), "secret"), IsOk());
  EXPECT_TRUE(std::filesystem::is_symlink(folder_.File("link")));
  EXPECT_EQ(Read(folder_.File("target")), "secret");
  const std::string pipe = folder_.File("pipe");
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  auto reader = std::async(std::launch::async, [&] { return Read(pipe); });
  ASSERT_THAT(WritePrivateFile(pipe, "secret"), IsOk());
  EXPECT_EQ(reader.get(), "secret");
  EXPECT_TRUE(std::filesystem::is_fifo(pipe));
}

TEST_F(IdentityFilesTest, ATokenIsAddedToAnyFileThatCanBeRead) {
  const std::string line = "\"" + ToText(HashToken("old")) + "\" = \"robots/old\"";
  for (const std::string& text : {std::string(), std::string("\n"), std::string("# tokens"),
                                  "[tokens]\n" + line, "[tokens]\r\n" + line + "\r\n"}) {
    const std::string path = Write(text);
    ASSERT_THAT(AddToken(path, "robots/r1", HashToken("new")), IsOk()) << text;
    const auto book = TokenBook::Read(path);
    ASSERT_THAT(book, IsOk()) << text;
    EXPECT_EQ(book->Find("new"), "robots/r1") << text;
    EXPECT_EQ(book->Find("old").has_value(), text.find("old") != std::string::npos) << text;
  }
}

TEST_F(IdentityFilesTest, NewIdentitiesDoNotBeginAsPathsOrFlagsDo) {
  for (const char* bad : {".", "..", ".r", "-r", "-"}) {
    for (const std::string kind : {"robots/", "operators/"}) {
      EXPECT_THAT(AddToken(folder_.File("tokens.toml"), kind + bad, HashToken("t")),
                  StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("identity: ")))
          << kind << bad;
    }
    CertificateOrder order;
    order.folder = folder_.File("pki");
    order.robots = {"good", bad};
    EXPECT_THAT(MakeCertificates(order),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("robot: ")));
    order.robots.clear();
    order.operators = {bad};
    EXPECT_THAT(MakeCertificates(order),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("operator: ")));
  }
  EXPECT_FALSE(std::filesystem::exists(folder_.File("tokens.toml")));
  EXPECT_FALSE(std::filesystem::exists(folder_.File("pki")));
  // One of an older version still logs in.
  const std::string old = "[tokens]\n\"" + ToText(HashToken("t")) + "\" = \"robots/.r\"\n";
  EXPECT_EQ(TokenBook::Read(Write(old))->Find("t"), "robots/.r");
  EXPECT_EQ(IdentityOfUris({"homing:robots/.r"}).value(), "robots/.r");
}

TEST_F(IdentityFilesTest, AnEmptyFileIsNoTable) {
  for (const char* text : {"", "\n", "  \n", "# all roles were here\n"}) {
    EXPECT_FALSE(TokenBook::Read(Write(text))->has_table()) << text;
    EXPECT_THAT(RoleBook::Read(Write(text)),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("must hold [roles]")))
        << text;
  }
  EXPECT_TRUE(TokenBook::Read(Write("[tokens]\n"))->has_table());
  EXPECT_THAT(RoleBook::Read(Write("[roles]\n")), IsOk());
}

TEST_F(IdentityFilesTest, ABadFileOfTokensIsRefusedWithoutRepeatingSecrets) {
  const char* texts[] = {"[tokens]\n\"my-secret\" = \"robots/r1\"\n",
                         "[tokens]\n\"sha256:my-secret\" = \"robots/r1\"\n",
                         "[tokens]\nmy-secret\n", "my-secret = \"robots/r1\"\n",
                         "[tokens]\n\"my-secret\" = 3\n"};
  for (const char* text : texts) {
    EXPECT_THAT(TokenBook::Read(Write(text)),
                StatusIs(absl::StatusCode::kInvalidArgument,
                         AllOf(HasSubstr("tokens"), Not(HasSubstr("my-secret")))))
        << text;
  }
  const std::string bad_identity = "[tokens]\n\"" + ToText(HashToken("t")) + "\" = \"r1\"\n";
  EXPECT_THAT(TokenBook::Read(Write(bad_identity)),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("robots/ID")));
  EXPECT_THAT(TokenBook::Read(folder_.File("none")),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("cannot be read")));
  EXPECT_THAT(AddToken(Write("[tokens]\nbroken\n"), "robots/r1", HashToken("t")),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("line 2")));
}

TEST_F(IdentityFilesTest, ARoleIsTheIdentitysElseThatOfItsKindElseTheDefault) {
  const auto book =
      RoleBook::Read(Write("[roles]\n\"robots/*\" = \"none\"\n\"robots/r1\" = "
                           "\"robot\"\n\"operators/anna\" = \"admin\"\n"));
  ASSERT_THAT(book, IsOk());
  EXPECT_EQ(book->Find("robots/r1"), Role::kRobot);
  EXPECT_EQ(book->Find("robots/r2"), Role::kNone);
  EXPECT_EQ(book->Find("operators/anna"), Role::kAdmin);
  EXPECT_EQ(book->Find("operators/bob"), Role::kOperator);
  EXPECT_EQ(RoleBook().Find("robots/r2"), Role::kRobot);
  EXPECT_THAT(RoleBook::Read(Write("[roles]\n\"robots/r1\" = \"root\"\n")),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("localise-only")));
  EXPECT_THAT(RoleBook::Read(Write("[roles]\n\"r1\" = \"robot\"\n")),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("robots/ID")));
}

TEST_F(IdentityFilesTest, ACertificateNamesOneIdentity) {
  EXPECT_EQ(IdentityOfUris({"https://example.org", "homing:robots/r1"}).value(), "robots/r1");
  EXPECT_EQ(RobotOf("robots/r1"), "r1");
  EXPECT_EQ(RobotOf("operators/r1"), "");
  for (const std::vector<std::string>& uris : {std::vector<std::string>{},
                                               {"robots/r1"},
                                               {"homing:robots/"},
                                               {"homing:robots/-"},
                                               {"homing:robots/a/b"},
                                               {"homing:admins/r1"},
                                               {"homing:robots/r1", "homing:robots/r2"}}) {
    EXPECT_THAT(IdentityOfUris(uris),
                StatusIs(absl::StatusCode::kUnauthenticated, HasSubstr("certificate")));
  }
}

}  // namespace
}  // namespace homing::server
