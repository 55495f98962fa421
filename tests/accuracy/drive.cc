#include "tests/accuracy/drive.h"

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <opencv2/imgproc.hpp>

#include "client/frame_source.h"
#include "homing/image/frame.h"
#include "tests/accuracy/drive_cache.h"

namespace homing::accuracy {
namespace {

using Images = std::array<cv::Mat, 2>;

Picture PictureOf(const cv::Mat& gray) {
  cv::Mat small;
  cv::resize(gray, small, {kPictureWidth, kPictureHeight}, 0, 0, cv::INTER_AREA);
  return {small.begin<std::uint8_t>(), small.end<std::uint8_t>()};
}

// The frame that the flow of `frame` was tracked from.
std::int64_t ReferenceOf(const ObservedFlow& /*flow*/, std::int64_t frame) { return frame - 1; }

// Frames in, instants out.
class Maker {
 public:
  // An empty image: that camera is absent.
  void Add(const Images& images, double place) {
    Observation observation;
    for (std::size_t side = 0; side < images.size(); ++side) {
      const cv::Mat& image = images[side];
      if (image.empty()) continue;
      observation.views[side] = Frame{
          FrameEncoding::kGray8,
          image.cols,
          image.rows,
          {reinterpret_cast<const char*>(image.data), static_cast<std::size_t>(image.total())}};
    }
    auto flow = flow_.Compute(observation);
    if (!flow.ok()) Fail(std::string(flow.status().message()));
    Instant instant;
    instant.frame = static_cast<std::int64_t>(drive_.size());
    instant.flow = *std::move(flow);
    for (std::size_t side = 0; side < images.size(); ++side) {
      if (instant.flow.fields[side]) instant.pictures[side] = PictureOf(images[side]);
    }
    instant.reference = std::max<std::int64_t>(
        0, instant.MakesStep() ? ReferenceOf(instant.flow, instant.frame) : instant.frame - 1);
    places_.push_back(place);
    drive_.push_back(std::move(instant));
  }

  Drive Take();

 private:
  ObservationFlow flow_{FlowOptions()};
  std::vector<double> places_;
  Drive drive_;
};

void SetPlaces(const std::vector<double>& places, Drive& drive) {
  for (Instant& instant : drive) {
    instant.place = 0.5 * (places.at(static_cast<std::size_t>(instant.reference)) +
                           places.at(static_cast<std::size_t>(instant.frame)));
  }
}

Drive Maker::Take() {
  SetPlaces(places_, drive_);
  return std::move(drive_);
}

cv::Mat ReadImage(const std::string& file, const cv::Size& size) {
  auto source = client::OpenFrameSource(file, Side::kLeft);
  if (!source.ok()) Fail(std::string(source.status().message()));
  auto frame = (*source)->Next();
  if (!frame.ok() || !*frame) Fail("cannot read " + file);
  auto image = DecodeGray((*frame)->view());
  if (!image.ok()) Fail(file + ": " + std::string(image.status().message()));
  if (size.empty() || image->size() == size) return image->clone();
  cv::Mat resized;
  cv::resize(*image, resized, size, 0, 0, cv::INTER_AREA);
  return resized;
}

std::unique_ptr<client::Simulator> SimulatorOf(const std::string& spec) {
  const auto parsed = client::ParseSimulationSpec(spec);
  if (!parsed.ok()) Fail(std::string(parsed.status().message()));
  auto simulator = client::Simulator::Create(*parsed);
  if (!simulator.ok()) Fail(std::string(simulator.status().message()));
  return *std::move(simulator);
}

}  // namespace

void Fail(const std::string& reason) {
  std::cerr << "accuracy: " << reason << "\n";
  std::exit(1);
}

std::vector<const Instant*> StepsOf(const Drive& drive) {
  std::vector<const Instant*> steps;
  for (const Instant& instant : drive) {
    if (instant.MakesStep()) steps.push_back(&instant);
  }
  return steps;
}

double StepLength(const Drive& drive) {
  const auto steps = StepsOf(drive);
  return std::abs(steps.back()->place - steps.front()->place) /
         static_cast<double>(steps.size() - 1);
}

cv::Size ImageSizeOf(const std::string& file) { return ReadImage(file, {}).size(); }

Drive DriveOfFiles(const ImageFiles& images, const std::string& cache) {
  const DriveCache kept(cache);
  if (auto drive = kept.Read(images.name)) {
    SetPlaces(images.places, *drive);
    return *std::move(drive);
  }
  Maker maker;
  for (std::size_t i = 0; i < images.files.size(); ++i) {
    maker.Add({ReadImage(images.files[i], images.size), cv::Mat()}, images.places[i]);
  }
  Drive drive = maker.Take();
  kept.Write(images.name, drive);
  return drive;
}

std::vector<Drive> SimulatedDrives(const std::vector<std::string>& specs,
                                   const std::string& cache) {
  const DriveCache kept(cache);
  std::vector<Drive> drives;
  for (const std::string& spec : specs) {
    if (auto drive = kept.Read(spec.substr(4))) {
      drives.push_back(*std::move(drive));
      continue;
    }
    const auto simulator = SimulatorOf(spec);
    Maker maker;
    for (std::int64_t i = 0; i < simulator->frame_count(); ++i) {
      maker.Add({simulator->RenderCamera(i, Side::kLeft), simulator->RenderCamera(i, Side::kRight)},
                simulator->RouteMetres(i));
    }
    drives.push_back(maker.Take());
    kept.Write(spec.substr(4), drives.back());
  }
  return drives;
}

}  // namespace homing::accuracy
