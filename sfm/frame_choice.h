#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace nerf::sfm {

// How sharp a picture is: the variance of its Laplacian (Pech-Pacheco et al. 2000). Comparable
// between pictures of one scene only.
//   grey  [height][width], 0 to 255
double Sharpness(std::span<const std::uint8_t> grey, int width, int height);

// The frames of a film to use, ascending: the film is divided into `count` parts of equal length,
// and the sharpest frame of each is taken, unless it is blurred: less than a quarter as sharp as
// the median of the frames that were taken around it. Where there are fewer frames than parts, all
// that are not blurred.
//   sharpness  of frames at equal distances in time
std::vector<int> ChooseFrames(std::span<const double> sharpness, int count);

// How many frames of a film to use: three a second, 40 to 150.
int DefaultFrameCount(double seconds);

}  // namespace nerf::sfm
