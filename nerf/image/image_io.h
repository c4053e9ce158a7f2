#pragma once

#include <filesystem>
#include <optional>

#include "nerf/image/image.h"
#include "nerf/image/image_convert.h"  // Downscale
#include "nerf/image/srgb.h"

namespace nerf {

// Reads any image that OpenImageIO reads: 8 and 16 bit, float, grey (made RGB), with or without
// alpha (straight, also where the file stores it premultiplied). Integer formats are taken as sRGB
// and scaled to [0,1]; EXR, HDR and other float formats are linear radiance.
//   upright_by_exif  turn the pixels as the EXIF orientation says
//   returns          3 or 4 channels
// Throws InputError naming the file when it is missing, cut short, or holds a non-finite
// value.
Image ReadImage(const std::filesystem::path& path, bool upright_by_exif);

// Width and height as stored, and the EXIF orientation (1..8), without reading the pixels.
struct ImageHeader {
  int width = 0;
  int height = 0;
  int orientation = 1;
};
ImageHeader ReadImageHeader(const std::filesystem::path& path);

// What ReadImage will say of the file's colours, without reading the pixels; nullopt where it is no
// image.
std::optional<ColorEncoding> ReadColorEncoding(const std::filesystem::path& path);

// Writes by the ending of the name: .png and .jpg as 8-bit sRGB (values rounded and clamped; a
// linear image passes through the sRGB transfer), .exr as float linear (an sRGB image is linearised
// first; alpha is premultiplied, as the format asks). 1, 3 or 4 channels. The file appears whole or
// not at all. Throws InputError naming the file (folder missing, disk full, unknown ending).
void WriteImage(const std::filesystem::path& path, const Image& image);

}  // namespace nerf
