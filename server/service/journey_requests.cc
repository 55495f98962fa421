#include "server/service/journey_requests.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "homing/base/field_error.h"
#include "homing/base/status_macros.h"
#include "homing/localization/aliasing.h"
#include "homing/localization/position_filter.h"
#include "proto/wire/enum_conversion.h"
#include "proto/wire/settings_conversion.h"
#include "server/base/resource_name.h"
#include "server/rpc/page.h"
#include "server/service/message_conversion.h"

namespace homing::server {
namespace {

constexpr int kMaxReaders = 1000;

absl::StatusOr<JourneySettings> DecodeSettings(const v1::JourneySettings& message,
                                               ModelCatalog* models) {
  HOMING_ASSIGN_OR_RETURN(JourneySettings settings,
                          wire::FromProto(message, "journey.settings", JourneySettings()));
  const auto model = models->Get(settings.deviation_model_name);
  constexpr char kModelField[] = "journey.settings.deviation_model";
  HOMING_RETURN_IF_ERROR(FieldOf(model.status()) ? Renamed(model.status(), "name", kModelField)
                                                 : Within(kModelField, model.status()));
  settings.deviation_model = model->model;
  HOMING_RETURN_IF_ERROR(Within("journey.settings", Validate(settings)));
  return settings;
}

v1::Landmark EncodeLandmark(int number, const Landmark& landmark) {
  v1::Landmark message;
  message.set_landmark(number);
  message.set_side(wire::ToProto(landmark.side));
  message.set_first_step(landmark.first_step);
  message.set_last_step(landmark.last_step);
  message.set_fingerprint_count(landmark.fingerprint_count);
  message.set_spread(landmark.spread);
  return message;
}

v1::AnalyzeAliasingResponse EncodeAliasing(const Aliasing& aliasing) {
  v1::AnalyzeAliasingResponse message;
  if (aliasing.median_steps) message.set_median_steps(*aliasing.median_steps);
  if (aliasing.most_steps) message.set_most_steps(*aliasing.most_steps);
  message.set_indistinct_share(aliasing.indistinct_share);
  for (const AliasedPlaces& places : aliasing.aliased_places) {
    v1::Twins* pair = message.add_twins();
    pair->set_first_step(places.first_step);
    pair->set_second_step(places.second_step);
    pair->set_confusion(places.confusion);
  }
  return message;
}

// To the landmarks of the page, in one pass over the steps: an imported landmark may span all.
void AddFingerprints(const JourneyMap& map, v1::ListLandmarksResponse* page) {
  if (page->landmarks().empty()) return;
  std::int64_t end = 0;
  for (const v1::Landmark& landmark : page->landmarks()) {
    end = std::max<std::int64_t>(end, landmark.last_step() + 1);
  }
  // Landmarks are numbered in the order of their first steps.
  const int first = page->landmarks(0).landmark();
  for (std::int64_t step = page->landmarks(0).first_step(); step < end; ++step) {
    for (const Fingerprint& fingerprint : map.fingerprints(step)) {
      const int index = fingerprint.landmark - first;
      if (index < 0 || index >= page->landmarks_size()) continue;
      v1::Landmark* const landmark = page->mutable_landmarks(index);
      landmark->add_steps(step);
      landmark->add_xs(fingerprint.x);
      landmark->add_ys(fingerprint.y);
      landmark->add_counts(fingerprint.count);
    }
  }
}

}  // namespace

absl::StatusOr<std::vector<std::string>> DecodeReaders(
    const google::protobuf::RepeatedPtrField<std::string>& readers, const std::string& field) {
  if (readers.size() > kMaxReaders) {
    return MustBe(field, readers.size(), absl::StrCat("at most ", kMaxReaders, " entries"));
  }
  for (int i = 0; i < readers.size(); ++i) {
    if (readers[i] == "*") continue;
    HOMING_RETURN_IF_ERROR(
        ParseRobotName(readers[i], absl::StrCat(field, "[", i, "]"), false).status());
  }
  return std::vector<std::string>(readers.begin(), readers.end());
}

absl::StatusOr<storage::JourneyRecord> DecodeCreateJourney(const v1::CreateJourneyRequest& request,
                                                           ModelCatalog* models,
                                                           std::int64_t now_ns) {
  HOMING_ASSIGN_OR_RETURN(const std::string robot,
                          ParseRobotName(request.parent(), "parent", false));
  const JourneyName name{robot, request.journey_id()};
  HOMING_RETURN_IF_ERROR(CheckNewJourney(name, "parent", "journey_id"));
  HOMING_RETURN_IF_ERROR(CheckWriterId(request.writer_id(), "writer_id"));
  storage::JourneyRecord record;
  record.name = name.ToString();
  record.writer_id = request.writer_id();
  record.create_time_ns = now_ns;
  HOMING_ASSIGN_OR_RETURN(record.readers,
                          DecodeReaders(request.journey().readers(), "journey.readers"));
  HOMING_ASSIGN_OR_RETURN(record.settings, DecodeSettings(request.journey().settings(), models));
  return record;
}

absl::Status ListJourneyPage(const v1::ListJourneysRequest& request, JourneyCatalog* catalog,
                             const JourneyFilter& filter, v1::ListJourneysResponse* response) {
  HOMING_ASSIGN_OR_RETURN(const std::string robot,
                          ParseRobotName(request.parent(), "parent", true));
  HOMING_ASSIGN_OR_RETURN(const int size, DecodePageSize(request.page_size()));
  HOMING_ASSIGN_OR_RETURN(const std::string after,
                          DecodePageToken(request.parent(), request.page_token()));
  HOMING_ASSIGN_OR_RETURN(std::vector<storage::JourneyRecord> records,
                          catalog->List(robot, after, size + 1, filter));
  if (records.size() > static_cast<std::size_t>(size)) {
    records.pop_back();
    response->set_next_page_token(EncodePageToken(request.parent(), records.back().name));
  }
  for (const storage::JourneyRecord& record : records) {
    *response->add_journeys() = EncodeJourneyRecord(record);
  }
  return absl::OkStatus();
}

absl::Status ListLandmarkPage(const v1::ListLandmarksRequest& request, JourneyCatalog* catalog,
                              v1::ListLandmarksResponse* response) {
  HOMING_ASSIGN_OR_RETURN(const JourneyName name, ParseJourneyName(request.parent(), "parent"));
  HOMING_ASSIGN_OR_RETURN(const int size, DecodePageSize(request.page_size()));
  HOMING_ASSIGN_OR_RETURN(const std::string after,
                          DecodePageToken(request.parent(), request.page_token()));
  HOMING_ASSIGN_OR_RETURN(const std::size_t first, DecodeNumberToken(after));
  HOMING_ASSIGN_OR_RETURN(auto journey, catalog->Open(name.ToString()));
  const LiveJourneys one = {std::move(journey)};
  const MapsLock lock(one);
  const JourneyMap& map = one.front()->map();
  const std::size_t last = std::min(map.landmarks().size(), first + static_cast<std::size_t>(size));
  for (std::size_t i = first; i < last; ++i) {
    *response->add_landmarks() = EncodeLandmark(static_cast<int>(i), map.landmarks()[i]);
  }
  if (request.include_fingerprints()) AddFingerprints(map, response);
  if (last < map.landmarks().size()) {
    response->set_next_page_token(EncodePageToken(request.parent(), absl::StrCat(last)));
  }
  return absl::OkStatus();
}

absl::Status DescribeAliasing(const v1::AnalyzeAliasingRequest& request, JourneyCatalog* catalog,
                              const Cancellation* cancellation,
                              v1::AnalyzeAliasingResponse* response) {
  HOMING_ASSIGN_OR_RETURN(const JourneyName name, ParseJourneyName(request.name(), "name"));
  PositionOptions options;
  if (request.has_tolerance_steps()) options.tolerance_steps = request.tolerance_steps();
  HOMING_RETURN_IF_ERROR(Validate(options));
  HOMING_ASSIGN_OR_RETURN(auto journey, catalog->Open(name.ToString()));
  const LiveJourneys one = {std::move(journey)};
  // A copy, because recording continues meanwhile.
  RouteProfiles profiles;
  {
    const MapsLock lock(one);
    for (const Side side : {Side::kLeft, Side::kRight}) {
      const auto stored = one.front()->map().profiles(side);
      profiles[static_cast<std::size_t>(side)].assign(stored.begin(), stored.end());
    }
  }
  if (profiles[0].empty() && profiles[1].empty()) {
    return absl::FailedPreconditionError(absl::StrCat(
        name.ToString(),
        " has no flow profiles; record it again to learn how well it distinguishes places"));
  }
  *response =
      EncodeAliasing(AnalyzeAliasing(std::move(profiles), options.tolerance_steps, cancellation));
  return CheckAwaited(cancellation);
}

}  // namespace homing::server
