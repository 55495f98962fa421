// Writes the first inputs of each fuzz target: fuzz_seeds FOLDER. The others were found by fuzzing.
#include <turbojpeg.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <vector>

#include "homing/journey/journey_recorder.h"
#include "homing/v1/deviation_model_service.pb.h"
#include "homing/v1/homing_service.pb.h"
#include "homing/v1/journey_service.pb.h"
#include "proto/wire/observation_conversion.h"
#include "server/config/option_table.h"
#include "server/config/server_options.h"
#include "server/service/journey_archive.h"
#include "tests/server/compressed_images.h"
#include "tests/support/route.h"

namespace homing::fuzz {
namespace {

constexpr char kJourney[] = "robots/r/journeys/a";

void Write(const std::string& folder, const std::string& name, const std::string& bytes) {
  std::filesystem::create_directories(folder);
  std::ofstream(folder + "/" + name, std::ios::binary) << bytes;
}

template <typename Number>
std::string Bytes(Number number) {
  return {reinterpret_cast<const char*>(&number), sizeof(number)};
}

void MakeImages(const std::string& folder) {
  const auto head = [](char encoding, int width, int height) {
    return encoding + Bytes(static_cast<std::int16_t>(width)) +
           Bytes(static_cast<std::int16_t>(height));
  };
  Write(folder, "gray", head(0, 16, 16) + std::string(256, 'g'));
  Write(folder, "rgb", head(1, 16, 16) + std::string(768, 'g'));
  Write(folder, "jpeg", head(3, 0, 0) + server::Jpeg());
  Write(folder, "png", head(4, 0, 0) + server::PngThatClaims(32, 32));
}

void MakeFlow(const std::string& folder) {
  std::string bytes;
  for (int i = 0; i < 12; ++i) {
    bytes += static_cast<char>(3);
    for (const Side side : {Side::kLeft, Side::kRight}) {
      const FlowField field = test::FieldAt(i, side);
      const std::size_t count = std::min<std::size_t>(field.vectors.size(), 20);
      bytes += static_cast<char>(count);
      for (std::size_t n = 0; n < count; ++n) {
        const FlowVector& v = field.vectors[n];
        bytes += Bytes(v.start_x) + Bytes(v.start_y) + Bytes(v.end_x) + Bytes(v.end_y);
      }
    }
  }
  Write(folder, "route", bytes);
  Write(folder, "odd_size", std::string("\x09\x10\x00\x10\x00\x01", 6) + std::string(16, '\0'));
}

std::string Archive() {
  JourneyRecorder recorder{JourneySettings{}};
  JourneyMap map;
  for (int i = 0; i < 8; ++i) {
    const auto step = recorder.Record(test::FlowAt(i));
    if (step.ok() && *step) map.Append(**step).IgnoreError();
  }
  map.mutable_settings() = recorder.settings();
  return server::EncodeJourney({}, map).value_or("");
}

void MakeImports(const std::string& folder) {
  const std::string file = Archive();
  Write(folder, "whole", std::string(1, '\0') + file);
  // The even byte stands for version 2.
  Write(folder, "message", "n" + file.substr(8, file.size() - 12));
}

// The RPC and its messages, as request_fuzz.cc takes them.
template <typename... Messages>
std::string Call(int method, const Messages&... messages) {
  std::string bytes(1, static_cast<char>(method));
  const auto add = [&bytes](const std::string& message) {
    bytes += Bytes(static_cast<std::uint16_t>(message.size())) + message;
  };
  (add(messages.SerializeAsString()), ...);
  return bytes;
}

void MakeRecordings(const std::string& folder) {
  v1::RecordJourneyRequest config;
  config.mutable_config()->set_journey(kJourney);
  config.mutable_config()->set_writer_id("w");
  v1::RecordJourneyRequest observation;
  *observation.mutable_observation() = wire::ToProto(test::FlowAt(20));
  Write(folder, "record", Call(5, config, observation));
  v1::LocalizeRequest begin;
  begin.mutable_config()->set_journey("robots/-/journeys/-");
  begin.mutable_config()->set_travel(v1::TRAVEL_SAME);
  v1::LocalizeRequest seen;
  *seen.mutable_observation() = wire::ToProto(test::FlowAt(3));
  v1::LocalizeRequest next;
  *next.mutable_observation() = wire::ToProto(test::FlowAt(4));
  Write(folder, "localize", Call(11, begin, seen, next));
  v1::ImportJourneyRequest name;
  name.set_name("robots/r/journeys/c");
  v1::ImportJourneyRequest chunk;
  chunk.set_chunk(Archive());
  Write(folder, "import", Call(9, name, chunk));
}

void MakeRequests(const std::string& folder) {
  v1::CreateJourneyRequest create;
  create.set_parent("robots/r");
  create.set_journey_id("d");
  create.mutable_journey()->mutable_settings()->mutable_left_camera()->set_width(320);
  Write(folder, "create", Call(0, create));
  v1::GetJourneyRequest get;
  get.set_name(kJourney);
  // Get, delete and export have their name in the same place.
  for (const int method : {1, 3, 7, 8}) {
    Write(folder, "name_" + std::to_string(method), Call(method, get));
  }
  v1::ListJourneysRequest list;
  list.set_parent("robots/-");
  Write(folder, "list", Call(2, list));
  v1::ListLandmarksRequest landmarks;
  landmarks.set_parent(kJourney);
  landmarks.set_include_fingerprints(true);
  Write(folder, "landmarks", Call(6, landmarks));
  v1::MatchLandmarksRequest match;
  match.set_journey(kJourney);
  *match.mutable_left()->mutable_flow_vectors() = wire::ToProto(test::FieldAt(3, Side::kLeft));
  Write(folder, "match", Call(10, match));
  v1::TrainDeviationModelRequest train;
  Write(folder, "train", Call(12, train));
  MakeRecordings(folder);
}

void MakeDatabases(const std::string& folder) {
  Write(folder, "good", std::string("\x01\x00\x00", 3));
  Write(folder, "cut", std::string("\x01\x00\x80", 3));
  Write(folder, "changed", std::string("\x01\x00\x00\x40\x30\x00\xff\x80\x51\x01\x00", 11));
}

void MakeConfigs(const std::string& folder) {
  Write(folder, "file", "\n" + server::ToToml({}));
  Write(folder, "flags",
        "--listen\n127.0.0.1:0\n--max-message\n1MiB\n--check-config\n\nworkers = 2\n");
  Write(folder, "doctor", "doctor\na.db\n--salvage\nb.db\n\n");
}

}  // namespace
}  // namespace homing::fuzz

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: fuzz_seeds FOLDER\n";
    return 2;
  }
  const std::string folder = argv[1];
  homing::fuzz::MakeImages(folder + "/image");
  homing::fuzz::MakeFlow(folder + "/flow");
  homing::fuzz::MakeImports(folder + "/import");
  homing::fuzz::MakeRequests(folder + "/request");
  homing::fuzz::MakeDatabases(folder + "/database");
  homing::fuzz::MakeConfigs(folder + "/config");
  return 0;
}
