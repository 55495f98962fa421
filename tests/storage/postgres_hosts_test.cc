// Which database a server accepts: several hosts, one that is silent, one that was replaced.
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <thread>

#include "absl/strings/str_cat.h"
#include "storage/postgres/pg_session.h"
#include "tests/storage/postgres_fixture.h"

namespace homing::storage {
namespace {

using ::testing::HasSubstr;

class PostgresHostsTest : public PostgresStoreTest {};

TEST_F(PostgresHostsTest, AConnectionStaysSynchronousWhenTheConfigurationChanges) {
  const auto soon = postgres::After(std::chrono::seconds(20));
  postgres::PgDatabase database(url_, postgres::PgConnection::Access::kReadWrite);
  const auto connection = database.Connect(soon);
  ASSERT_THAT(connection, IsOk());
  Query("ALTER SYSTEM SET synchronous_commit = off");
  Query("SELECT pg_reload_conf()");
  while (Query("SHOW synchronous_commit") != "off\n" && std::chrono::steady_clock::now() < soon) {
  }
  for (int i = 0; i < 10; ++i) {
    const auto rows = (*connection)->Run("SELECT current_setting('synchronous_commit')", {}, soon);
    ASSERT_THAT(rows, IsOk());
    EXPECT_EQ(rows->Text(0, 0), "on");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  Query("ALTER SYSTEM RESET synchronous_commit");
  Query("SELECT pg_reload_conf()");
}

// Its kernel takes the connection, and nothing answers: as a machine that is cut off.
TEST_F(PostgresHostsTest, AHostThatDoesNotAnswerIsPassedOver) {
  const int silent = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  ASSERT_EQ(::bind(silent, reinterpret_cast<sockaddr*>(&address), size), 0);
  ASSERT_EQ(::listen(silent, 8), 0);
  ::getsockname(silent, reinterpret_cast<sockaddr*>(&address), &size);
  url_ = absl::StrCat("postgresql://homing@/", database_, "?host=127.0.0.1,",
                      server_->socket_folder(), "&port=", ntohs(address.sin_port), ",5432");
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_THAT(Open(), IsOk());
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
  ::close(silent);
}

// Both accept writes, and the replaced one comes first.
TEST_F(PostgresHostsTest, APrimaryThatWasReplacedIsRefused) {
  const std::vector<JourneyStep> steps = MakeSteps(3);
  const std::int64_t epoch = one_->AcquireJourney(kJourney, "robot").value().epoch;
  ASSERT_THAT(one_->AppendSteps({Append(steps[0], epoch)})[0], IsOk());
  server_->Crash();
  const auto replaced = server_->Copy();
  server_->StartPromoted();
  url_ = absl::StrCat("postgresql://homing@/", database_, "?host=", replaced->socket_folder(), ",",
                      server_->socket_folder());
  const auto store = OpenOrDie(url_);
  ASSERT_THAT(store->AppendSteps({Append(steps[1], epoch)})[0], IsOk());
  replaced->Start();
  const std::string disconnect =
      "SELECT pg_terminate_backend(pid) FROM pg_stat_activity"
      " WHERE pid <> pg_backend_pid() AND datname = current_database()";
  Query(disconnect);
  EXPECT_THAT(store->AppendSteps({Append(steps[2], epoch)})[0], IsOk());
  EXPECT_EQ(replaced->Query(database_, "SELECT count(*) FROM steps"), "1\n");
  EXPECT_EQ(Query("SELECT count(*) FROM steps"), "3\n");
  server_->Crash();
  EXPECT_THAT(store->CreateJourney(Record("robots/r/journeys/other")),
              StatusIs(absl::StatusCode::kUnavailable, HasSubstr("timeline")));
  EXPECT_EQ(replaced->Query(database_, "SELECT count(*) FROM journeys"), "1\n");
  server_->Start();
}

}  // namespace
}  // namespace homing::storage
