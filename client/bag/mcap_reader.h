// MCAP files. Source: the format's public specification (mcap.dev/spec).
#ifndef CLIENT_BAG_MCAP_READER_H_
#define CLIENT_BAG_MCAP_READER_H_

#include <memory>

#include "absl/status/statusor.h"
#include "client/bag/bag.h"
#include "client/bag/bag_file.h"

namespace homing::client::bag {

// REQUIRES: the file begins with kMcapMagic.
absl::StatusOr<std::unique_ptr<Bag>> OpenMcap(BagFile file, const BagLimits& limits);

}  // namespace homing::client::bag

#endif  // CLIENT_BAG_MCAP_READER_H_
