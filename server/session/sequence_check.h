// The errors of an observation's number, for recording and localising.
#ifndef SERVER_SESSION_SEQUENCE_CHECK_H_
#define SERVER_SESSION_SEQUENCE_CHECK_H_

#include <cstdint>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "homing/base/field_error.h"
#include "server/base/error_reason.h"

namespace homing::server {

// INVALID_ARGUMENT: negative.
inline absl::Status CheckSequenceNumber(std::int64_t sequence) {
  return sequence < 0 ? MustBe("observation.sequence", sequence, "at least 0") : absl::OkStatus();
}

// OUT_OF_RANGE with the reason SEQUENCE_GAP and the expected number.
inline absl::Status SequenceGapError(std::int64_t sequence, std::int64_t expected) {
  return WithReason(absl::OutOfRangeError(
                        absl::StrCat("observation.sequence: ", sequence, " must be ", expected)),
                    {"SEQUENCE_GAP", {{"due", absl::StrCat(expected)}}});
}

}  // namespace homing::server

#endif  // SERVER_SESSION_SEQUENCE_CHECK_H_
