// The enumerations' words in the tables.
#ifndef STORAGE_ROW_WORDS_H_
#define STORAGE_ROW_WORDS_H_

#include <string>

#include "absl/status/statusor.h"
#include "homing/flow/observation.h"
#include "storage/journey_store.h"

namespace homing::storage {

std::string Word(Side side);
std::string Word(JourneyState state);
std::string Word(InputKind input);

// DATA_LOSS for any other word.
absl::StatusOr<JourneyState> StateOfWord(const std::string& word);
absl::StatusOr<InputKind> InputOfWord(const std::string& word);

}  // namespace homing::storage

#endif  // STORAGE_ROW_WORDS_H_
