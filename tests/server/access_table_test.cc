// Role x method x owner over a real socket: the permitted calls, and the codes of the others.
#include <google/protobuf/descriptor.h>

#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <sstream>
#include <thread>

#include "server/access/role.h"
#include "server/access/token_book.h"
#include "server/config/health_check.h"
#include "tests/server/every_rpc.h"
#include "tests/server/server_fixture.h"
#include "tests/support/connected.h"
#include "tests/support/status_matchers.h"

namespace homing::server {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr char kPrivate[] = "robots/owner/journeys/private";
constexpr char kListed[] = "robots/owner/journeys/listed";
constexpr char kFleet[] = "robots/owner/journeys/fleet";
constexpr char kGuides[] = "robots/guide/journeys/own";

// The rights of a caller to a journey, a letter each: Write, Delete, See, take Map, Localize,
// Train, see models, take a Backup, see the Fleet (of its robot).
struct Row {
  const char* identity;
  const char* journey;
  const char* rights;
};

constexpr Row kRows[] = {
    {"operators/chief", kPrivate, "WDSMLTmBF"},
    {"operators/anna", kPrivate, "DSMLTmBF"},
    {"operators/anna", kFleet, "DSMLTmBF"},
    {"robots/owner", kPrivate, "WDSMLmF"},
    {"robots/owner", kListed, "WDSMLmF"},
    {"robots/owner", kGuides, "m"},
    {"robots/reader", kPrivate, "m"},
    {"robots/reader", kListed, "SMLm"},
    {"robots/reader", kFleet, "SMLm"},
    {"robots/other", kPrivate, "m"},
    {"robots/other", kListed, "m"},
    {"robots/other", kFleet, "SMLm"},
    {"robots/guide", kPrivate, "m"},
    {"robots/guide", kListed, "SLm"},
    {"robots/guide", kFleet, "SLm"},
    {"robots/guide", kGuides, "SLmF"},
    {"robots/banned", kPrivate, ""},
    {"robots/banned", kFleet, ""},
};

char LetterOf(Right right) { return "WDSMLTmBF"[static_cast<std::size_t>(right)]; }

// Without and with the index of all journeys, which must not know more than the scan.
class AccessTableTest : public ServerTest, public ::testing::WithParamInterface<bool> {
 protected:
  AccessTableTest() {
    options_.tokens = folder_.File("tokens.toml");
    options_.roles = folder_.File("roles.toml");
    options_.reload_s = 1;
    options_.all_journeys_index = GetParam();
    std::ofstream(options_.roles) << "[roles]\n\"operators/chief\" = \"admin\"\n"
                                     "\"robots/guide\" = \"localise-only\"\n"
                                     "\"robots/banned\" = \"none\"\n";
    for (const char* identity :
         {"operators/chief", "operators/anna", "robots/owner", "robots/reader", "robots/other",
          "robots/guide", "robots/banned"}) {
      EXPECT_THAT(AddToken(options_.tokens, identity, HashToken(TokenOf(identity))), IsOk());
    }
    StartGuarded();
    for (const char* journey : {kPrivate, kListed, kFleet, kGuides}) {
      EXPECT_THAT(Remake(journey), IsGrpcOk());
    }
  }

  // Ready to search all journeys.
  void StartGuarded() {
    StartServer();
    channel_ = ConnectedChannel(server_->address());
    const auto search = [this] { return As("operators/chief").Match("robots/-/journeys/-"); };
    while (search().error_code() == grpc::StatusCode::UNAVAILABLE) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }

  static std::string TokenOf(const std::string& identity) { return "secret-of-" + identity; }
  EveryRpc As(const std::string& identity) { return {channel_, TokenOf(identity)}; }

  // The journey as at the beginning.
  grpc::Status Remake(const std::string& journey) {
    EveryRpc admin = As("operators/chief");
    admin.Call(Rpc::kDeleteJourney, journey);
    std::vector<std::string> readers;
    if (journey == kListed) {
      readers = {"robots/reader", "robots/guide"};
    } else if (journey == kFleet) {
      readers = {"*"};
    }
    return admin.Create(journey, readers);
  }

  std::shared_ptr<grpc::Channel> channel_;
};

INSTANTIATE_TEST_SUITE_P(Index, AccessTableTest, ::testing::Bool(), [](const auto& index) {
  return std::string(index.param ? "Searched" : "Scanned");
});

// A list holds visible journeys only: a caller that may see any journey may list.
bool IsAllowed(const Row& row, const RpcTraits& traits) {
  const bool lists_robots = traits.right == Right::kSeeFleet && traits.field.empty();
  if (traits.rpc == Rpc::kListJourneys || lists_robots) {
    return std::string(row.rights) != "";
  }
  return std::string(row.rights).find(LetterOf(traits.right)) != std::string::npos;
}

TEST_P(AccessTableTest, EveryRoleGetsItsRightsOfEveryMethodAndNoMore) {
  for (const Row& row : kRows) {
    EveryRpc caller = As(row.identity);
    for (const RpcTraits& traits : kRpcs) {
      const std::string what =
          std::string(row.identity) + " " + std::string(traits.method) + " of " + row.journey;
      const grpc::Status status = caller.Call(traits.rpc, row.journey);
      if (IsAllowed(row, traits)) {
        EXPECT_THAT(status, GrpcStatusIs(EveryRpc::ExpectedCode(traits.rpc), ::testing::_)) << what;
      } else {
        EXPECT_THAT(status, GrpcStatusIs(grpc::StatusCode::PERMISSION_DENIED, HasSubstr("allowed")))
            << what;
        EXPECT_EQ(ReasonOf(status), "NOT_ALLOWED") << what;
      }
      EXPECT_THAT(Remake(row.journey), IsGrpcOk());
    }
  }
}

TEST_P(AccessTableTest, ListsHoldVisibleJourneysOnly) {
  for (const Row& row : kRows) {
    const bool sees = std::string(row.rights).find('S') != std::string::npos;
    for (const char* parent : {"robots/-", "robots/owner", "robots/guide"}) {
      const auto names = As(row.identity).List(parent);
      const std::string owner = std::string(row.journey).substr(0, std::string(parent).size());
      if (sees && (parent == std::string("robots/-") || owner == parent)) {
        EXPECT_THAT(names, Contains(row.journey)) << row.identity << parent;
      } else {
        EXPECT_THAT(names, Not(Contains(row.journey))) << row.identity << parent;
      }
    }
  }
  EXPECT_THAT(As("robots/other").List("robots/-"), ElementsAre(kFleet));
  EXPECT_THAT(As("robots/reader").List("robots/-"), ElementsAre(kFleet, kListed));
}

TEST_P(AccessTableTest, AWildcardCoversReadableJourneysOnly) {
  EXPECT_THAT(As("robots/other").Localize("robots/-/journeys/-"), IsGrpcOk());
  EXPECT_THAT(As("robots/other").Match("robots/owner/journeys/-"), IsGrpcOk());
  EXPECT_THAT(As("robots/other").Localize("robots/guide/journeys/-"),
              GrpcStatusIs(grpc::StatusCode::NOT_FOUND, HasSubstr("covers no journey")));
  EXPECT_THAT(As("robots/other").Match("robots/-/journeys/private"),
              GrpcStatusIs(grpc::StatusCode::NOT_FOUND, HasSubstr("covers no journey")));
  EXPECT_THAT(As("robots/owner").Match("robots/-/journeys/private"), IsGrpcOk());
}

TEST_P(AccessTableTest, UnreadableJourneysGiveNoMatch) {
  const ServerOptions guarded = options_;
  options_.tokens.clear();
  options_.roles.clear();
  StartServer();
  ASSERT_THAT(Create(), IsGrpcOk());
  RecordFlow(0, 20);
  options_ = guarded;
  StartGuarded();
  const v1::Observation seen = RecordRequest(test::FlowAt(0, 7)).observation();
  for (const char* pattern : {"robots/-/journeys/-", "robots/r/journeys/-", "robots/-/journeys/out",
                              "robots/r/journeys/out"}) {
    EXPECT_THAT(As("operators/anna").Recognise(pattern, seen), ElementsAre(kJourney)) << pattern;
    EXPECT_THAT(As("robots/other").Recognise(pattern, seen), ::testing::IsEmpty()) << pattern;
  }
}

TEST_P(AccessTableTest, ARefusalDoesNotRevealWhetherAJourneyExists) {
  const grpc::Status there = As("robots/other").Call(Rpc::kGetJourney, kPrivate);
  const grpc::Status none =
      As("robots/other").Call(Rpc::kGetJourney, "robots/owner/journeys/privatf");
  EXPECT_THAT(none, GrpcStatusIs(grpc::StatusCode::PERMISSION_DENIED, HasSubstr("privatf")));
  EXPECT_EQ(there.error_message().size(), none.error_message().size());
  EXPECT_THAT(As("robots/owner").Call(Rpc::kGetJourney, "robots/owner/journeys/none"),
              GrpcStatusIs(grpc::StatusCode::NOT_FOUND, HasSubstr("none")));
}

TEST_P(AccessTableTest, ACallerWithoutCredentialsGetsNothing) {
  EveryRpc nobody(channel_, "");
  EveryRpc stranger(channel_, "guess");
  EveryRpc thief(channel_, ToText(HashToken(TokenOf("operators/chief"))));
  for (const RpcTraits& traits : kRpcs) {
    for (EveryRpc* caller : {&nobody, &stranger, &thief}) {
      const grpc::Status status = caller->Call(traits.rpc, kFleet);
      EXPECT_EQ(status.error_code(), grpc::StatusCode::UNAUTHENTICATED) << traits.method;
      EXPECT_EQ(ReasonOf(status), caller == &nobody ? "NO_CREDENTIALS" : "BAD_TOKEN");
      EXPECT_THAT(status.error_message(), Not(HasSubstr("guess")));
    }
  }
}

TEST_P(AccessTableTest, ACallerWithoutCredentialsFillsNoLog) {
  std::ostringstream text;
  const auto before = spdlog::default_logger();
  spdlog::set_default_logger(std::make_shared<spdlog::logger>(
      "test", std::make_shared<spdlog::sinks::ostream_sink_mt>(text)));
  EveryRpc nobody(channel_, "");
  for (int i = 0; i < 100; ++i) nobody.Call(Rpc::kDeleteJourney, kFleet);
  spdlog::set_default_logger(before);
  const std::string lines = text.str();
  EXPECT_LE(std::count(lines.begin(), lines.end(), '\n'), 20);
}

TEST_P(AccessTableTest, HealthIsForEveryone) {
  EXPECT_THAT(CheckHealth(server_->address()), IsOk());
}

TEST_P(AccessTableTest, EveryMethodOfTheApiHasARow) {
  std::vector<std::string> methods;
  for (const char* name :
       {"homing.v1.JourneyService", "homing.v1.HomingService", "homing.v1.DeviationModelService",
        "homing.v1.StoreService", "homing.v1.FleetService"}) {
    const auto* service =
        google::protobuf::DescriptorPool::generated_pool()->FindServiceByName(name);
    ASSERT_NE(service, nullptr);
    for (int i = 0; i < service->method_count(); ++i) {
      methods.push_back(std::string(name) + "/" + service->method(i)->name());
    }
  }
  std::vector<std::string> rows;
  for (const RpcTraits& traits : kRpcs) {
    rows.emplace_back(traits.method);
  }
  EXPECT_THAT(rows, ::testing::UnorderedElementsAreArray(methods));
}

TEST_P(AccessTableTest, ATokenTakenAwayEndsTheStreamThatUsesIt) {
  grpc::ClientContext context;
  context.AddMetadata("authorization", "Bearer " + TokenOf("robots/owner"));
  const auto stream = journeys_->RecordJourney(&context);
  v1::RecordJourneyRequest request;
  request.mutable_config()->set_journey(kPrivate);
  request.mutable_config()->set_writer_id("writer");
  stream->Write(request);
  v1::RecordJourneyResponse response;
  ASSERT_TRUE(stream->Read(&response));
  std::ofstream(options_.tokens, std::ios::trunc) << "[tokens]\n";
  EXPECT_FALSE(stream->Read(&response));
  EXPECT_THAT(stream->Finish(),
              GrpcStatusIs(grpc::StatusCode::UNAUTHENTICATED, HasSubstr("token")));
}

TEST_P(AccessTableTest, AnEmptyFileTakesNoTokenAndNoRoleAway) {
  for (const char* text : {"", "\n", "# nothing\n"}) {
    std::ofstream(options_.tokens, std::ios::trunc) << text;
    std::ofstream(options_.roles, std::ios::trunc) << text;
    server_->Reload();
    EXPECT_THAT(As("robots/owner").Call(Rpc::kGetJourney, kPrivate), IsGrpcOk()) << text;
    EXPECT_THAT(As("robots/banned").Call(Rpc::kGetJourney, kFleet),
                GrpcStatusIs(grpc::StatusCode::PERMISSION_DENIED, HasSubstr("banned")))
        << text;
  }
}

TEST_P(AccessTableTest, AReloadThatIsAskedForReadsAFileThatWasJustWritten) {
  std::ofstream(options_.tokens, std::ios::trunc) << "[tokens]\n";
  server_->Reload();
  EXPECT_THAT(As("robots/owner").Call(Rpc::kGetJourney, kPrivate),
              GrpcStatusIs(grpc::StatusCode::UNAUTHENTICATED, HasSubstr("token")));
}

TEST_P(AccessTableTest, SecretsAreNotInTheMetrics) {
  As("robots/owner").Call(Rpc::kGetJourney, kPrivate);
  EveryRpc(channel_, "guess").Call(Rpc::kGetJourney, kPrivate);
  const std::string text = server_->MetricsText();
  EXPECT_THAT(text, HasSubstr("reason=\"BAD_TOKEN\""));
  for (const char* word : {"secret-of", "guess", "robots/", "owner"}) {
    EXPECT_THAT(text, Not(HasSubstr(word)));
  }
}

}  // namespace
}  // namespace homing::server
