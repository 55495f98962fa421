// Which requests hold images that take long.
#ifndef SERVER_SERVICE_LARGE_IMAGES_H_
#define SERVER_SERVICE_LARGE_IMAGES_H_

#include "homing/v1/homing_service.pb.h"
#include "homing/v1/types.pb.h"

namespace homing::server {

// One of the images has more than a megapixel, or no header that tells. Takes no time that depends
// on the image.
bool HasLargeImage(const v1::Observation& observation);
bool HasLargeImage(const v1::MatchLandmarksRequest& request);

}  // namespace homing::server

#endif  // SERVER_SERVICE_LARGE_IMAGES_H_
