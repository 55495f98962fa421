// Judges whether a recorded map can be localised on.
#ifndef CLIENT_MAP_QUALITY_H_
#define CLIENT_MAP_QUALITY_H_

#include <string>

#include "homing/v1/journey_service.pb.h"

namespace homing::client {

struct MapQuality {
  // Judges by the counts of steps and fingerprints.
  explicit MapQuality(const v1::Journey& journey);

  bool good = true;
  // Why it is poor and what to do; empty for a good one.
  std::string reason;

  // "GOOD", "POOR: ...".
  std::string Text() const;
};

}  // namespace homing::client

#endif  // CLIENT_MAP_QUALITY_H_
