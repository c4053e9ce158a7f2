#pragma once

#include <string>
#include <vector>

#include "nerf/scene/posed_images.h"

namespace nerf {

// A file name without extension for each image, for pictures made of it: the name of the image
// without extension and with '_' between folders ("train/r_0.png" -> "train_r_0", "../images/1.jpg"
// -> "images_1"). Images whose names would be the same, also on a file system that ignores case,
// keep their extension ("0001_jpg", "0001_png"), and are numbered if that is not enough.
std::vector<std::string> OutputNames(const std::vector<PosedImage>& images);

}  // namespace nerf
