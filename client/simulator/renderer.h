// Brightness of every pixel of a view, before exposure and noise.
#ifndef CLIENT_SIMULATOR_RENDERER_H_
#define CLIENT_SIMULATOR_RENDERER_H_

#include <vector>

#include "client/simulator/view.h"

namespace homing::client {

// Grey levels, row by row. Textures are blurred to the size of a pixel on the surface; pixels at
// the edge between surfaces are the mean of 2 x 2 rays.
std::vector<float> RenderBrightness(const View& view, const SurfaceMap& map);

}  // namespace homing::client

#endif  // CLIENT_SIMULATOR_RENDERER_H_
