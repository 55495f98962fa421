// Grey images as PNG files.
#ifndef CLIENT_PNG_FILE_H_
#define CLIENT_PNG_FILE_H_

#include <string>

#include "absl/status/status.h"
#include "client/source/frame_source.h"

namespace homing::client {

// REQUIRES: a GRAY8 frame of its width and height. PERMISSION_DENIED: the file cannot be created;
// INTERNAL: it cannot be written.
absl::Status WritePng(const std::string& path, const SourceFrame& gray);

}  // namespace homing::client

#endif  // CLIENT_PNG_FILE_H_
