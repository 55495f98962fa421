#include <gtest/gtest.h>

#include "client/bag/bag.h"
#include "client/camera_observations.h"
#include "client/command/answer_bag.h"
#include "client/command/answer_table.h"
#include "tests/support/status_matchers.h"
#include "tests/support/temporary_folder.h"

namespace homing::client {
namespace {

using ::testing::HasSubstr;

v1::LocalizeResponse Answer(std::int64_t sequence) {
  v1::LocalizeResponse answer;
  answer.set_sequence(sequence);
  answer.set_outcome(v1::OUTCOME_AMBIGUOUS);
  answer.set_journey("robots/a/journeys/b");
  answer.set_step(7);
  answer.set_probability(0.5);
  answer.mutable_interval()->set_first(0);
  answer.mutable_interval()->set_last(17);
  return answer;
}

// Topics of the file with their numbers of messages.
std::map<std::string, std::int64_t> CountImages(const std::string& path) {
  std::map<std::string, std::int64_t> counts;
  const auto bag = bag::OpenBag(path);
  EXPECT_THAT(bag, IsOk());
  if (!bag.ok()) return counts;
  EXPECT_EQ((*bag)->damage(), "");
  for (const auto& topic : (*bag)->topics()) {
    counts[topic.name] = static_cast<std::int64_t>(topic.messages.size());
  }
  return counts;
}

// Sends all and answers each, the answer coming `lag` observations later.
std::int64_t SendAll(AnswerBag* bag, bool send_flow, std::int64_t lag) {
  const std::string scene = "sim:street,length=4,fps=2";
  auto cameras = OpenCameras(scene, send_flow ? "" : scene);
  auto instants = CameraInstants::Create(*std::move(cameras), FrameChoice());
  CameraObservations observations(*std::move(instants),
                                  send_flow ? std::make_optional(FlowOptions()) : std::nullopt);
  const auto watched = bag->Watch(&observations);
  std::int64_t sent = 0;
  while (true) {
    const auto next = watched->Next();
    EXPECT_THAT(next, IsOk());
    if (!next.ok() || !*next) break;
    ++sent;
    if (sent > lag) {
      EXPECT_THAT(bag->Add(Answer(sent - lag - 1)), IsOk());
    }
  }
  for (std::int64_t i = std::max<std::int64_t>(0, sent - lag); i < sent; ++i) {
    EXPECT_THAT(bag->Add(Answer(i)), IsOk());
  }
  EXPECT_THAT(bag->Finish(), IsOk());
  return sent;
}

TEST(AnswerBagTest, HoldsImagesAnnotationsAndAnswers) {
  TemporaryFolder folder;
  const std::string path = folder.File("out.mcap");
  const auto bag = AnswerBag::Open(path, FlowOptions());
  ASSERT_THAT(bag, IsOk());
  const std::int64_t sent = SendAll(bag->get(), /*send_flow=*/false, /*lag=*/2);
  ASSERT_GT(sent, 4);
  const auto counts = CountImages(path);
  EXPECT_EQ(counts.at("/homing/left/image"), sent);
  EXPECT_EQ(counts.at("/homing/right/image"), sent);
  EXPECT_TRUE(counts.contains("/homing/answer"));
  EXPECT_TRUE(counts.contains("/homing/left/annotations"));
}

TEST(AnswerBagTest, OfSentFlowThereAreNoImages) {
  TemporaryFolder folder;
  const std::string path = folder.File("out.mcap");
  const auto bag = AnswerBag::Open(path, FlowOptions());
  ASSERT_THAT(bag, IsOk());
  SendAll(bag->get(), /*send_flow=*/true, /*lag=*/0);
  const auto counts = CountImages(path);
  EXPECT_FALSE(counts.contains("/homing/left/image"));
  EXPECT_TRUE(counts.contains("/homing/left/annotations"));
  EXPECT_FALSE(counts.contains("/homing/right/annotations"));
}

TEST(AnswerBagTest, ReplacesRegularFilesOnly) {
  TemporaryFolder folder;
  EXPECT_THAT(AnswerBag::Open("/dev/null", FlowOptions()),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("regular")));
  EXPECT_THAT(AnswerBag::Open(folder.File("no/folder.mcap"), FlowOptions()),
              StatusIs(absl::StatusCode::kNotFound, HasSubstr("No such file")));
}

TEST(AnswerTableTest, ALineHasAValueForEachColumn) {
  EXPECT_EQ(AnswerTableLine(Answer(12)),
            "12,AMBIGUOUS,MOVING,robots/a/journeys/b,7,0.5,0,17,,UNKNOWN,,");
  v1::LocalizeResponse lost;
  lost.set_outcome(v1::OUTCOME_UNKNOWN_PLACE);
  EXPECT_EQ(AnswerTableLine(lost), "0,UNKNOWN_PLACE,MOVING,,,0,,,,UNKNOWN,,");
  const auto commas = [](const std::string& text) {
    return std::count(text.begin(), text.end(), ',');
  };
  EXPECT_EQ(commas(AnswerTableHead()), commas(AnswerTableLine(lost)));
}

}  // namespace
}  // namespace homing::client
