// Which frames of two cameras belong to one instant.
#ifndef CLIENT_SOURCE_FRAME_PAIRING_H_
#define CLIENT_SOURCE_FRAME_PAIRING_H_

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "client/source/frame_source.h"

namespace homing::client {

struct FramePairing {
  // Index of each camera's frame at each instant, -1: it has none.
  std::vector<std::array<std::int64_t, 2>> instants;
  // Frames of each camera without a partner.
  std::array<std::int64_t, 2> alone{};
  // "time", "number" or "order".
  std::string by;
};

// Pairs by time (the nearest, at most half of the shorter interval between frames apart), else by
// number, else by order. Times and numbers of which less than half have a partner are of no use: by
// order.
FramePairing PairFrames(const FrameKeys& left, std::int64_t left_size, const FrameKeys& right,
                        std::int64_t right_size);

// Indices of the frames that come more than half a second and more than five intervals after the
// frame before them: a recorder stopped, or a part of the file is lost. Empty unless the keys are
// times.
std::vector<std::int64_t> FindHoles(const FrameKeys& keys);

}  // namespace homing::client

#endif  // CLIENT_SOURCE_FRAME_PAIRING_H_
