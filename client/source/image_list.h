// Text lists of image files with their times, as data sets have them.
#ifndef CLIENT_SOURCE_IMAGE_LIST_H_
#define CLIENT_SOURCE_IMAGE_LIST_H_

#include <string>

#include "absl/status/statusor.h"
#include "client/source/image_folder.h"

namespace homing::client {

// Whether the name is that of a list: .txt, .csv, .lst.
bool HasListEnding(const std::string& path);

// One image a line: a time and a file, in either order, with a comma or spaces between; empty
// lines, lines that begin with # and one line of headings are left out. A time is in seconds, or a
// whole number of at least 12 digits in milliseconds, microseconds or nanoseconds. Files are
// relative to the list's folder, or to its folder data/. INVALID_ARGUMENT names the line: no time,
// no file, or a time that is not after the one before. NOT_FOUND.
absl::StatusOr<ImageList> ReadImageList(const std::string& path);

}  // namespace homing::client

#endif  // CLIENT_SOURCE_IMAGE_LIST_H_
