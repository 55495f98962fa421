#include "tests/accuracy/real_runs.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <limits>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"

namespace homing::accuracy {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

std::vector<std::string> FilesOf(const std::string& folder) {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

std::vector<double> Numbers(std::size_t count) {
  std::vector<double> numbers(count);
  for (std::size_t i = 0; i < count; ++i) numbers[i] = static_cast<double>(i);
  return numbers;
}

// Rows of a file after its head.
std::vector<std::vector<std::string>> RowsOf(const std::string& csv) {
  std::ifstream file(csv);
  if (!file) Fail("cannot read " + csv);
  std::vector<std::vector<std::string>> rows;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    rows.push_back(absl::StrSplit(absl::StripAsciiWhitespace(line), ','));
  }
  return rows;
}

struct Truth {
  // By frame of the query.
  std::vector<double> places;
  double tolerance = 0;
};

// Columns: frame of the query, frame of the map (empty: not on the route), tolerance.
Truth TruthOf(const std::string& csv, std::size_t frames) {
  Truth truth{std::vector<double>(frames, kUnknown)};
  std::vector<double> tolerances;
  for (const auto& row : RowsOf(csv)) {
    if (!row.at(1).empty()) truth.places.at(std::stoul(row[0])) = std::stod(row[1]);
    tolerances.push_back(std::stod(row.at(2)));
  }
  std::ranges::sort(tolerances);
  truth.tolerance = tolerances.at(tolerances.size() / 2);
  return truth;
}

// Lap 2's frame and the frame of lap 1 at the same place.
std::vector<double> PlacesOfLap2(const std::string& match_csv, std::size_t frames) {
  std::vector<double> places(frames, kUnknown);
  for (const auto& row : RowsOf(match_csv)) {
    places.at(std::stoul(row.at(1))) = std::stod(row.at(0));
  }
  return places;
}

// Those whose truth does not come from pictures.
bool IsTruthExact(const std::string& name) {
  return name == "track" || name == "lake" || name == "gantry" || name == "shop";
}

// One folder of images.
struct Source {
  std::string name;
  std::string folder;
};

// A set for the crosses: its map, the drive of it, and a query.
struct Crossed {
  std::string name;
  std::string map;
  std::string map_folder;
  std::string query_folder;
  double tolerance;
};

class Planner {
 public:
  Planner(const std::string& data, const std::string& cache, RunPlan& plan)
      : data_(data), cache_(cache), plan_(plan) {}

  void Plan() {
    Laps();
    for (const std::string& folder : FilesOf(data_)) {
      if (std::filesystem::is_directory(folder + "/map")) {
        Route(std::filesystem::path(folder).filename());
      }
    }
    Rows("gantry");
    Rows("shop");
    Crosses();
  }

 private:
  std::string AddFiles(ImageFiles images) {
    const std::string name = images.name;
    plan_.AddDrive(
        name, [images = std::move(images), cache = cache_] { return DriveOfFiles(images, cache); });
    return name;
  }

  // Places are the numbers of the frames where they are not given.
  std::string AddFolder(const Source& source, std::vector<double> places = {}) {
    const auto files = FilesOf(source.folder);
    if (places.empty()) places = Numbers(files.size());
    return AddFiles({source.name, files, std::move(places), {}});
  }

  void AddPass(const std::string& set, const std::string& map, const std::string& query,
               double tolerance) {
    Run run;
    run.set = set;
    run.real = true;
    run.tolerance = tolerance;
    run.tolerance_steps = 0;
    run.truth_from_pictures = !IsTruthExact(set.substr(0, set.find_first_of(" :")));
    plan_.AddRun(std::move(run), map, query);
  }

  void Laps() {
    const std::string folder = data_ + "/laps/";
    const std::string map = AddFolder({"laps lap1", folder + "lap1"});
    for (const auto& [lap, set] : {std::pair("lap2", "laps"), std::pair("lap2_dim", "laps dim")}) {
      const auto places =
          PlacesOfLap2(folder + "match.csv", FilesOf(absl::StrCat(folder, lap)).size());
      AddPass(set, map, AddFolder({absl::StrCat("laps ", lap), folder + lap}, places), 10);
    }
    crossed_.push_back({"laps", map, folder + "lap1", folder + "lap2", 10});
  }

  // A map, its passes, and perhaps a foreign route.
  void Route(const std::string& name) {
    const std::string folder = data_ + "/" + name + "/";
    const std::string map = AddFolder({name + " map", folder + "map"});
    double tolerance = 0;
    for (const std::string pass : {"", "2", "3", "4", "5", "6", "7", "8", "9"}) {
      const std::string images = folder + "query" + pass;
      if (!std::filesystem::is_directory(images)) continue;
      const Truth truth = TruthOf(folder + "truth" + pass + ".csv", FilesOf(images).size());
      const std::string query =
          AddFolder({absl::StrCat(name, " query", pass), images}, truth.places);
      AddPass(pass.empty() ? name : absl::StrCat(name, ":", pass), map, query, truth.tolerance);
      tolerance = truth.tolerance;
    }
    crossed_.push_back({name, map, folder + "map", folder + "query", tolerance});
    if (std::filesystem::is_directory(folder + "foreign")) {
      AddForeign("foreign " + name, map, AddFolder({name + " foreign", folder + "foreign"}),
                 tolerance);
    }
  }

  void AddForeign(const std::string& set, const std::string& map, const std::string& query,
                  double tolerance) {
    Run run;
    run.set = set;
    run.real = true;
    run.foreign = true;
    run.tolerance = tolerance;
    run.tolerance_steps = 0;
    plan_.AddRun(std::move(run), map, query);
  }

  // Row i is the map of rows i + 1 and i + 2, forth and back.
  void Rows(const std::string& name) {
    std::vector<std::array<std::string, 2>> drives;
    for (const std::string& row : FilesOf(data_ + "/" + name)) {
      if (!std::filesystem::is_directory(row)) continue;
      auto files = FilesOf(row);
      auto places = Numbers(files.size());
      const std::string row_name =
          absl::StrCat(name, " ", std::filesystem::path(row).filename().string());
      drives.push_back({AddFiles({row_name, files, places, {}}), ""});
      std::ranges::reverse(files);
      std::ranges::reverse(places);
      drives.back()[1] = AddFiles({row_name + " back", files, places, {}});
    }
    for (std::size_t i = 0; i < drives.size(); ++i) {
      for (std::size_t other = i + 1; other <= i + 2 && other < drives.size(); ++other) {
        for (const std::string& query : drives[other]) AddPass(name, drives[i][0], query, 1);
      }
    }
    const std::string first = data_ + "/" + name + "/row00";
    crossed_.push_back({name, drives[0][0], first, first, 1});
  }

  // The query of every other set on each map.
  void Crosses() {
    for (const Crossed& map : crossed_) {
      const cv::Size size = ImageSizeOf(FilesOf(map.map_folder).front());
      for (const Crossed& query : crossed_) {
        if (query.name == map.name) continue;
        const auto files = FilesOf(query.query_folder);
        const std::string resized =
            AddFiles({absl::StrCat(query.name, " query ", size.width, "x", size.height), files,
                      Numbers(files.size()), size});
        AddForeign(absl::StrCat("foreign ", map.name, " ", query.name), map.map, resized,
                   map.tolerance);
      }
    }
  }

  std::string data_;
  std::string cache_;
  RunPlan& plan_;
  std::vector<Crossed> crossed_;
};

}  // namespace

void PlanRealRuns(const std::string& data, const std::string& cache, RunPlan& plan) {
  Planner(data, cache, plan).Plan();
}

}  // namespace homing::accuracy
