// The log as JSON, and the trace of a call from the client's environment into the server's log.
#include <gmock/gmock.h>

#include <csignal>
#include <set>
#include <sstream>

#include "tests/integration/cli_fixture.h"

namespace homing {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr char kId[] = "4bf92f3577b34da6a3ce929d0e0e4736";
constexpr char kSpan[] = "00f067aa0ba902b7";

class CliTraceTest : public CliTest {
 protected:
  std::string Trace(const char* flags) const {
    return std::string("00-") + kId + "-" + kSpan + "-" + flags;
  }
  // Records, exports and deletes a short journey.
  void Use(const std::vector<std::string>& flags) const {
    const auto homing = [&](std::vector<std::string> arguments) {
      arguments.insert(arguments.end(), flags.begin(), flags.end());
      const Ran ran = Homing(arguments);
      EXPECT_EQ(ran.code, 0) << ran.errors;
    };
    homing({"record", "--journey", kJourney, "--left", "sim:street,length=2"});
    homing({"journeys", "export", kJourney, Path("exported")});
    homing({"journeys", "delete", kJourney});
  }
  // The server's log, after its end.
  std::vector<nlohmann::json> Log() {
    server_->Signal(SIGTERM);
    EXPECT_EQ(server_->Wait(), 0);
    std::vector<nlohmann::json> lines;
    std::istringstream log(server_->Stderr());
    for (std::string line; std::getline(log, line);) {
      lines.push_back(nlohmann::json::parse(line, nullptr, false));
      EXPECT_TRUE(lines.back().is_object()) << line;
    }
    return lines;
  }
  // Of those lines whose message holds `text`.
  static std::vector<nlohmann::json> With(const std::vector<nlohmann::json>& lines,
                                          const std::string& text) {
    std::vector<nlohmann::json> found;
    for (const auto& line : lines) {
      if (line["message"].get<std::string>().find(text) != std::string::npos) found.push_back(line);
    }
    return found;
  }
};

TEST_F(CliTraceTest, ASampledTraceIsInEveryLineOfItsCalls) {
  StartServer("homing.db", {"--log-format", "json"});
  Use({"--traceparent", Trace("01")});
  const auto lines = Log();
  std::set<std::string> spans;
  for (const char* method : {"JourneyService/CreateJourney", "JourneyService/RecordJourney",
                             "JourneyService/FinishJourney", "JourneyService/ExportJourney",
                             "JourneyService/DeleteJourney"}) {
    const auto calls = With(lines, std::string("call: homing.v1.") + method);
    ASSERT_THAT(calls, SizeIs(1)) << method;
    EXPECT_THAT(calls[0]["message"].get<std::string>(), HasSubstr(": OK in ")) << method;
    EXPECT_EQ(calls[0]["trace_id"], kId) << method;
    spans.insert(calls[0]["span_id"].get<std::string>());
  }
  EXPECT_THAT(spans, SizeIs(5)) << "a span each";
  EXPECT_EQ(spans.count(kSpan), 0U) << "that span is the parent's";
  const auto audit = With(lines, "audit: - homing.v1.JourneyService/DeleteJourney");
  ASSERT_THAT(audit, SizeIs(1));
  EXPECT_EQ(audit[0]["trace_id"], kId);
  EXPECT_EQ(audit[0]["level"], "info");
  EXPECT_THAT(audit[0]["time"].get<std::string>(), ::testing::MatchesRegex(".*T.*[.].*Z"));
  const auto draining = With(lines, "draining");
  ASSERT_THAT(draining, SizeIs(1));
  EXPECT_FALSE(draining[0].contains("trace_id"));
}

TEST_F(CliTraceTest, EachRunOfTheCommandBeginsATraceOtherwise) {
  StartServer("homing.db", {"--log-format", "json"});
  Use({});
  Use({"--traceparent", "nonsense"});
  const auto lines = Log();
  EXPECT_THAT(With(lines, "call: "), SizeIs(0)) << "no one records these traces";
  std::set<std::string> traces;
  const auto deleted = With(lines, "JourneyService/DeleteJourney");
  for (const auto& line : deleted) traces.insert(line["trace_id"].get<std::string>());
  EXPECT_THAT(deleted, SizeIs(2));
  EXPECT_THAT(traces, SizeIs(2));
}

}  // namespace
}  // namespace homing
