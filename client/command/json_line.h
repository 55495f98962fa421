// Answers as the objects that --json prints. Their keys and order are fixed.
#ifndef CLIENT_COMMAND_JSON_LINE_H_
#define CLIENT_COMMAND_JSON_LINE_H_

#include <nlohmann/json.hpp>
#include <string>

#include "homing/v1/deviation_model_service.pb.h"
#include "homing/v1/homing_service.pb.h"
#include "homing/v1/journey_service.pb.h"

namespace homing::client {

using Json = nlohmann::ordered_json;

// LEFT, RIGHT.
std::string Word(v1::Side side);
// MOVING (also if nothing could be compared), STANDING, TURNING.
std::string Word(v1::Motion motion);
// MATCH, AMBIGUOUS, UNKNOWN_PLACE.
std::string Word(v1::Outcome outcome);
// HOMEWARD, OUTWARD, UNKNOWN.
std::string Word(v1::Direction direction);
// ACTIVE, FINISHED.
std::string Word(v1::Journey::State state);
// ACROSS, ALONG, MIXED, UNKNOWN.
std::string Word(v1::CameraDirection direction);

Json ToJson(const v1::RecordJourneyResponse& answer);
Json ToJson(const v1::LocalizeResponse& answer);
Json ToJson(const v1::MatchLandmarksResponse& answer);
Json ToJson(const v1::Match& match);
// The journey without its settings.
Json ToJson(const v1::Journey& journey);
Json ToJson(const v1::JourneySettings& settings);
Json ToJson(const v1::Landmark& landmark);
Json ToJson(const v1::DeviationModel& model);
Json ToJson(const std::string& journey, const v1::AnalyzeAliasingResponse& report);

}  // namespace homing::client

#endif  // CLIENT_COMMAND_JSON_LINE_H_
