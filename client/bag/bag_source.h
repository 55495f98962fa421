// Frames of one camera from a bag.
#ifndef CLIENT_BAG_BAG_SOURCE_H_
#define CLIENT_BAG_BAG_SOURCE_H_

#include <memory>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "client/bag/bag.h"
#include "client/source/frame_source.h"

namespace homing::client::bag {

struct BagName {
  std::string path;
  // Empty: ChooseImageTopic selects one.
  std::string topic;
};

// FILE.mcap[#TOPIC], FILE.bag[#TOPIC], FILE.db3[#TOPIC], mcap:FILE[#TOPIC]; nothing for another
// text.
std::optional<BagName> ParseBagName(const std::string& source);

// NOT_FOUND, PERMISSION_DENIED; INVALID_ARGUMENT: no bag, or the topic is not clear.
absl::StatusOr<std::unique_ptr<FrameSource>> OpenBagSource(const BagName& name, Side camera,
                                                           const BagLimits& limits = {});

}  // namespace homing::client::bag

#endif  // CLIENT_BAG_BAG_SOURCE_H_
