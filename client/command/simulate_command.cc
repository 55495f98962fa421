#include <cerrno>
#include <filesystem>
#include <fstream>
#include <memory>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/command/commands.h"
#include "client/command/json_line.h"
#include "client/command/progress.h"
#include "client/file/output_file.h"
#include "client/png_file.h"
#include "client/simulator/simulator.h"
#include "homing/base/status_macros.h"
#include "homing/flow/observation.h"

namespace homing::client {
namespace {

struct SimulateFlags {
  std::string scene;
  std::string folder;
  bool truth_only = false;
};

std::string SceneText(const std::string& scene) {
  return absl::StartsWith(scene, "sim:") ? scene : absl::StrCat("sim:", scene);
}

// A shorter drive would leave frames of the longer one behind it.
absl::Status RefuseOlderDrive(const SimulateFlags& flags) {
  const std::filesystem::path out(flags.folder);
  std::error_code error;
  bool there = std::filesystem::exists(out / "truth.csv", error);
  for (const char* camera : kCameraNames) {
    const auto folder = std::filesystem::directory_iterator(out / camera, error);
    there = there || (!error && folder != std::filesystem::directory_iterator());
  }
  if (!there) return absl::OkStatus();
  return absl::AlreadyExistsError(absl::StrCat(
      flags.folder, " holds a drive already; remove it, or give --out another folder"));
}

absl::Status MakeFolders(const SimulateFlags& flags) {
  for (const char* camera : kCameraNames) {
    const auto folder = std::filesystem::path(flags.folder) / (flags.truth_only ? "" : camera);
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) {
      return absl::ErrnoToStatus(errno, absl::StrCat("cannot make ", folder.string()));
    }
  }
  return absl::OkStatus();
}

SourceFrame ToSourceFrame(const cv::Mat& image) {
  return {FrameEncoding::kGray8, image.cols, image.rows,
          std::string(reinterpret_cast<const char*>(image.data), image.total()), 0};
}

absl::Status WriteInstant(const SimulateFlags& flags, std::int64_t index,
                          const SimulatedInstant& instant, std::ostream& truth) {
  for (std::size_t camera = 0; camera < kCameraNames.size(); ++camera) {
    truth << absl::StrFormat("%d,%s,%.4f,%d\n", index, kCameraNames[camera], instant.route_m,
                             instant.truth[camera].landmark);
    if (flags.truth_only || instant.images[camera].empty()) continue;
    HOMING_RETURN_IF_ERROR(
        WritePng(absl::StrFormat("%s/%s/%06d.png", flags.folder, kCameraNames[camera], index),
                 ToSourceFrame(instant.images[camera])));
  }
  return absl::OkStatus();
}

absl::Status WriteAll(const Session& session, const SimulateFlags& flags,
                      const Simulator& simulator, const std::string& truth_path) {
  errno = 0;
  std::ofstream truth(truth_path, std::ios::trunc);
  if (!truth) return CannotWrite(truth_path, errno);
  truth << "sequence,camera,metres,landmark\n";
  Progress progress("simulating", simulator.frame_count(), !session.quiet);
  for (std::int64_t index = 0; index < simulator.frame_count(); ++index) {
    if (session.stop.stop_requested()) return absl::CancelledError("stopped");
    HOMING_RETURN_IF_ERROR(WriteInstant(flags, index, simulator.Render(index), truth));
    progress.Set(index + 1);
  }
  truth.close();
  return truth ? absl::OkStatus() : CannotWrite(truth_path, errno);
}

absl::Status Simulate(const Session& session, const SimulateFlags& flags) {
  HOMING_ASSIGN_OR_RETURN(const SimulationSpec spec, ParseSimulationSpec(SceneText(flags.scene)));
  HOMING_ASSIGN_OR_RETURN(const auto simulator, Simulator::Create(spec));
  HOMING_RETURN_IF_ERROR(RefuseOlderDrive(flags));
  HOMING_RETURN_IF_ERROR(MakeFolders(flags));
  const std::string truth_path = absl::StrCat(flags.folder, "/truth.csv");
  HOMING_RETURN_IF_ERROR(WriteAll(session, flags, *simulator, truth_path));
  if (session.json) {
    return session.PrintJson(Json{{"scene", SceneText(flags.scene)},
                                  {"frames", simulator->frame_count()},
                                  {"out", flags.folder},
                                  {"truth", truth_path}});
  }
  return session.Print(absl::StrCat(flags.folder, ": ", simulator->frame_count(),
                                    " instants, truth in ", truth_path));
}

}  // namespace

void AddSimulateCommand(CLI::App& app, Session& session) {
  CLI::App& command = *app.add_subcommand(
      "simulate",
      "Write the simulated robot's frames (left/, right/) and truth.csv; needs no server");
  auto flags = std::make_shared<SimulateFlags>();
  command
      .add_option(
          "--scene", flags->scene,
          "street or landmarks, then [,key=value...]: seed, length, fps, speed, offset, "
          "light, noise, remove, wobble, stop, vary, extra, yaw, yaw_wobble, rough, repeat, "
          "drop, drop_run, corner, travel, drive")
      ->required()
      ->check([](const std::string& text) {
        return std::string(ParseSimulationSpec(SceneText(text)).status().message());
      });
  command.add_option("--out", flags->folder, "DIR to write to")
      ->required()
      ->check([](const std::string& text) {
        return std::string(text.empty() ? "must name a folder" : "");
      });
  command.add_flag("--truth-only", flags->truth_only, "Write truth.csv and no frames");
  command.callback(
      [flags, &session] { session.run = [flags, &session] { return Simulate(session, *flags); }; });
}

}  // namespace homing::client
