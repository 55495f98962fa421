// FIRST,SECOND: two consecutive frames of one camera named on the command line.
#ifndef CLIENT_COMMAND_IMAGE_PAIR_H_
#define CLIENT_COMMAND_IMAGE_PAIR_H_

#include <string>

#include "absl/status/statusor.h"
#include "client/source/frame_source.h"

namespace homing::client {

struct ImagePair {
  SourceFrame first;
  SourceFrame second;
};

// For CLI11: an error text, empty if the value is valid.
std::string CheckImagePair(const std::string& text);

// INVALID_ARGUMENT, NOT_FOUND.
absl::StatusOr<ImagePair> ReadImagePair(const std::string& text);

}  // namespace homing::client

#endif  // CLIENT_COMMAND_IMAGE_PAIR_H_
