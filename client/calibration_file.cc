#include "client/calibration_file.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <nlohmann/json.hpp>
#include <pugixml.hpp>
#include <stdexcept>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "client/bag/camera_info.h"
#include "homing/base/range_check.h"
#include "homing/base/status_macros.h"

namespace homing::client {
namespace {

using Json = nlohmann::json;

// Far more than any calibration.
constexpr std::size_t kMaxBytes = 1 << 20;

absl::StatusOr<std::string> ReadText(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return absl::ErrnoToStatus(errno, path);
  std::string text(kMaxBytes, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.empty() || text.size() == kMaxBytes) {
    return absl::InvalidArgumentError(
        absl::StrCat(path, " is not a calibration file: it is empty or larger than 1 MiB"));
  }
  return text;
}

// Both kinds of file as one kind of tree. Aliases of YAML can make a small file a huge or an
// endless tree.
class TreeBuilder {
 public:
  Json FromYaml(const YAML::Node& node, int depth = 0) {
    Count(depth);
    Json tree;
    if (node.IsScalar()) return FromText(node.Scalar());
    if (node.IsSequence()) {
      for (const auto& child : node) tree.push_back(FromYaml(child, depth + 1));
    }
    if (node.IsMap()) {
      for (const auto& child : node) tree[child.first.Scalar()] = FromYaml(child.second, depth + 1);
    }
    return tree;
  }

  // Values in a row are a list.
  Json FromXml(const pugi::xml_node& node, int depth = 0) {
    Count(depth);
    Json tree;
    for (const pugi::xml_node& child : node.children()) {
      if (child.type() == pugi::node_element) tree[child.name()] = FromXml(child, depth + 1);
    }
    if (!tree.is_null()) return tree;
    const std::vector<std::string> values =
        absl::StrSplit(node.child_value(), absl::ByAnyChar(" \t\r\n"), absl::SkipEmpty());
    if (values.size() == 1) return FromText(values[0]);
    for (const std::string& value : values) {
      Count(depth);
      tree.push_back(FromText(value));
    }
    return tree;
  }

 private:
  static constexpr int kMostNodes = 100'000;
  static constexpr int kMostDepth = 100;

  static Json FromText(const std::string& text) {
    double number = 0;
    return absl::SimpleAtod(text, &number) ? Json(number) : Json(text);
  }
  void Count(int depth) {
    if (++count_ > kMostNodes || depth > kMostDepth) throw std::length_error("too many nodes");
  }

  int count_ = 0;
};

// Throws.
Json ReadTree(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first != std::string::npos && text[first] == '<') {
    pugi::xml_document document;
    const pugi::xml_parse_result parsed = document.load_buffer(text.data(), text.size());
    if (!parsed) throw std::invalid_argument(parsed.description());
    return TreeBuilder().FromXml(document.document_element());
  }
  // The first line of OpenCV's files is not YAML.
  const bool opencv = absl::StartsWith(text, "%YAML:");
  return TreeBuilder().FromYaml(
      YAML::Load(opencv ? text.substr(std::min(text.size(), text.find('\n'))) : text));
}

Json FirstOf(const Json& parent, const std::vector<const char*>& names) {
  for (const char* name : names) {
    if (parent.is_object() && parent.contains(name)) return parent.at(name);
  }
  return {};
}

// The numbers of a list, or of the data of a matrix. Throws if one of them is none: the others
// would move to its place.
std::vector<double> NumbersOf(const Json& node) {
  std::vector<double> values;
  for (const Json& value : node.is_object() ? FirstOf(node, {"data"}) : node) {
    if (!value.is_number()) throw std::invalid_argument(value.dump() + " is not a number");
    values.push_back(value.get<double>());
  }
  return values;
}

std::string TextOf(const Json& node) { return node.is_string() ? node.get<std::string>() : ""; }

std::uint32_t PixelsOf(const Json& node) {
  const double value = node.is_number() ? node.get<double>() : 0;
  return value >= 0 && value <= 1e6 ? static_cast<std::uint32_t>(value) : 0;
}

// camera_info of ROS and the files of OpenCV differ in names only.
CameraInfo ReadMatrices(const Json& root) {
  CameraInfo info;
  info.width = PixelsOf(FirstOf(root, {"image_width", "imageWidth", "width"}));
  info.height = PixelsOf(FirstOf(root, {"image_height", "imageHeight", "height"}));
  info.matrix = NumbersOf(FirstOf(root, {"camera_matrix", "cameraMatrix", "K"}));
  info.distortion = NumbersOf(FirstOf(root, {"distortion_coefficients", "dist_coeffs", "distCoeffs",
                                             "distortionCoefficients", "D"}));
  info.distortion_model = TextOf(FirstOf(root, {"distortion_model"}));
  // Written by OpenCV's own calibration program.
  if (PixelsOf(FirstOf(root, {"fisheye_model"})) != 0) info.distortion_model = "fisheye";
  return info;
}

absl::StatusOr<CameraInfo> ReadKalibr(const Json& node) {
  CameraInfo info;
  const std::string model = TextOf(node.at("camera_model"));
  const std::vector<double> in = NumbersOf(FirstOf(node, {"intrinsics"}));
  if (model != "pinhole" || in.size() != 4) {
    return absl::InvalidArgumentError(absl::StrCat("its camera_model \"", model, "\" with ",
                                                   in.size(), " intrinsics is not pinhole with 4"));
  }
  info.matrix = {in[0], 0, in[2], 0, in[1], in[3], 0, 0, 1};
  info.distortion = NumbersOf(FirstOf(node, {"distortion_coeffs"}));
  info.distortion_model = TextOf(FirstOf(node, {"distortion_model"}));
  if (info.distortion_model == "none") info.distortion_model = "";
  const Json size = FirstOf(node, {"resolution"});
  if (size.is_array() && size.size() == 2) {
    info.width = PixelsOf(size[0]);
    info.height = PixelsOf(size[1]);
  }
  return info;
}

absl::StatusOr<CameraInfo> ReadRoot(const Json& root, const std::string& camera) {
  std::vector<std::string> cameras;
  if (root.is_object()) {
    for (const auto& [name, node] : root.items()) {
      if (node.is_object() && node.contains("camera_model")) cameras.push_back(name);
    }
  }
  if (cameras.empty()) return ReadMatrices(root);
  if (camera.empty() && cameras.size() == 1) return ReadKalibr(root.at(cameras[0]));
  for (const std::string& name : cameras) {
    if (name == camera) return ReadKalibr(root.at(name));
  }
  return absl::InvalidArgumentError(
      absl::StrCat("it has ", cameras.size(), " cameras; name one, as FILE#", cameras[0]));
}

absl::StatusOr<CameraInfo> ParseCalibration(const std::string& text, const std::string& camera) {
  try {
    return ReadRoot(ReadTree(text), camera);
  } catch (const std::exception& error) {
    return absl::InvalidArgumentError(absl::StrCat("it cannot be read: ", error.what()));
  }
}

}  // namespace

absl::StatusOr<Camera> ReadCalibrationFile(const std::string& name) {
  const std::size_t hash = name.rfind('#');
  const std::string path = name.substr(0, hash);
  const std::string camera = hash == std::string::npos ? "" : name.substr(hash + 1);
  HOMING_ASSIGN_OR_RETURN(const std::string text, ReadText(path));
  const absl::StatusOr<CameraInfo> info = ParseCalibration(text, camera);
  if (!info.ok()) return Within(path, info.status());
  absl::StatusOr<Camera> result = ToCamera(*info, /*rectified=*/false);
  if (!result.ok()) return Within(path, result.status());
  return result;
}

}  // namespace homing::client
