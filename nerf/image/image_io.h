#pragma once

#include <filesystem>
#include <optional>

#include "nerf/image/image.h"
#include "nerf/image/image_convert.h"  // Downscale
#include "nerf/image/image_size.h"
#include "nerf/image/srgb.h"

namespace nerf {

// Reads any image that OpenImageIO reads: 8 and 16 bit, float, grey (converted to RGB), with or
// without alpha (straight, also where the file stores it premultiplied). Integer formats are taken
// as sRGB and scaled to [0,1]; EXR, HDR and other float formats are linear radiance.
//   upright_by_exif  rotate the pixels by the EXIF orientation
//   returns          3 or 4 channels
// Throws InputError naming the file when it is missing, truncated, or contains a non-finite value.
Image ReadImage(const std::filesystem::path& path, bool upright_by_exif);

// The same without alpha: 3 channels, colours as the file stores them, premultiplied or not.
Image ReadStoredColors(const std::filesystem::path& path, bool upright_by_exif);

// Reads only the header. Throws InputError as ReadImage does.
ImageSize ReadImageHeader(const std::filesystem::path& path);

// The encoding that ReadImage would return, without reading the pixels; nullopt where the file is
// no image.
std::optional<ColorEncoding> ReadColorEncoding(const std::filesystem::path& path);

// Writes an image of 1, 3 or 4 channels in the format of the file's extension: .png and .jpg as
// 8-bit sRGB (clamped and rounded; a linear image is converted to sRGB first), .exr as linear float
// (an sRGB image is converted to linear first; alpha is premultiplied, as the format requires).
// Writes atomically. Throws InputError naming the file (folder missing, disk full, unknown
// extension).
void WriteImage(const std::filesystem::path& path, const Image& image);

}  // namespace nerf
