// StoreService over a real socket: the whole store as one file.
#include <fstream>
#include <future>

#include "tests/server/every_rpc.h"
#include "tests/server/server_fixture.h"
#include "tests/support/connected.h"
#include "tests/support/status_matchers.h"

namespace homing::server {
namespace {

using ::testing::HasSubstr;

class StoreServiceTest : public ServerTest {
 protected:
  grpc::Status BackUp(std::string* file) {
    EveryRpc rpc(ConnectedChannel(server_->address()), "");
    return rpc.BackUp(file);
  }
};

TEST_F(StoreServiceTest, AServerOnTheCopyHasTheSameJourneysAndContinues) {
  ASSERT_THAT(Create(), IsGrpcOk());
  RecordFlow(0, 40);
  const std::string exported = Export();
  std::string file;
  ASSERT_THAT(BackUp(&file), IsGrpcOk());
  EXPECT_FALSE(std::ifstream(folder_.File("homing.db-backup")).good());
  // Later observations are not in the copy.
  RecordFlow(40, 60);
  server_.reset();
  std::ofstream(folder_.File("homing.db"), std::ios::binary | std::ios::trunc) << file;
  StartServer();
  EXPECT_EQ(Export(), exported);
  EXPECT_EQ(Get().next_sequence(), 40);
  RecordFlow(40, 50);
  EXPECT_EQ(Get().next_sequence(), 50);
}

TEST_F(StoreServiceTest, RecordingContinuesDuringABackup) {
  ASSERT_THAT(Create(), IsGrpcOk());
  RecordFlow(0, 10);
  auto copies = std::async(std::launch::async, [this] {
    for (int i = 0; i < 5; ++i) {
      std::string file;
      EXPECT_THAT(BackUp(&file), IsGrpcOk());
      EXPECT_EQ(file.substr(0, 15), "SQLite format 3");
    }
  });
  RecordFlow(10, 60);
  copies.get();
  EXPECT_EQ(Get().next_sequence(), 60);
}

TEST_F(StoreServiceTest, AStoreThatIsOnlyReadIsNotCopied) {
  ASSERT_THAT(Create(), IsGrpcOk());
  options_.readonly = true;
  StartServer();
  std::string file;
  EXPECT_THAT(BackUp(&file),
              GrpcStatusIs(grpc::StatusCode::FAILED_PRECONDITION, HasSubstr("read-only")));
  EXPECT_EQ(file, "");
}

}  // namespace
}  // namespace homing::server
