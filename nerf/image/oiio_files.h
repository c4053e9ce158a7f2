#pragma once

#include <OpenImageIO/imageio.h>

#include <filesystem>
#include <memory>

namespace nerf {

// Opens an image with OpenImageIO, which takes what follows a '?' in a file name as arguments of
// its reader and then does not find the file.
//   config   hints for the reader; null: none
//   returns  null if it cannot be opened: OIIO::geterror() says why
std::unique_ptr<OIIO::ImageInput> OpenImageInput(const std::filesystem::path& file,
                                                 const OIIO::ImageSpec* config = nullptr);

// A writer for the format of the file's extension, '?' in the name or not; not yet open. Null if
// the format is unknown: OIIO::geterror() says why.
std::unique_ptr<OIIO::ImageOutput> CreateImageOutput(const std::filesystem::path& file);

// The EXIF orientation, 1 to 8; 1 (upright) if it is missing or invalid.
int OrientationOf(const OIIO::ImageSpec& spec);

}  // namespace nerf
