#include "server/service/journey_archive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>

#include "homing/v1/journey_map.pb.h"
#include "tests/support/status_matchers.h"

namespace homing::server {
namespace {

using ::testing::HasSubstr;

constexpr std::size_t kMagicBytes = 8;
constexpr std::size_t kChecksumBytes = 4;

JourneySettings Settings() {
  JourneySettings settings;
  settings.cameras[0] = {.width = 320,
                         .height = 240,
                         .intrinsics = Intrinsics{277.1, 276.9, 160.25, 119.75},
                         .distortion = {0.1, -0.02, 0.001, 1e-17, 1.0 / 3},
                         .yaw_rad = -0.05};
  settings.landmark.min_peak_share = 1.0 / 7;
  settings.deviation_model_name = "deviationModels/wide";
  settings.deviation_model = {2.2400000000000002, 0.86, 1000, 0.0123, 320, 240};
  return settings;
}

JourneyMap Map(int steps) {
  JourneyMap map(Settings());
  for (int i = 0; i < steps; ++i) {
    JourneyStep step;
    step.step = i;
    step.sequence = 3 * i + 5;
    const float x = 100.1F + static_cast<float>(i % 10) * 1.37F;
    // Landmarks of ten steps, left and right; every seventh step is empty.
    if (i % 7 != 6) {
      const std::int32_t landmark = 2 * (i / 10);
      step.fingerprints = {{Side::kLeft, {x, 80.3F, 40 + i, landmark}, 0.1 * (i % 9)},
                           {Side::kRight, {x / 3, 81.7F, 60, landmark + 1}, 0.3}};
    }
    EXPECT_THAT(map.Append(step), IsOk());
  }
  return map;
}

storage::JourneyRecord Record() {
  storage::JourneyRecord record;
  record.name = "robots/r/journeys/j";
  record.writer_id = "writer";
  record.create_time_ns = 77;
  record.start_time_ns = 1'700'000'000'000'000'001;
  record.end_time_ns = 1'700'000'009'000'000'002;
  return record;
}

std::string Encode(int steps) { return EncodeJourney(Record(), Map(steps)).value(); }

bool SameMap(const JourneyMap& a, const JourneyMap& b) {
  if (!(a.settings() == b.settings()) || a.step_count() != b.step_count()) return false;
  for (std::int64_t step = 0; step < a.step_count(); ++step) {
    if (!std::ranges::equal(a.fingerprints(step), b.fingerprints(step))) return false;
    if (a.sequence(step) != b.sequence(step)) return false;
  }
  return a.landmarks() == b.landmarks();
}

// A file with a right checksum whose message is that of Encode(20) after `change`.
template <typename Change>
std::string Forge(Change change, char version = 2) {
  const std::string good = Encode(20);
  v1::JourneyMap message;
  EXPECT_TRUE(message.ParseFromString(
      good.substr(kMagicBytes, good.size() - kMagicBytes - kChecksumBytes)));
  change(message);
  std::string bytes = good.substr(0, kMagicBytes - 1) + version + message.SerializeAsString();
  const uLong crc = crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<char>(crc >> shift));
  return bytes;
}

void ExpectRefused(const std::string& bytes, const std::string& why) {
  EXPECT_THAT(DecodeJourney(bytes), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(why)));
}

TEST(JourneyArchive, ReadsBackTheVeryMapAndWritesTheVeryBytes) {
  for (int steps : {0, 1, 500}) {
    const JourneyMap map = Map(steps);
    const auto bytes = EncodeJourney(Record(), map);
    ASSERT_THAT(bytes, IsOk());
    const auto journey = DecodeJourney(*bytes);
    ASSERT_THAT(journey, IsOk());
    EXPECT_TRUE(SameMap(journey->map, map));
    EXPECT_TRUE(journey->record.settings == map.settings());
    EXPECT_EQ(journey->record.start_time_ns, Record().start_time_ns);
    EXPECT_EQ(journey->record.end_time_ns, Record().end_time_ns);
    EXPECT_EQ(journey->record.next_sequence, steps == 0 ? 0 : 3 * (steps - 1) + 6);
    EXPECT_EQ(EncodeJourney(journey->record, journey->map).value(), *bytes);
  }
}

TEST(JourneyArchive, HoldsNoNameNoWriterNoServerClockAndNoInput) {
  storage::JourneyRecord other = Record();
  other.name = "robots/q/journeys/k";
  other.writer_id = "another";
  other.readers = {"*"};
  other.create_time_ns = 99;
  other.input = InputKind::kFrames;
  other.next_sequence = 21;
  EXPECT_EQ(EncodeJourney(other, Map(20)).value(), Encode(20));
}

TEST(JourneyArchive, TakesLittleMoreThanItsNumbers) {
  const std::string bytes = Encode(1000);
  EXPECT_LT(bytes.size(), 1000U * 2 * 14);
}

TEST(JourneyArchive, RefusesEveryFileWithOneByteChanged) {
  const std::string good = Encode(8);
  ASSERT_THAT(DecodeJourney(good), IsOk());
  for (std::size_t i = 0; i < good.size(); ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      std::string bad = good;
      bad[i] = static_cast<char>(bad[i] ^ (1 << bit));
      EXPECT_EQ(DecodeJourney(bad).status().code(), absl::StatusCode::kInvalidArgument) << i;
    }
  }
}

TEST(JourneyArchive, RefusesEveryTruncationAndExtension) {
  const std::string good = Encode(8);
  for (std::size_t size = 0; size < good.size(); ++size) {
    EXPECT_EQ(DecodeJourney(good.substr(0, size)).status().code(),
              absl::StatusCode::kInvalidArgument)
        << size;
  }
  ExpectRefused(good + '\0', "checksum");
  ExpectRefused("", "does not begin");
  ExpectRefused("PNG or something else", "does not begin");
  ExpectRefused(
      "HOMINGJ\x01"
      "abc",
      "too early");
}

TEST(JourneyArchive, RefusesMoreThanItsLimit) {
  const std::string huge(kMaxArchiveBytes + 1, 'x');
  ExpectRefused(huge, "at most 268435456");
}

TEST(JourneyArchive, ReadsVersion1WhereEachFrameButTheFirstMadeAStep) {
  const auto without = [](v1::JourneyMap& m) { m.clear_sequences(); };
  const auto journey = DecodeJourney(Forge(without, 1));
  ASSERT_THAT(journey, IsOk());
  ASSERT_EQ(journey->map.step_count(), 20);
  for (std::int64_t step = 0; step < 20; ++step) EXPECT_EQ(journey->map.sequence(step), step + 1);
  EXPECT_EQ(EncodeJourney(journey->record, journey->map).value()[kMagicBytes - 1], 2);
  ExpectRefused(Forge(without, 2), "sequences has 0 entries: must have 20");
  ExpectRefused(Forge([](v1::JourneyMap&) {}, 1), "sequences has 20 entries: must have 0");
  ExpectRefused(Forge([](v1::JourneyMap&) {}, 3), "is of version 3: must be 1 to 2");
}

TEST(JourneyArchive, RefusesSequencesThatDoNotGrow) {
  ExpectRefused(Forge([](v1::JourneyMap& m) { m.set_sequences(4, 14); }),
                "sequence of step 4: 14 must be at least 15");
  ExpectRefused(Forge([](v1::JourneyMap& m) { m.set_sequences(0, -2); }), "sequence of step 0");
  // The number after the last one would overflow.
  ExpectRefused(Forge([](v1::JourneyMap& m) { m.set_sequences(19, INT64_MAX); }),
                "sequence of step 19: 9223372036854775807 must be at most");
}

TEST(JourneyArchive, RefusesSizesThatDoNotAgree) {
  ASSERT_THAT(DecodeJourney(Forge([](v1::JourneyMap&) {})), IsOk());
  ExpectRefused(Forge([](v1::JourneyMap& m) { m.set_step_count(1'000'000'000'000); }),
                "step_count is 1000000000000");
  ExpectRefused(Forge([](v1::JourneyMap& m) { m.set_step_count(-1); }), "step_count is -1");
  ExpectRefused(Forge([](v1::JourneyMap& m) { m.set_step_count(21); }), "must have 21");
  ExpectRefused(Forge([](v1::JourneyMap& m) { m.add_sequences(99); }), "sequences has 21");
  ExpectRefused(Forge([](v1::JourneyMap& m) { m.set_fingerprints_per_step(0, 4'000'000'000U); }),
                "landmarks has");
  ExpectRefused(Forge([](v1::JourneyMap& m) { m.add_xs(1); }), "xs has");
  ExpectRefused(Forge([](v1::JourneyMap& m) { m.mutable_counts()->RemoveLast(); }), "counts has");
  ExpectRefused(Forge([](v1::JourneyMap& m) { m.add_landmark_spreads(1); }), "landmark_spreads");
  ExpectRefused(Forge([](v1::JourneyMap& m) {
                  m.add_landmark_spreads(1);
                  m.add_landmark_sides(v1::SIDE_LEFT);
                }),
                "landmark_sides has");
}

TEST(JourneyArchive, RefusesMillionsOfEmptySteps) {
  ExpectRefused(Forge([](v1::JourneyMap& m) { m.set_step_count(2'000'001); }), "must be 0 to");
}

TEST(JourneyArchive, CountsProfilesBeforeItReadsThem) {
  ExpectRefused(Forge([](v1::JourneyMap& m) {
                  for (int i = 0; i < 4'000'200; ++i) m.add_left_profiles();
                }),
                "has more than 4000100 profiles");
}

TEST(JourneyArchive, RefusesContentThatNoMapHas) {
  ExpectRefused(Forge([](v1::JourneyMap& m) { m.set_landmarks(0, 1000); }), "landmarks[0] is 1000");
  ExpectRefused(Forge([](v1::JourneyMap& m) { m.set_landmarks(0, -1); }), "landmarks[0] is -1");
  ExpectRefused(Forge([](v1::JourneyMap& m) { m.set_landmarks(1, 0); }), "landmark: 0");
  ExpectRefused(Forge([](v1::JourneyMap& m) { m.set_xs(0, NAN); }), "finite");
  ExpectRefused(Forge([](v1::JourneyMap& m) { m.set_xs(0, -0.0F); }), "xs has -0");
  ExpectRefused(Forge([](v1::JourneyMap& m) { m.set_ys(1, -0.0F); }), "ys has -0");
  ExpectRefused(Forge([](v1::JourneyMap& m) { m.set_landmark_spreads(0, -0.0); }),
                "spreads has -0");
  ExpectRefused(Forge([](v1::JourneyMap& m) { m.set_step_count(2'000'001); }), "step_count is");
  ExpectRefused(Forge([](v1::JourneyMap& m) { m.set_counts(0, 0); }), "count");
  ExpectRefused(Forge([](v1::JourneyMap& m) { m.set_landmark_spreads(0, NAN); }), "spread");
  ExpectRefused(Forge([](v1::JourneyMap& m) { m.set_landmark_sides(0, v1::SIDE_UNSPECIFIED); }),
                "landmark_sides[0]: 0");
  ExpectRefused(Forge([](v1::JourneyMap& m) { m.set_end_time_ns(-5); }), "negative");
}

TEST(JourneyArchive, RefusesSettingsThatAreWrongOrIncomplete) {
  ExpectRefused(Forge([](v1::JourneyMap& m) { m.clear_deviation(); }), "incomplete");
  ExpectRefused(Forge([](v1::JourneyMap& m) { m.mutable_settings()->clear_flow(); }), "incomplete");
  ExpectRefused(Forge([](v1::JourneyMap& m) { m.mutable_deviation()->set_sigma(-1); }), "sigma");
  ExpectRefused(
      Forge([](v1::JourneyMap& m) { m.mutable_settings()->mutable_flow()->set_cell_px(0); }),
      "cell_px");
  ExpectRefused(
      Forge([](v1::JourneyMap& m) { m.mutable_settings()->mutable_left_camera()->set_width(-3); }),
      "width: -3");
}

TEST(JourneyArchive, RefusesUnknownContent) {
  ExpectRefused(Forge([](v1::JourneyMap& m) {
                  m.GetReflection()->MutableUnknownFields(&m)->AddVarint(1000, 5);
                }),
                "does not know");
}

}  // namespace
}  // namespace homing::server
