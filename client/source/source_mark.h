// A mark that distinguishes the source of one recording from another.
#ifndef CLIENT_SOURCE_SOURCE_MARK_H_
#define CLIENT_SOURCE_SOURCE_MARK_H_

#include <string>

#include "absl/status/statusor.h"
#include "client/source/camera_instants.h"

namespace homing::client {

// The mark of live sources, which never repeat their frames.
inline constexpr char kLiveMark[] = "live";

// A hash of the sources' names (for files and folders, their paths), of the choice of frames and of
// the first frames: 16 hexadecimal digits; or kLiveMark. INVALID_ARGUMENT: they have no usable
// frame.
absl::StatusOr<std::string> MarkOfSource(const std::string& left, const std::string& right,
                                         const FrameChoice& choice, CameraInstants& instants);

// The writer_id of a recording of that source, whose first observation is `base`.
std::string WriterWithMark(const std::string& writer, const std::string& mark, std::int64_t base);

// `base` of Journey.source_mark, if it is of that source; -1: of another, or of none.
std::int64_t BaseOfMark(const std::string& source_mark, const std::string& mark);

}  // namespace homing::client

#endif  // CLIENT_SOURCE_SOURCE_MARK_H_
