#include "storage/row_words.h"

#include "absl/strings/str_cat.h"

namespace homing::storage {
namespace {

absl::Status UnknownWord(const char* column, const std::string& word) {
  return absl::DataLossError(
      absl::StrCat("store: ", column, " has the unknown value '", word, "'"));
}

}  // namespace

std::string Word(Side side) { return side == Side::kLeft ? "LEFT" : "RIGHT"; }

std::string Word(JourneyState state) {
  return state == JourneyState::kActive ? "ACTIVE" : "FINISHED";
}

std::string Word(InputKind input) {
  switch (input) {
    case InputKind::kFrames:
      return "FRAMES";
    case InputKind::kFlowVectors:
      return "FLOW_VECTORS";
    case InputKind::kUnknown:
      break;
  }
  return "UNKNOWN";
}

absl::StatusOr<JourneyState> StateOfWord(const std::string& word) {
  if (word == "ACTIVE") return JourneyState::kActive;
  if (word == "FINISHED") return JourneyState::kFinished;
  return UnknownWord("state", word);
}

absl::StatusOr<InputKind> InputOfWord(const std::string& word) {
  for (InputKind input : {InputKind::kUnknown, InputKind::kFrames, InputKind::kFlowVectors}) {
    if (word == Word(input)) return input;
  }
  return UnknownWord("input", word);
}

}  // namespace homing::storage
