#include "client/pilot_answer.h"

namespace homing::client {
namespace {

PilotAnswer::Outcome OutcomeOf(v1::Outcome outcome) {
  switch (outcome) {
    case v1::OUTCOME_MATCH:
      return PilotAnswer::Outcome::kMatch;
    case v1::OUTCOME_UNKNOWN_PLACE:
      return PilotAnswer::Outcome::kUnknownPlace;
    default:
      return PilotAnswer::Outcome::kAmbiguous;
  }
}

}  // namespace

PilotAnswer ToPilotAnswer(const v1::LocalizeResponse& answer, double time_s) {
  PilotAnswer result;
  result.sequence = answer.sequence();
  result.time_s = time_s;
  result.outcome = OutcomeOf(answer.outcome());
  result.is_turning = answer.motion() == v1::MOTION_TURNING;
  result.is_standing = answer.motion() == v1::MOTION_STANDING;
  result.probability = answer.probability();
  if (answer.has_progress_home()) result.progress_home = answer.progress_home();
  if (answer.has_speed_ratio()) result.speed_ratio = answer.speed_ratio();
  if (answer.has_turn()) result.turn = answer.turn();
  if (answer.has_path_offset()) result.path_offset = answer.path_offset();
  return result;
}

}  // namespace homing::client
