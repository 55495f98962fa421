// Two macros that return errors of absl::Status; the abseil of Debian 12 has none.
#ifndef HOMING_BASE_STATUS_MACROS_H_
#define HOMING_BASE_STATUS_MACROS_H_

#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

// Returns from the function if `expression` is not OK.
#define HOMING_RETURN_IF_ERROR(expression)                                  \
  do {                                                                      \
    if (absl::Status homing_status_ = (expression); !homing_status_.ok()) { \
      return homing_status_;                                                \
    }                                                                       \
  } while (false)

#define HOMING_CONCAT_INNER_(a, b) a##b
#define HOMING_CONCAT_(a, b) HOMING_CONCAT_INNER_(a, b)

// `target` = value of `expression`, or returns its error. `target` may declare a variable.
#define HOMING_ASSIGN_OR_RETURN(target, expression) \
  HOMING_ASSIGN_OR_RETURN_(HOMING_CONCAT_(homing_status_or_, __LINE__), target, expression)
#define HOMING_ASSIGN_OR_RETURN_(result, target, expression) \
  auto result = (expression);                                \
  if (!result.ok()) {                                        \
    return std::move(result).status();                       \
  }                                                          \
  target = *std::move(result)

#endif  // HOMING_BASE_STATUS_MACROS_H_
