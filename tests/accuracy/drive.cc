#include "tests/accuracy/drive.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <opencv2/imgproc.hpp>

#include "client/frame_source.h"
#include "homing/image/frame.h"

namespace homing::accuracy {
namespace {

Picture PictureOf(const cv::Mat& gray) {
  cv::Mat small;
  cv::resize(gray, small, {kPictureWidth, kPictureHeight}, 0, 0, cv::INTER_AREA);
  return {small.begin<std::uint8_t>(), small.end<std::uint8_t>()};
}

// Turns frames into instants: those that make a step.
class Maker {
 public:
  void Add(const std::array<cv::Mat, 2>& images, double place) {
    Observation observation;
    observation.sequence = next_++;
    Instant instant;
    for (std::size_t side = 0; side < images.size(); ++side) {
      const cv::Mat& image = images[side];
      if (image.empty()) continue;
      observation.views[side] = Frame{
          FrameEncoding::kGray8,
          image.cols,
          image.rows,
          {reinterpret_cast<const char*>(image.data), static_cast<std::size_t>(image.total())}};
      instant.pictures[side] = PictureOf(image);
    }
    auto flow = flow_.Compute(observation);
    if (!flow.ok()) Fail(std::string(flow.status().message()));
    instant.flow = *std::move(flow);
    instant.place = 0.5 * (place + last_place_);
    if (flow_.reference_sequence() == observation.sequence) last_place_ = place;
    if (instant.flow.makes_step) drive_.push_back(std::move(instant));
  }

  Drive Take() { return std::move(drive_); }

 private:
  ObservationFlow flow_{FlowOptions()};
  std::int64_t next_ = 0;
  // Of the reference frame.
  double last_place_ = 0;
  Drive drive_;
};

template <typename T>
void Put(std::ostream& file, const T* values, std::size_t count) {
  file.write(reinterpret_cast<const char*>(values),
             static_cast<std::streamsize>(count * sizeof(T)));
}

template <typename T>
void Get(std::istream& file, T* values, std::size_t count) {
  file.read(reinterpret_cast<char*>(values), static_cast<std::streamsize>(count * sizeof(T)));
}

void Write(const Drive& drive, const std::string& path) {
  const std::string part = path + ".part";
  std::ofstream file(part, std::ios::binary);
  const std::uint64_t size = drive.size();
  Put(file, &size, 1);
  for (const Instant& instant : drive) {
    Put(file, &instant.place, 1);
    for (std::size_t side = 0; side < 2; ++side) {
      const auto& field = instant.flow.fields[side];
      const std::array<std::int32_t, 3> head{
          field ? field->width : 0, field ? field->height : 0,
          field ? static_cast<std::int32_t>(field->vectors.size()) : -1};
      Put(file, head.data(), head.size());
      if (!field) continue;
      Put(file, field->vectors.data(), field->vectors.size());
      Put(file, instant.pictures[side].data(), instant.pictures[side].size());
    }
  }
  file.close();
  if (!file) Fail("cannot write " + part);
  std::filesystem::rename(part, path);
}

Drive Read(std::istream& file) {
  std::uint64_t size = 0;
  Get(file, &size, 1);
  Drive drive(size);
  for (Instant& instant : drive) {
    Get(file, &instant.place, 1);
    for (std::size_t side = 0; side < 2; ++side) {
      std::array<std::int32_t, 3> head{};
      Get(file, head.data(), head.size());
      if (head[2] < 0) continue;
      FlowField field{.width = head[0], .height = head[1], .vectors = {}};
      field.vectors.resize(static_cast<std::size_t>(head[2]));
      Get(file, field.vectors.data(), field.vectors.size());
      instant.flow.fields[side] = std::move(field);
      instant.pictures[side].resize(std::size_t{kPictureWidth} * kPictureHeight);
      Get(file, instant.pictures[side].data(), instant.pictures[side].size());
    }
  }
  if (!file) Fail("a cached drive is damaged; delete the cache");
  return drive;
}

}  // namespace

void Fail(const std::string& reason) {
  std::cerr << "accuracy: " << reason << "\n";
  std::exit(1);
}

Drive DriveOfFiles(const std::vector<std::string>& files, const std::vector<double>& places) {
  Maker maker;
  for (std::size_t i = 0; i < files.size(); ++i) {
    auto source = client::OpenFrameSource(files[i], Side::kLeft);
    if (!source.ok()) Fail(std::string(source.status().message()));
    auto frame = (*source)->Next();
    if (!frame.ok() || !*frame) Fail("cannot read " + files[i]);
    auto image = DecodeGray((*frame)->view());
    if (!image.ok()) Fail(files[i] + ": " + std::string(image.status().message()));
    maker.Add({*image, cv::Mat()}, places[i]);
  }
  return maker.Take();
}

Drive SimulatedDrive(const std::string& spec, const std::string& cache) {
  const std::string path = cache.empty() ? "" : cache + "/" + spec.substr(4) + ".drive";
  if (std::ifstream file(path, std::ios::binary); !path.empty() && file) return Read(file);
  const auto parsed = client::ParseSimulationSpec(spec);
  if (!parsed.ok()) Fail(std::string(parsed.status().message()));
  const auto simulator = client::Simulator::Create(*parsed);
  if (!simulator.ok()) Fail(std::string(simulator.status().message()));
  Maker maker;
  for (std::int64_t i = 0; i < (*simulator)->frame_count(); ++i) {
    maker.Add(
        {(*simulator)->RenderCamera(i, Side::kLeft), (*simulator)->RenderCamera(i, Side::kRight)},
        (*simulator)->RouteMetres(i));
  }
  Drive drive = maker.Take();
  if (!path.empty()) Write(drive, path);
  return drive;
}

}  // namespace homing::accuracy
