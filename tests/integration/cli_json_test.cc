// Shapes of the lines that --json prints.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "tests/integration/cli_fixture.h"

namespace homing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr char kOut[] = "sim:street,length=8";
constexpr char kHome[] = "sim:street,length=8,speed=5,offset=-0.5,travel=return";

std::vector<std::string> Keys(const std::string& line) {
  std::vector<std::string> keys;
  const auto object = nlohmann::ordered_json::parse(line, nullptr, false);
  for (const auto& [key, value] : object.items()) keys.push_back(key);
  return keys;
}

class CliJsonTest : public CliTest {
 protected:
  Ran Record(const std::string& send = "frames") const {
    return Homing({"record", "--json", "--journey", kJourney, "--left", kOut, "--right", kOut,
                   "--send", send});
  }
};

// `ulimit -f` counts blocks of 512 bytes.
TEST_F(CliJsonTest, AFullDiskEndsTheFilesAndNotTheAnswers) {
  StartServer();
  ASSERT_EQ(Record().code, 0);
  const std::vector<std::string> localize = {"localize", "--json", "--journey", kJourney,
                                             "--left",   kHome,    "--right",   kHome};
  const Ran whole = Homing(localize);
  ASSERT_EQ(whole.code, 0) << whole.errors;
  std::vector<std::string> limited = Command(localize);
  for (const std::string& word :
       {std::string("--mcap-out"), Path("a.mcap"), std::string("--csv"), Path("a.csv")}) {
    limited.push_back(word);
  }
  limited.insert(limited.begin(),
                 {"/bin/sh", "-c", "trap '' XFSZ; ulimit -f 2; exec \"$@\"", "sh"});
  const Ran ran = Run(limited);
  EXPECT_EQ(ran.code, 1);
  EXPECT_EQ(ran.lines.size(), whole.lines.size());
  for (const char* file : {"a.mcap", "a.csv"}) {
    EXPECT_THAT(ran.errors, HasSubstr(Path(file) + ": File too large; the answers continue"));
  }
}

TEST_F(CliJsonTest, RecordPrintsOneLineAnObservation) {
  StartServer();
  const Ran ran = Record();
  ASSERT_EQ(ran.code, 0) << ran.errors;
  const auto lines = ran.Json();
  ASSERT_GT(lines.size(), 20U);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    EXPECT_THAT(Keys(ran.lines[i]),
                ElementsAre("sequence", "next_sequence", "frame", "step", "motion", "landmarks"));
    EXPECT_EQ(lines[i]["sequence"], i);
    EXPECT_EQ(lines[i]["frame"], i);
    EXPECT_GE(lines[i]["next_sequence"], i + 1);
    if (i == 0) {
      EXPECT_TRUE(lines[i]["step"].is_null());
    } else {
      EXPECT_EQ(lines[i]["step"], i - 1);
    }
  }
  EXPECT_THAT(Keys(lines[5]["landmarks"][0].dump()).size(), 5U);
}

TEST_F(CliJsonTest, LocalizePrintsOneLineAnObservation) {
  StartServer();
  ASSERT_EQ(Record().code, 0);
  const Ran ran =
      Homing({"localize", "--json", "--journey", kJourney, "--left", kHome, "--right", kHome});
  ASSERT_EQ(ran.code, 0) << ran.errors;
  const auto lines = ran.Json();
  ASSERT_GT(lines.size(), 15U);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    EXPECT_THAT(
        Keys(ran.lines[i]),
        ElementsAre("sequence", "frame", "outcome", "motion", "journey", "step", "step_frame",
                    "probability", "interval", "progress_home", "direction", "speed_ratio", "turn",
                    "path_offset", "on_route", "landmark", "similarity", "matches"));
    EXPECT_EQ(lines[i]["sequence"], i);
    EXPECT_EQ(lines[i]["frame"], i);
  }
  EXPECT_TRUE(lines[0]["step"].is_null());
  EXPECT_TRUE(lines[0]["interval"].is_null());
  const auto placed = std::ranges::find_if(
      lines, [](const nlohmann::json& line) { return line["step"].is_number_integer(); });
  ASSERT_NE(placed, lines.end());
  EXPECT_EQ((*placed)["interval"].size(), 2U);
  EXPECT_EQ((*placed)["step_frame"], (*placed)["step"].get<std::int64_t>() + 1);
}

TEST_F(CliJsonTest, LocalizeOfFlowHasOneLineLess) {
  StartServer();
  ASSERT_EQ(Record().code, 0);
  const std::vector<std::string> common = {"localize", "--json", "--journey", "robots/-/journeys/-",
                                           "--left",   kHome,    "--right",   kHome,
                                           "--send"};
  auto frames = common;
  frames.push_back("frames");
  auto flow = common;
  flow.push_back("flow");
  const auto by_frames = Homing(frames).Json();
  const auto by_flow = Homing(flow).Json();
  ASSERT_EQ(by_frames.size(), by_flow.size() + 1);
  for (std::size_t i = 0; i < by_flow.size(); ++i) {
    EXPECT_EQ(by_frames[i + 1]["frame"], by_flow[i]["frame"]) << i;
    EXPECT_EQ(by_frames[i + 1]["step"], by_flow[i]["step"]) << i;
    EXPECT_EQ(by_frames[i + 1]["probability"], by_flow[i]["probability"]) << i;
    EXPECT_EQ(by_frames[i + 1]["matches"], by_flow[i]["matches"]) << i;
  }
}

TEST_F(CliJsonTest, JourneysListShowExportImportDelete) {
  StartServer();
  ASSERT_EQ(Record().code, 0);
  const Ran list = Homing({"journeys", "list", "--json"});
  ASSERT_EQ(list.Json().size(), 1U);
  EXPECT_EQ(list.Json()[0]["journey"], kJourney);
  EXPECT_EQ(list.Json()[0]["state"], "FINISHED");
  const Ran show = Homing({"journeys", "show", "--json", kJourney});
  ASSERT_EQ(show.Json().size(), 1U);
  EXPECT_EQ(show.Json()[0]["landmarks"].size(), show.Json()[0]["landmark_count"]);
  EXPECT_EQ(show.Json()[0]["cameras"], (nlohmann::json{{"LEFT", "ACROSS"}, {"RIGHT", "ACROSS"}}));
  EXPECT_GT(show.Json()[0]["bytes"], 16 * show.Json()[0]["fingerprint_count"].get<int>());
  const Ran table = Homing({"journeys", "show", kJourney});
  EXPECT_THAT(table.lines,
              ::testing::Contains(HasSubstr("LEFT looks ACROSS, RIGHT looks ACROSS, ")));
  const std::string exported = Export(kJourney);
  const Ran imported =
      Homing({"journeys", "import", "--json", "robots/a/journeys/copy", Path("exported")});
  ASSERT_EQ(imported.code, 0) << imported.errors;
  EXPECT_EQ(Export("robots/a/journeys/copy"), exported);
  EXPECT_EQ(Homing({"journeys", "delete", "--json", kJourney}).Json()[0]["deleted"], true);
  EXPECT_EQ(Homing({"journeys", "list", "--json"}).lines.size(), 1U);
}

TEST_F(CliJsonTest, BackupIsADatabaseThatAServerCanUse) {
  StartServer();
  ASSERT_EQ(Record().code, 0);
  const std::string exported = Export(kJourney);
  const Ran ran = Homing({"backup", "--json", Path("copy.db")});
  ASSERT_EQ(ran.code, 0) << ran.errors;
  EXPECT_EQ(ran.Json()[0]["bytes"], std::filesystem::file_size(Path("copy.db")));
  EXPECT_FALSE(std::filesystem::exists(Path("copy.db.part")));
  Program server({HOMING_SERVER_PROGRAM, "--listen", "127.0.0.1:0", "--database",
                  "sqlite:" + Path("copy.db")});
  const std::string line = server.ReadLine().value_or("");
  Program from_copy({HOMING_PROGRAM, "--server", line.substr(line.rfind(' ') + 1), "journeys",
                     "export", kJourney, Path("from_copy")});
  ASSERT_EQ(from_copy.Wait(), 0) << from_copy.Stderr();
  std::ifstream file(Path("from_copy"), std::ios::binary);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), exported);
}

TEST_F(CliJsonTest, ImportRefusesADamagedFile) {
  StartServer();
  ASSERT_EQ(Record().code, 0);
  std::string bytes = Export(kJourney);
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 0x40);
  std::ofstream(Path("damaged"), std::ios::binary) << bytes;
  const Ran ran = Homing({"journeys", "import", "robots/a/journeys/copy", Path("damaged")});
  EXPECT_EQ(ran.code, 1);
  EXPECT_THAT(ran.errors, HasSubstr("INVALID_ARGUMENT"));
}

TEST_F(CliJsonTest, TrainStoresAModelAndPlotsIt) {
  StartServer();
  const Ran ran = Homing({"train", "--json", "--width", "320", "--height", "240", "--focal", "277",
                          "--model", "street", "--plot", Path("plots")});
  ASSERT_EQ(ran.code, 0) << ran.errors;
  EXPECT_EQ(ran.Json()[0]["deviation_model"], "deviationModels/street");
  EXPECT_NEAR(ran.Json()[0]["mu"], 2.24, 0.3);
  EXPECT_NEAR(ran.Json()[0]["sigma"], 0.86, 0.3);
  EXPECT_EQ(ran.Json()[0]["observations"], 1000);
  EXPECT_TRUE(std::filesystem::exists(Path("plots/deviation_density.svg")));
  EXPECT_TRUE(std::filesystem::exists(Path("plots/deviation_distribution.png")));
  const Ran record = Homing(
      {"record", "--journey", kJourney, "--left", kOut, "--model", "deviationModels/street"});
  EXPECT_EQ(record.code, 0) << record.errors;
  EXPECT_EQ(Homing({"journeys", "list", "--json"}).Json()[0]["deviation_model"],
            "deviationModels/street");
}

TEST_F(CliJsonTest, MatchFindsThePlaceAgain) {
  StartServer();
  ASSERT_EQ(Homing({"simulate", "--scene", kOut, "--out", Path("drive")}).code, 0);
  ASSERT_EQ(Homing({"record", "--journey", kJourney, "--left", Path("drive/left")}).code, 0);
  const Ran ran = Homing({"match", "--json", "--journey", kJourney, "--travel", "same", "--left",
                          Path("drive/left/000006.png") + "," + Path("drive/left/000007.png")});
  ASSERT_EQ(ran.code, 0) << ran.errors;
  const auto answer = ran.Json().at(0);
  ASSERT_FALSE(answer["matches"].empty());
  EXPECT_EQ(answer["matches"][0]["step"], 6);
  EXPECT_EQ(answer["matches"][0]["p_t"], 1.0);
  EXPECT_EQ(answer["motion"], "MOVING");
}

TEST_F(CliJsonTest, SimulateDrawAndEvaluateWorkTogether) {
  StartServer();
  ASSERT_EQ(Record().code, 0);
  for (const auto& [scene, out] : {std::pair{kOut, "out"}, std::pair{kHome, "home"}}) {
    ASSERT_EQ(Homing({"simulate", "--truth-only", "--scene", scene, "--out", Path(out)}).code, 0);
  }
  EXPECT_FALSE(std::filesystem::exists(Path("out/left")));
  const Ran home =
      Homing({"localize", "--json", "--journey", kJourney, "--left", kHome, "--right", kHome});
  std::ofstream answers(Path("home.json"));
  for (const std::string& line : home.lines) answers << line << "\n";
  answers.close();
  const std::vector<std::string> evaluate = {"evaluate",
                                             "--answers",
                                             Path("home.json"),
                                             "--truth-out",
                                             Path("out/truth.csv"),
                                             "--truth-home",
                                             Path("home/truth.csv"),
                                             "--after",
                                             "3",
                                             "--out",
                                             Path("pictures")};
  const Ran judged = Homing(evaluate);
  EXPECT_EQ(judged.code, 0) << judged.errors;
  EXPECT_THAT(judged.lines.back(), HasSubstr("verdict: "));
  EXPECT_TRUE(std::filesystem::exists(Path("pictures/way_home.png")));
  // Without the truth the table has the believed steps, and the progress home.
  const Ran told = Homing({"evaluate", "--answers", Path("home.json"), "--rows", "5"});
  EXPECT_THAT(told.lines[0], ::testing::MatchesRegex(" *sequence +step +way home +outcome.*"));
  EXPECT_THAT(told.lines[told.lines.size() - 2],
              ::testing::MatchesRegex(" *[0-9]+ +[0-9]+ +[0-9]+ % +MATCH .*"));
  for (const char* picture : {"strip.svg", "strip.png"}) {
    EXPECT_EQ(Homing({"draw", "--journey", kJourney, "--out", Path(picture)}).code, 0);
    EXPECT_GT(std::filesystem::file_size(Path(picture)), 1000U);
  }
  EXPECT_EQ(Homing({"draw", "--journey", kJourney, "--step", "3", "--out", Path("3.png")}).code, 0);
  EXPECT_EQ(Homing({"draw", "--journey", kJourney, "--step", "3000", "--out", Path("4.png")}).code,
            1);
}

}  // namespace
}  // namespace homing
