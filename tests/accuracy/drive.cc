#include "tests/accuracy/drive.h"

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <opencv2/imgproc.hpp>

#include "absl/strings/str_cat.h"
#include "client/simulator/frame_schedule.h"
#include "client/simulator/simulation_spec.h"
#include "client/source/image_folder.h"
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
    observation.sequence = static_cast<std::int64_t>(drive_.size());
    const auto reference = flow_.reference_sequence();
    auto flow = flow_.Compute(observation);
    if (!flow.ok()) Fail(std::string(flow.status().message()));
    Instant instant;
    instant.frame = static_cast<std::int64_t>(drive_.size());
    instant.flow = *std::move(flow);
    if (!instant.flow.makes_step) instant.flow.fields = {};
    for (std::size_t side = 0; side < images.size(); ++side) {
      if (instant.flow.fields[side]) instant.pictures[side] = PictureOf(images[side]);
    }
    instant.reference = std::max<std::int64_t>(0, reference);
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
  const auto frame = client::ReadImage(file);
  if (!frame.ok()) Fail(std::string(frame.status().message()));
  auto image = DecodeGray(frame->view());
  if (!image.ok()) Fail(file + ": " + std::string(image.status().message()));
  if (size.empty() || image->size() == size) return image->clone();
  cv::Mat resized;
  cv::resize(*image, resized, size, 0, 0, cv::INTER_AREA);
  return resized;
}

client::SimulationSpec Parsed(const std::string& text) {
  const auto spec = client::ParseSimulationSpec(text);
  if (!spec.ok()) Fail(std::string(spec.status().message()));
  return *spec;
}

// The frames that the cameras take, all of which arrive.
std::unique_ptr<client::Simulator> CamerasOf(client::SimulationSpec spec) {
  const std::uint64_t drive_seed = DriveSeed(spec);
  spec.repeat = 0;
  spec.drop = 0;
  spec.drop_run = 0;
  if (DriveSeed(spec) != drive_seed) Fail("lost and repeated frames need the key drive");
  auto simulator = client::Simulator::Create(spec);
  if (!simulator.ok()) Fail(std::string(simulator.status().message()));
  return *std::move(simulator);
}

// What arrives of the frames that are taken.
class Arrivals {
 public:
  Arrivals(const client::SimulationSpec& spec, std::int64_t taken) : schedule_(spec, taken) {}

  // REQUIRES: frames are given in order.
  void Take(std::int64_t taken, const Images& images, double place) {
    Images given = images;
    for (const Side camera : {Side::kLeft, Side::kRight}) {
      if (schedule_.IsAbsent(taken, camera)) given[static_cast<std::size_t>(camera)] = cv::Mat();
    }
    while (next_ < schedule_.frame_count() && schedule_.TakenAt(next_) <= taken) {
      if (schedule_.TakenAt(next_++) == taken) maker_.Add(given, place);
    }
  }

  Drive Finish() { return maker_.Take(); }

 private:
  client::FrameSchedule schedule_;
  std::int64_t next_ = 0;
  Maker maker_;
};

// In the order of `specs`.
std::vector<Drive> Simulate(const std::vector<SimulatedDriveSpec>& specs) {
  const SimulatedDriveSpec& first = specs.front();
  const auto cameras = CamerasOf(Parsed(first.spec));
  const std::int64_t frames = cameras->frame_count();
  std::vector<Arrivals> arrivals;
  for (const SimulatedDriveSpec& spec : specs) arrivals.emplace_back(Parsed(spec.spec), frames);
  const double end = cameras->RouteMetres(frames - 1);
  for (std::int64_t i = 0; i < frames; ++i) {
    const double place = cameras->RouteMetres(i);
    if (first.tail_m > 0 && std::abs(end - place) > first.tail_m) continue;
    Images images = {cameras->RenderCamera(i, Side::kLeft), cv::Mat()};
    if (first.both_cameras) images[1] = cameras->RenderCamera(i, Side::kRight);
    for (Arrivals& each : arrivals) each.Take(i, images, place);
  }
  std::vector<Drive> drives;
  for (Arrivals& each : arrivals) drives.push_back(each.Finish());
  return drives;
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

std::string SimulatedDriveSpec::Name() const {
  return absl::StrCat(spec.substr(4), both_cameras ? "" : " left",
                      tail_m > 0 ? absl::StrCat(" last ", tail_m) : "");
}

std::vector<Drive> SimulatedDrives(const std::vector<SimulatedDriveSpec>& specs,
                                   const std::string& cache) {
  const DriveCache kept(cache);
  std::vector<Drive> drives;
  for (const SimulatedDriveSpec& spec : specs) {
    if (auto drive = kept.Read(spec.Name())) drives.push_back(*std::move(drive));
  }
  if (drives.size() == specs.size()) return drives;
  drives = Simulate(specs);
  for (std::size_t i = 0; i < specs.size(); ++i) kept.Write(specs[i].Name(), drives[i]);
  return drives;
}

}  // namespace homing::accuracy
