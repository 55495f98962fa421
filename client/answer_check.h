// What a client does not believe a server.
#ifndef CLIENT_ANSWER_CHECK_H_
#define CLIENT_ANSWER_CHECK_H_

#include <cstdint>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"

namespace homing::client {

// DATA_LOSS: the server names an observation (or the one after the last one that it has) beyond
// `most`. The observations before `sent` were sent.
inline absl::Status CheckAnswer(std::int64_t number, std::int64_t most, std::int64_t sent) {
  if (number >= 0 && number <= most) return absl::OkStatus();
  return absl::DataLossError(absl::StrCat("the server names observation ", number,
                                          ", but only those before ", sent, " were sent"));
}

// The stream ended without an error before all observations had their answers.
inline absl::Status EndedEarly() {
  return absl::UnavailableError("the server ended the stream early");
}

}  // namespace homing::client

#endif  // CLIENT_ANSWER_CHECK_H_
