#include "storage/query_connections.h"

#include <stdexcept>

#include "tests/support/status_matchers.h"
#include "tests/support/temporary_folder.h"

namespace homing::storage {
namespace {

TEST(QueryConnectionsTest, ABodyThatThrowsGivesItsConnectionBack) {
  const TemporaryFolder folder;
  QueryConnections queries(folder.File("queries.db"), Connection::Access::kReadWrite, 1000, 1);
  EXPECT_THROW(static_cast<void>(queries.Read(
                   [](Connection&) -> absl::Status { throw std::runtime_error("no memory"); })),
               std::runtime_error);
  // Waits for ever when the only connection is lost.
  EXPECT_THAT(queries.Read([](Connection&) { return absl::OkStatus(); }), IsOk());
  // Its transaction was rolled back too.
  EXPECT_THAT(queries.Read([](Connection&) { return absl::OkStatus(); }), IsOk());
}

}  // namespace
}  // namespace homing::storage
