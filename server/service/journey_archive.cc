#include "server/service/journey_archive.h"

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <zlib.h>

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "homing/base/field_error.h"
#include "homing/base/status_macros.h"
#include "homing/landmark/profile_code.h"
#include "homing/v1/journey_map.pb.h"
#include "proto/wire/enum_conversion.h"
#include "proto/wire/message_parts.h"
#include "proto/wire/settings_conversion.h"

namespace homing::server {
namespace {

// One byte follows, the version.
constexpr std::string_view kMagic = "HOMINGJ";
constexpr char kVersion = 2;
// The version without sequences.
constexpr char kVersionBefore = 1;
constexpr std::size_t kHeaderBytes = kMagic.size() + 1;
constexpr std::size_t kChecksumBytes = 4;
// Steps read between two checks for cancellation.
constexpr std::int64_t kStepsBetweenChecks = 10'000;
// Eighteen hours at thirty steps a second. Steps without fingerprints take no room in the file, but
// a hundred bytes each while a robot localises on them.
constexpr std::int64_t kMostImportedSteps = 2'000'000;
// The parts of a file: two flow profiles a step, and the settings.
constexpr int kMostParts = 2 * static_cast<int>(kMostImportedSteps) + 100;

absl::Status Damaged(const std::string& what) {
  return FieldError("chunk", absl::StrCat("journey file: ", what));
}

// CRC-32 as in zlib, least significant byte first.
std::string Checksum(std::string_view bytes) {
  const uLong crc = crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  std::string text;
  for (int shift = 0; shift < 32; shift += 8) {
    text.push_back(static_cast<char>((crc >> shift) & 0xff));
  }
  return text;
}

using Profiles = google::protobuf::RepeatedPtrField<std::string>;

void ProfilesToProto(std::span<const FlowProfile> profiles, Profiles* column) {
  for (const FlowProfile& profile : profiles) {
    *column->Add() = EncodeProfile(profile);
  }
}

v1::JourneyMap MapToProto(const storage::JourneyRecord& record, const JourneyMap& map,
                          char version) {
  v1::JourneyMap message;
  *message.mutable_settings() = wire::ToProto(map.settings());
  wire::FillDeviation(map.settings().deviation_model, message.mutable_deviation());
  message.set_step_count(map.step_count());
  message.set_start_time_ns(record.start_time_ns);
  message.set_end_time_ns(record.end_time_ns);
  for (const Landmark& landmark : map.landmarks()) {
    message.add_landmark_sides(wire::ToProto(landmark.side));
    message.add_landmark_spreads(landmark.spread);
  }
  for (std::int64_t step = 0; step < map.step_count(); ++step) {
    const auto fingerprints = map.fingerprints(step);
    if (version >= 2) message.add_sequences(map.sequence(step));
    message.add_fingerprints_per_step(static_cast<std::uint32_t>(fingerprints.size()));
    for (const Fingerprint& fingerprint : fingerprints) {
      message.add_landmarks(fingerprint.landmark);
      message.add_xs(fingerprint.x);
      message.add_ys(fingerprint.y);
      message.add_counts(fingerprint.count);
    }
  }
  ProfilesToProto(map.profiles(Side::kLeft), message.mutable_left_profiles());
  ProfilesToProto(map.profiles(Side::kRight), message.mutable_right_profiles());
  return message;
}

absl::Status CheckTooLarge(std::size_t size) {
  if (size <= kMaxArchiveBytes) return absl::OkStatus();
  return Damaged(absl::StrCat("is ", size, " bytes: must be at most ", kMaxArchiveBytes));
}

// The message between magic and checksum.
absl::StatusOr<v1::JourneyMap> Unwrap(std::string_view bytes) {
  HOMING_RETURN_IF_ERROR(CheckTooLarge(bytes.size()));
  if (bytes.substr(0, kMagic.size()) != kMagic)
    return Damaged("does not begin with HOMINGJ: it is another kind of file");
  if (bytes.size() < kHeaderBytes + kChecksumBytes) return Damaged("ends too early");
  const char version = bytes[kMagic.size()];
  if (version < kVersionBefore || version > kVersion) {
    return Damaged(absl::StrCat("is of version ", int{version}, ": must be 1 to ", int{kVersion}));
  }
  const std::string_view content = bytes.substr(0, bytes.size() - kChecksumBytes);
  if (Checksum(content) != bytes.substr(content.size())) {
    return Damaged("wrong checksum: the file is truncated or changed");
  }
  v1::JourneyMap message;
  const std::string_view body = content.substr(kHeaderBytes);
  google::protobuf::io::ArrayInputStream counted(body.data(), static_cast<int>(body.size()));
  // An empty profile takes twenty times its size once it is parsed.
  if (wire::CountParts(*message.GetDescriptor(), &counted, kMostParts).value_or(0) > kMostParts) {
    return Damaged(absl::StrCat("has more than ", kMostParts, " profiles"));
  }
  if (!message.ParseFromArray(body.data(), static_cast<int>(body.size()))) {
    return Damaged("content cannot be parsed");
  }
  return message;
}

absl::Status CheckSize(const char* field, std::int64_t size, std::int64_t expected) {
  if (size == expected) return absl::OkStatus();
  return Damaged(absl::StrCat(field, " has ", size, " entries: must have ", expected));
}

// The database does not keep the sign of 0: an export of the imported map would differ from the
// file.
template <typename Column>
absl::Status CheckZeros(const char* field, const Column& values) {
  for (const double value : values) {
    if (value == 0 && std::signbit(value)) {
      return Damaged(absl::StrCat(field, " has -0: must be 0"));
    }
  }
  return absl::OkStatus();
}

absl::Status CheckColumns(const v1::JourneyMap& message, char version) {
  if (message.step_count() < 0 || message.step_count() > kMostImportedSteps) {
    return Damaged(absl::StrCat("step_count is ", message.step_count(), ": must be 0 to ",
                                kMostImportedSteps));
  }
  if (message.start_time_ns() < 0 || message.end_time_ns() < 0) {
    return Damaged("start_time_ns or end_time_ns is negative");
  }
  HOMING_RETURN_IF_ERROR(CheckSize("fingerprints_per_step", message.fingerprints_per_step_size(),
                                   message.step_count()));
  HOMING_RETURN_IF_ERROR(CheckSize("landmark_spreads", message.landmark_spreads_size(),
                                   message.landmark_sides_size()));
  const bool has_sequences = version >= 2;
  HOMING_RETURN_IF_ERROR(
      CheckSize("sequences", message.sequences_size(), has_sequences ? message.step_count() : 0));
  std::int64_t fingerprints = 0;
  for (std::uint32_t of_step : message.fingerprints_per_step()) fingerprints += of_step;
  HOMING_RETURN_IF_ERROR(CheckSize("landmarks", message.landmarks_size(), fingerprints));
  HOMING_RETURN_IF_ERROR(CheckZeros("xs", message.xs()));
  HOMING_RETURN_IF_ERROR(CheckZeros("ys", message.ys()));
  HOMING_RETURN_IF_ERROR(CheckZeros("landmark_spreads", message.landmark_spreads()));
  HOMING_RETURN_IF_ERROR(CheckSize("xs", message.xs_size(), fingerprints));
  HOMING_RETURN_IF_ERROR(CheckSize("ys", message.ys_size(), fingerprints));
  return CheckSize("counts", message.counts_size(), fingerprints);
}

absl::StatusOr<JourneySettings> SettingsOf(const v1::JourneyMap& message) {
  const v1::JourneySettings& settings = message.settings();
  if (!settings.has_left_camera() || !settings.has_right_camera() || !settings.has_flow() ||
      !settings.has_landmark() || !message.has_deviation()) {
    return Damaged("settings are incomplete");
  }
  HOMING_ASSIGN_OR_RETURN(JourneySettings result,
                          wire::FromProto(settings, "settings", JourneySettings()));
  result.deviation_model = wire::DeviationOf(message.deviation());
  HOMING_RETURN_IF_ERROR(Validate(result));
  return result;
}

// Entry `index` of the fingerprint columns. Each step gets the landmark's mean spread: a running
// mean of equal values is that value, to the bit.
absl::StatusOr<RecordedFingerprint> FingerprintAt(const v1::JourneyMap& message, int index) {
  const std::int32_t landmark = message.landmarks(index);
  if (landmark < 0 || landmark >= message.landmark_sides_size()) {
    return Damaged(absl::StrCat("landmarks[", index, "] is ", landmark, ": must be 0 to ",
                                message.landmark_sides_size() - 1));
  }
  RecordedFingerprint recorded;
  HOMING_ASSIGN_OR_RETURN(recorded.side,
                          wire::FromProto(message.landmark_sides(landmark),
                                          absl::StrCat("landmark_sides[", landmark, "]")));
  recorded.spread = message.landmark_spreads(landmark);
  recorded.fingerprint = {message.xs(index), message.ys(index), message.counts(index), landmark};
  return recorded;
}

absl::Status AppendSteps(const v1::JourneyMap& message, const Cancellation* cancellation,
                         JourneyMap& map) {
  int index = 0;
  JourneyStep step;
  for (std::int64_t number = 0; number < message.step_count(); ++number) {
    if (number % kStepsBetweenChecks == 0) HOMING_RETURN_IF_ERROR(CheckAwaited(cancellation));
    step.step = number;
    step.fingerprints.clear();
    if (!message.sequences().empty()) step.sequence = message.sequences(static_cast<int>(number));
    const int end =
        index + static_cast<int>(message.fingerprints_per_step(static_cast<int>(number)));
    for (; index < end; ++index) {
      HOMING_ASSIGN_OR_RETURN(RecordedFingerprint recorded, FingerprintAt(message, index));
      step.fingerprints.push_back(recorded);
    }
    const absl::Status status = map.Append(step);
    if (!status.ok()) return Damaged(std::string(status.message()));
  }
  return CheckSize("landmark_sides", message.landmark_sides_size(),
                   static_cast<std::int64_t>(map.landmarks().size()));
}

absl::Status SetProfiles(const char* field, const Profiles& column, Side side, JourneyMap& map) {
  if (column.empty()) return absl::OkStatus();
  HOMING_RETURN_IF_ERROR(CheckSize(field, column.size(), map.step_count()));
  std::int64_t step = 0;
  for (const std::string& bytes : column) {
    const auto profile = DecodeProfile(bytes);
    if (!profile.ok()) return Damaged(absl::StrCat(field, "[", step, "] is no flow profile"));
    map.set_profile(step++, side, *profile);
  }
  return absl::OkStatus();
}

absl::StatusOr<std::string> EncodeAs(char version, const storage::JourneyRecord& record,
                                     const JourneyMap& map) {
  const v1::JourneyMap message = MapToProto(record, map, version);
  HOMING_RETURN_IF_ERROR(CheckTooLarge(kHeaderBytes + message.ByteSizeLong() + kChecksumBytes));
  std::string bytes(kMagic);
  bytes.push_back(version);
  {
    google::protobuf::io::StringOutputStream stream(&bytes);
    google::protobuf::io::CodedOutputStream coded(&stream);
    coded.SetSerializationDeterministic(true);
    if (!message.SerializeToCodedStream(&coded)) {
      return absl::InternalError("journey file: cannot be written");
    }
  }
  return bytes + Checksum(bytes);
}

}  // namespace

absl::StatusOr<std::string> EncodeJourney(const storage::JourneyRecord& record,
                                          const JourneyMap& map) {
  return EncodeAs(kVersion, record, map);
}

absl::StatusOr<ArchivedJourney> DecodeJourney(std::string_view bytes,
                                              const Cancellation* cancellation) {
  HOMING_ASSIGN_OR_RETURN(const v1::JourneyMap message, Unwrap(bytes));
  const char version = bytes[kMagic.size()];
  HOMING_RETURN_IF_ERROR(CheckColumns(message, version));
  ArchivedJourney journey;
  HOMING_ASSIGN_OR_RETURN(journey.record.settings, SettingsOf(message));
  journey.record.state = storage::JourneyState::kFinished;
  journey.record.start_time_ns = message.start_time_ns();
  journey.record.end_time_ns = message.end_time_ns();
  journey.map = JourneyMap(journey.record.settings);
  HOMING_RETURN_IF_ERROR(AppendSteps(message, cancellation, journey.map));
  HOMING_RETURN_IF_ERROR(
      SetProfiles("left_profiles", message.left_profiles(), Side::kLeft, journey.map));
  HOMING_RETURN_IF_ERROR(
      SetProfiles("right_profiles", message.right_profiles(), Side::kRight, journey.map));
  const std::int64_t steps = journey.map.step_count();
  journey.record.next_sequence = steps == 0 ? 0 : journey.map.sequence(steps - 1) + 1;
  journey.record.resend_from = journey.record.next_sequence;
  // Each map has exactly one file: a file that this program would write differently is refused.
  HOMING_ASSIGN_OR_RETURN(const std::string again, EncodeAs(version, journey.record, journey.map));
  if (again != bytes) return Damaged("has content that this program does not know");
  return journey;
}

}  // namespace homing::server
