#include "client/simulator/simulation_spec.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/support/status_matchers.h"

namespace homing::client {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(SimulationSpecTest, EveryKeyIsRead) {
  const auto spec = ParseSimulationSpec(
      "sim:landmarks,seed=3,length=60,fps=4,speed=5,offset=-1.5,light=0.6,noise=4,remove=0.25,"
      "wobble=0.3,stop=5,vary=0.5,extra=12,yaw=-30,yaw_wobble=4,rough=0.5,repeat=5,drop=0.3,"
      "drop_run=10,travel=return,drive=9");
  ASSERT_THAT(spec, IsOk());
  EXPECT_EQ(spec->scene, "landmarks");
  EXPECT_EQ(spec->seed, 3U);
  EXPECT_EQ(spec->length_m, 60);
  EXPECT_EQ(spec->fps, 4);
  EXPECT_EQ(spec->speed_kmh, 5);
  EXPECT_EQ(spec->offset_m, -1.5);
  EXPECT_EQ(spec->light, 0.6);
  EXPECT_EQ(spec->noise, 4);
  EXPECT_EQ(spec->remove, 0.25);
  EXPECT_EQ(spec->wobble_m, 0.3);
  EXPECT_EQ(spec->stop_s, 5);
  EXPECT_EQ(spec->vary, 0.5);
  EXPECT_EQ(spec->extra_m, 12);
  EXPECT_EQ(spec->yaw_deg, -30);
  EXPECT_EQ(spec->yaw_wobble_deg, 4);
  EXPECT_EQ(spec->rough_deg, 0.5);
  EXPECT_EQ(spec->repeat, 5);
  EXPECT_EQ(spec->drop, 0.3);
  EXPECT_EQ(spec->drop_run, 10);
  EXPECT_TRUE(spec->travel_return);
  EXPECT_EQ(spec->drive_seed, 9U);
}

TEST(SimulationSpecTest, ASceneAloneHasTheDefaults) {
  const auto spec = ParseSimulationSpec("sim:street");
  ASSERT_THAT(spec, IsOk());
  EXPECT_EQ(spec->scene, "street");
  EXPECT_EQ(spec->length_m, SimulationSpec().length_m);
  EXPECT_FALSE(spec->travel_return);
}

TEST(SimulationSpecTest, WrongTextIsRefusedNamingKeyValueAndLimit) {
  struct Case {
    const char* text;
    std::vector<const char*> named;
  };
  const std::vector<Case> cases = {
      {"street", {"street", "sim:SCENE"}},
      {"sim:", {"scene", "landmarks or street"}},
      {"sim:forest", {"scene", "forest", "landmarks or street"}},
      {"sim:street,colour=2", {"colour", "\"2\"", "wobble"}},
      {"sim:street,", {"unknown", "wobble"}},
      {"sim:street,seed=-1", {"seed", "-1", "18446744073709551615"}},
      {"sim:street,seed=x", {"seed", "x", "18446744073709551615"}},
      {"sim:street,drive=1.5", {"drive", "1.5", "18446744073709551615"}},
      {"sim:street,length=0", {"length", "0", "[1, 100000]"}},
      {"sim:street,length=100001", {"length", "100001", "[1, 100000]"}},
      {"sim:street,length=nan", {"length", "nan", "[1, 100000]"}},
      {"sim:street,fps=241", {"fps", "241", "[0.1, 240]"}},
      {"sim:street,fps=inf", {"fps", "inf", "[0.1, 240]"}},
      {"sim:street,speed=0", {"speed", "0", "[0.1, 100]"}},
      {"sim:street,speed=", {"speed", "\"\"", "[0.1, 100]"}},
      {"sim:street,offset=6", {"offset", "6", "[-5, 5]"}},
      {"sim:street,light=5", {"light", "5", "[0.1, 4]"}},
      {"sim:street,noise=1.9", {"noise", "1.9", "[2, 100]"}},
      {"sim:street,remove=1.1", {"remove", "1.1", "[0, 1]"}},
      {"sim:street,wobble=-1", {"wobble", "-1", "[0, 2]"}},
      {"sim:street,stop=3601", {"stop", "3601", "[0, 3600]"}},
      {"sim:street,vary=1.1", {"vary", "1.1", "[0, 1]"}},
      {"sim:street,extra=41", {"extra", "41", "[0, 40]"}},
      {"sim:street,yaw=181", {"yaw", "181", "[-180, 180]"}},
      {"sim:street,yaw_wobble=-1", {"yaw_wobble", "-1", "[0, 20]"}},
      {"sim:street,rough=6", {"rough", "6", "[0, 5]"}},
      {"sim:street,repeat=1", {"repeat", "1", "whole number in [2, 1000]"}},
      {"sim:street,repeat=2.5", {"repeat", "2.5", "whole number in [2, 1000]"}},
      {"sim:street,drop=1", {"drop", "1", "[0, 0.95]"}},
      {"sim:street,drop_run=1.5", {"drop_run", "1.5", "whole number in [1, 1000]"}},
      {"sim:street,travel=back", {"travel", "back", "return or same"}},
      {"sim:street,fps=4,fps=5", {"fps", "5", "once"}},
  };
  for (const Case& wrong : cases) {
    for (const char* name : wrong.named) {
      EXPECT_THAT(ParseSimulationSpec(wrong.text),
                  StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr(name)))
          << wrong.text;
    }
  }
}

TEST(SimulationSpecTest, CreateRefusesWhatTheTextWouldNotAllow) {
  SimulationSpec spec;
  spec.noise = 0;
  EXPECT_THAT(Simulator::Create(spec),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       AllOf(HasSubstr("noise"), HasSubstr("0"), HasSubstr("[2, 100]"))));
  spec = {};
  spec.scene = "";
  EXPECT_THAT(Simulator::Create(spec),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("scene")));
}

TEST(SimulationSpecTest, DrivesThatDifferInAKeyDifferInTheirSeed) {
  const SimulationSpec outbound;
  SimulationSpec home = outbound;
  home.travel_return = true;
  SimulationSpec faster = outbound;
  faster.speed_kmh = 5;
  EXPECT_EQ(DriveSeed(outbound), DriveSeed(SimulationSpec()));
  EXPECT_NE(DriveSeed(outbound), DriveSeed(home));
  EXPECT_NE(DriveSeed(outbound), DriveSeed(faster));
  faster.drive_seed = 7;
  EXPECT_EQ(DriveSeed(faster), 7U);
}

// Drives of before the keys that may be left out keep their bytes.
TEST(SimulationSpecTest, AKeyThatIsLeftOutDoesNotChangeTheSeed) {
  EXPECT_EQ(DriveSeed(SimulationSpec()), 18074998158588550365U);
  SimulationSpec varied;
  varied.vary = 1;
  SimulationSpec dropped;
  dropped.drop = 1;
  EXPECT_NE(DriveSeed(varied), DriveSeed(SimulationSpec()));
  EXPECT_NE(DriveSeed(varied), DriveSeed(dropped));
}

}  // namespace
}  // namespace homing::client
