#include "nerf/image/image_io.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <new>
#include <string>
#include <utility>

#include "nerf/base/input_error.h"
#include "nerf/base/temporary_file.h"
#include "nerf/base/text.h"
#include "nerf/image/oiio_files.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kMaxPixels = 1'000'000'000;
constexpr int kJpegQuality = 95;

void CheckSize(std::int64_t width, std::int64_t height, const fs::path& path) {
  if (width >= 1 && height >= 1 && width * height <= kMaxPixels) return;
  throw InputError("{}: {} x {} pixels; give an image of 1 to 1e9 pixels", path.string(), width,
                   height);
}

std::unique_ptr<OIIO::ImageInput> Open(const fs::path& path) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) throw InputError("{}: no such image", path.string());
  if (!fs::is_regular_file(path, ignored)) {
    throw InputError("{}: not a file, give an image", path.string());
  }
  OIIO::ImageSpec keep_straight_alpha;
  keep_straight_alpha.attribute("oiio:UnassociatedAlpha", 1);
  auto input = OpenImageInput(path, &keep_straight_alpha);
  if (!input) {
    throw InputError("{}: cannot be read as an image: {}", path.string(),
                     FirstLine(OIIO::geterror()));
  }
  const OIIO::ImageSpec& spec = input->spec();
  CheckSize(spec.width, spec.height, path);
  CheckSize(spec.full_width, spec.full_height, path);
  if (spec.depth > 1 || spec.deep) {
    throw InputError("{}: a volume or deep image, give a flat one", path.string());
  }
  return input;
}

enum class Alpha { kStraight, kDropped };

// The indices of the file's channels R, G, B and, where it has one, A.
std::vector<int> PickChannels(const OIIO::ImageSpec& spec, const fs::path& path) {
  const auto named = [&spec](std::string_view name) {
    const auto found = std::ranges::find(spec.channelnames, name);
    return found == spec.channelnames.end() ? -1
                                            : static_cast<int>(found - spec.channelnames.begin());
  };
  const int alpha = named("A") >= 0 ? named("A") : spec.alpha_channel;
  std::vector<int> picked;
  if (named("R") >= 0 && named("G") >= 0 && named("B") >= 0) {
    picked = {named("R"), named("G"), named("B")};
  } else if (spec.nchannels == 1 || (spec.nchannels == 2 && alpha == 1)) {
    picked = {0, 0, 0};
  } else if (spec.nchannels == 3 || (spec.nchannels == 4 && alpha == kAlphaChannel)) {
    picked = {0, 1, 2};
  } else {
    throw InputError("{}: {} channels without the names R, G, B; save it as RGB or RGBA",
                     path.string(), spec.nchannels);
  }
  if (alpha >= 0 && alpha < spec.nchannels && spec.nchannels > 1) picked.push_back(alpha);
  return picked;
}

bool IsLinear(const OIIO::ImageInput& input) {
  return input.spec().format.is_floating_point() || input.format_name() == std::string("openexr");
}

// Reads all channels of the file as float. A truncated file is an error.
std::vector<float> ReadAllChannels(OIIO::ImageInput& input, const fs::path& path) {
  const OIIO::ImageSpec& spec = input.spec();
  std::vector<float> raw(static_cast<std::size_t>(spec.width) * spec.height * spec.nchannels);
  const bool read = input.read_image(0, 0, 0, spec.nchannels, OIIO::TypeFloat, raw.data());
  const bool closed = input.close();
  const std::string complaint = input.geterror();
  // libjpeg fills missing pixels with grey and only warns.
  const bool cut_short = Lowercase(complaint).find("premature end") != std::string::npos;
  if (!read || !closed || cut_short) {
    throw InputError("{}: damaged or truncated: {}", path.string(),
                     complaint.empty() ? "no more pixels" : FirstLine(complaint));
  }
  return raw;
}

// Copies the data window into the display window; pixels outside the data are 0.
Image Gather(const OIIO::ImageSpec& spec, const std::vector<float>& raw,
             const std::vector<int>& channels, ColorEncoding encoding) {
  Image image(spec.full_width, spec.full_height, static_cast<int>(channels.size()), encoding);
  const std::int64_t left = std::int64_t{spec.x} - spec.full_x;
  const std::int64_t top = std::int64_t{spec.y} - spec.full_y;
  const auto overlap = [](std::int64_t shift, int size, int full_size) {
    return std::pair(std::max<std::int64_t>(0, -shift),
                     std::min<std::int64_t>(size, full_size - shift));
  };
  const auto [x_begin, x_end] = overlap(left, spec.width, image.width);
  const auto [y_begin, y_end] = overlap(top, spec.height, image.height);
  for (std::int64_t y = y_begin; y < y_end; ++y) {
    for (std::int64_t x = x_begin; x < x_end; ++x) {
      const float* from = raw.data() + (y * spec.width + x) * spec.nchannels;
      float* to = image.At(static_cast<int>(x + left), static_cast<int>(y + top));
      for (const int channel : channels) *to++ = from[channel];
    }
  }
  return image;
}

void CheckFinite(const Image& image, const fs::path& path) {
  const auto bad = std::ranges::find_if(image.pixels, [](float v) { return !std::isfinite(v); });
  if (bad == image.pixels.end()) return;
  const std::ptrdiff_t pixel = (bad - image.pixels.begin()) / image.channels;
  throw InputError("{}: the value at pixel ({}, {}) is {}, expected a finite number", path.string(),
                   pixel % image.width, pixel / image.width, *bad);
}

void MakeAlphaStraight(Image& image) {
  for (std::size_t i = 0; i < image.pixels.size(); i += image.channels) {
    float* pixel = &image.pixels[i];
    if (pixel[kAlphaChannel] <= 0) continue;
    for (int c = 0; c < kAlphaChannel; ++c) pixel[c] /= pixel[kAlphaChannel];
  }
}

Image Decode(OIIO::ImageInput& input, const fs::path& path, Alpha alpha) {
  const OIIO::ImageSpec spec = input.spec();
  std::vector<int> channels = PickChannels(spec, path);
  if (alpha == Alpha::kDropped) channels.resize(kAlphaChannel);
  const auto encoding = IsLinear(input) ? ColorEncoding::kLinear : ColorEncoding::kSrgb;
  Image image = Gather(spec, ReadAllChannels(input, path), channels, encoding);
  CheckFinite(image, path);
  if (image.channels > kAlphaChannel) {
    if (spec.get_int_attribute("oiio:UnassociatedAlpha", 0) == 0) MakeAlphaStraight(image);
    for (std::size_t i = kAlphaChannel; i < image.pixels.size(); i += image.channels) {
      image.pixels[i] = std::clamp(image.pixels[i], 0.0f, 1.0f);
    }
    CheckFinite(image, path);
  }
  return image;
}

enum class FileFormat { kPng, kJpeg, kExr };

FileFormat FormatOf(const fs::path& path) {
  const std::string extension = Lowercase(path.extension().string());
  if (extension == ".png") return FileFormat::kPng;
  if (extension == ".jpg" || extension == ".jpeg") return FileFormat::kJpeg;
  if (extension == ".exr") return FileFormat::kExr;
  throw InputError("{}: unknown image extension; give .png, .jpg or .exr", path.string());
}

void Encode(const fs::path& path, const fs::path& shown_path, OIIO::ImageSpec spec,
            OIIO::TypeDesc type, const void* pixels) {
  const auto output = CreateImageOutput(path);
  if (!output) {
    throw InputError("{}: cannot be written: {}", shown_path.string(), FirstLine(OIIO::geterror()));
  }
  const bool written = output->open(path.string(), spec) && output->write_image(type, pixels);
  const bool closed = output->close();
  if (!written || !closed) {
    const std::string complaint = FirstLine(output->geterror());
    throw InputError("{}: cannot be written: {}", shown_path.string(),
                     complaint.empty() ? "is the disk full?" : complaint);
  }
}

void EncodeBytes(const fs::path& path, const fs::path& shown_path, const Image& image) {
  const Image srgb = ToSrgb(image);
  std::vector<std::uint8_t> bytes(srgb.pixels.size());
  std::ranges::transform(srgb.pixels, bytes.begin(), ByteFromSrgb);
  OIIO::ImageSpec spec(image.width, image.height, image.channels, OIIO::TypeUInt8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("oiio:UnassociatedAlpha", 1);
  spec.attribute("CompressionQuality", kJpegQuality);
  spec.attribute("jpeg:subsampling", "4:4:4");
  Encode(path, shown_path, spec, OIIO::TypeUInt8, bytes.data());
}

void EncodeRadiance(const fs::path& path, const fs::path& shown_path, const Image& image) {
  Image premultiplied = ToLinear(image);
  if (image.channels > kAlphaChannel) {
    for (std::size_t i = 0; i < premultiplied.pixels.size(); i += image.channels) {
      float* pixel = &premultiplied.pixels[i];
      for (int c = 0; c < kAlphaChannel; ++c) pixel[c] *= pixel[kAlphaChannel];
    }
  }
  OIIO::ImageSpec spec(image.width, image.height, image.channels, OIIO::TypeFloat);
  spec.attribute("oiio:ColorSpace", "Linear");
  spec.attribute("compression", "zip");
  Encode(path, shown_path, spec, OIIO::TypeFloat, premultiplied.pixels.data());
}

Image Read(const fs::path& path, bool upright_by_exif, Alpha alpha) {
  const auto input = Open(path);
  const int orientation = upright_by_exif ? OrientationOf(input->spec()) : 1;
  try {
    return TurnedUpright(Decode(*input, path, alpha), orientation);
  } catch (const std::bad_alloc&) {
    throw InputError("{}: {} x {} pixels do not fit into memory", path.string(),
                     input->spec().width, input->spec().height);
  }
}

}  // namespace

Image ReadImage(const fs::path& path, bool upright_by_exif) {
  return Read(path, upright_by_exif, Alpha::kStraight);
}

Image ReadStoredColors(const fs::path& path, bool upright_by_exif) {
  return Read(path, upright_by_exif, Alpha::kDropped);
}

ImageSize ReadImageHeader(const fs::path& path) {
  const auto input = Open(path);
  const OIIO::ImageSpec& spec = input->spec();
  return {.width = spec.full_width, .height = spec.full_height, .orientation = OrientationOf(spec)};
}

std::optional<ColorEncoding> ReadColorEncoding(const fs::path& path) {
  try {
    return IsLinear(*Open(path)) ? ColorEncoding::kLinear : ColorEncoding::kSrgb;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

void WriteImage(const fs::path& path, const Image& image) {
  const FileFormat format = FormatOf(path);
  CheckFinite(image, path);
  TemporaryFile file(path);
  switch (format) {
    case FileFormat::kPng:
      EncodeBytes(file.path(), path, image);
      break;
    case FileFormat::kJpeg:  // has no alpha
      EncodeBytes(file.path(), path, image.channels > kAlphaChannel ? OnWhite(image) : image);
      break;
    case FileFormat::kExr:
      EncodeRadiance(file.path(), path, image);
      break;
  }
  file.Keep();
}

}  // namespace nerf
