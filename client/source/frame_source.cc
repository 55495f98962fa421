#include "client/source/frame_source.h"

#include <algorithm>
#include <filesystem>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/bag/bag_source.h"
#include "client/source/image_folder.h"
#include "client/source/image_list.h"
#include "client/source/image_names.h"
#include "client/source/opencv_readers.h"
#include "client/source/simulated_source.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

bool IsFolderOrGlob(const std::string& source) {
  std::error_code error;
  if (std::filesystem::is_directory(source, error)) return true;
  if (std::filesystem::exists(source, error)) return false;
  return source.find_first_of("*?[") != std::string::npos;
}

// The bags of a folder: rosbag2 makes a folder for each recording, with one bag or more.
std::vector<std::string> BagsIn(const std::string& folder) {
  std::vector<std::string> bags;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (bag::ParseBagName(entry.path().string())) bags.push_back(entry.path().string());
  }
  std::sort(bags.begin(), bags.end());
  return bags;
}

// "0" to "999", unless there is a file of that name.
bool IsCameraIndex(const std::string& source) {
  std::error_code error;
  return source.size() <= 3 && std::all_of(source.begin(), source.end(), absl::ascii_isdigit) &&
         !std::filesystem::exists(source, error);
}

}  // namespace

bool IsNetworkSource(const std::string& source) {
  for (const char* scheme : {"rtsp://", "rtsps://", "http://", "https://"}) {
    if (absl::StartsWithIgnoreCase(source, scheme)) return true;
  }
  return false;
}

absl::Status CheckSourceText(const std::string& source) {
  if (source.empty()) return absl::InvalidArgumentError("SOURCE is empty");
  if (absl::StartsWith(source, "sim:")) return ParseSimulationSpec(source).status();
  return absl::OkStatus();
}

absl::StatusOr<std::unique_ptr<FrameSource>> OpenFrameSource(const std::string& source,
                                                             Side camera) {
  HOMING_RETURN_IF_ERROR(CheckSourceText(source));
  if (absl::StartsWith(source, "sim:")) {
    HOMING_ASSIGN_OR_RETURN(const SimulationSpec spec, ParseSimulationSpec(source));
    return MakeSimulatedSource(spec, camera);
  }
  if (const auto bag = bag::ParseBagName(source)) return bag::OpenBagSource(*bag, camera);
  if (IsFolderOrGlob(source)) {
    auto images = ListImages(source);
    if (images.ok()) return MakeImageFolder(*std::move(images));
    const std::vector<std::string> bags = BagsIn(source);
    if (bags.size() == 1) return OpenFrameSource(bags[0], camera);
    if (bags.empty()) return images.status();
    return absl::InvalidArgumentError(absl::StrCat(source, " holds ", bags.size(),
                                                   " bags and no images; name one, as ", bags[0]));
  }
  std::error_code error;
  if (IsNetworkSource(source)) {
    HOMING_ASSIGN_OR_RETURN(const OpenCvReaders* const readers, LoadOpenCvReaders());
    return readers->open_video(source);
  }
  if (IsCameraIndex(source)) return OpenFrameSource("/dev/video" + source, camera);
  if (!std::filesystem::exists(source, error)) {
    return absl::NotFoundError(absl::StrCat(source, ": no such file or folder"));
  }
  if (std::filesystem::is_regular_file(source, error) && HasImageEnding(source)) {
    return absl::InvalidArgumentError(
        absl::StrCat(source, " is one image; give its folder, or a glob of images in quotes"));
  }
  if (std::filesystem::is_regular_file(source, error) && HasListEnding(source)) {
    HOMING_ASSIGN_OR_RETURN(auto images, ReadImageList(source));
    return MakeImageFolder(std::move(images));
  }
  HOMING_ASSIGN_OR_RETURN(const OpenCvReaders* const readers, LoadOpenCvReaders());
  return readers->open_video(source);
}

}  // namespace homing::client
