#include <filesystem>
#include <fstream>
#include <iomanip>
#include <map>
#include <random>
#include <sstream>

#include "tests/integration/cli_fixture.h"

namespace homing {
namespace {

// Columns "sequence" and "metres" of a simulation's truth.
std::map<int, double> TruthOf(const std::string& path) {
  std::map<int, double> truth;
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  std::stringstream names(line);
  int sequence_column = 0, metres_column = 0;
  std::string name;
  for (int column = 0; std::getline(names, name, ','); ++column) {
    if (name == "sequence") sequence_column = column;
    if (name == "metres") metres_column = column;
  }
  while (std::getline(file, line)) {
    std::stringstream values(line);
    std::string value;
    std::map<int, std::string> row;
    for (int column = 0; std::getline(values, value, ','); ++column) row[column] = value;
    truth[std::stoi(row[sequence_column])] = std::stod(row[metres_column]);
  }
  return truth;
}

class CliLostFramesTest : public CliTest {
 protected:
  // Links to the frames that a link delivers which loses this part of them; the frames' numbers.
  std::vector<int> Lose(double part, const std::string& folder) {
    std::mt19937 engine(3);
    std::uniform_real_distribution<double> draw(0, 1);
    std::vector<int> kept;
    for (const char* side : {"left", "right"})
      std::filesystem::create_directories(Path(folder) + "/" + side);
    for (int i = 0;; ++i) {
      std::ostringstream name;
      name << std::setw(6) << std::setfill('0') << i << ".png";
      if (!std::filesystem::exists(Path("home/left/") + name.str())) return kept;
      if (draw(engine) <= part) continue;
      kept.push_back(i);
      for (const std::string side : {"left/", "right/"}) {
        std::filesystem::create_symlink(Path("home/") + side + name.str(),
                                        Path(folder) + "/" + side + name.str());
      }
    }
  }
};

// The tracker cannot follow what lies more than some frames apart.
TEST_F(CliLostFramesTest, NineInTenMatchesHoldTheTruth) {
  StartServer();
  const std::string scene = "street,length=60,seed=9";
  ASSERT_EQ(Homing({"simulate", "--scene", scene, "--out", Path("out")}).code, 0);
  ASSERT_EQ(Homing({"simulate", "--scene", scene + ",noise=3,speed=5", "--out", Path("home")}).code,
            0);
  ASSERT_EQ(Homing({"record", "--journey", kJourney, "--left", Path("out/left"), "--right",
                    Path("out/right")})
                .code,
            0);
  const auto out = TruthOf(Path("out/truth.csv")), home = TruthOf(Path("home/truth.csv"));
  for (const std::string part : {"0.5", "0.7"}) {
    SCOPED_TRACE("lost " + part);
    const std::vector<int> frames = Lose(std::stod(part), part);
    const Ran ran = Homing({"--json", "localize", "--journey", kJourney, "--travel", "same",
                            "--left", Path(part + "/left"), "--right", Path(part + "/right")});
    ASSERT_EQ(ran.code, 0) << ran.errors;
    int matches = 0, right = 0;
    for (const auto& answer : ran.Json()) {
      if (answer["outcome"] != "MATCH") continue;
      ++matches;
      const double first = out.at(answer["interval"][0].get<int>() + 1);
      const double last = out.at(answer["interval"][1].get<int>() + 1);
      const double truth = home.at(frames.at(answer["sequence"].get<std::size_t>()));
      right += first - 0.01 <= truth && truth <= last + 0.01 ? 1 : 0;
    }
    EXPECT_GE(matches, 20);
    EXPECT_GE(right, 0.9 * matches) << right << " of " << matches;
  }
}

}  // namespace
}  // namespace homing
