#include "sfm/colmap_images.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "nerf/base/input_error.h"
#include "nerf/base/parallel.h"
#include "nerf/base/quantile.h"
#include "nerf/image/oiio_files.h"

namespace nerf::sfm {
namespace {

namespace fs = std::filesystem;

bool ColmapCanUse(const Photo& photo) {
  const bool format_known =
      photo.format == "jpeg" || photo.format == "png" || photo.format == "bmp";
  return format_known && photo.eight_bit && photo.orientation == 1 && !photo.cropped_after_exif;
}

// Scales linear radiance of any unit to the range of a photograph and applies the sRGB transfer.
void ExposeAndEncode(OIIO::ImageBuf& linear) {
  const OIIO::ImageSpec& spec = linear.spec();
  std::vector<float> values(static_cast<std::size_t>(spec.width) * spec.height * spec.nchannels);
  linear.get_pixels(linear.roi(), OIIO::TypeFloat, values.data());
  for (float& value : values) value = std::isfinite(value) ? std::max(value, 0.0f) : 0.0f;
  const float bright = ValueOfRank(std::vector(values), values.size() * 99 / 100);
  const float scale = bright > 0 ? 1 / bright : 1.0f;
  for (float& value : values) {
    const float x = std::min(value * scale, 1.0f);
    value = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
  }
  linear.set_pixels(linear.roi(), OIIO::TypeFloat, values.data());
}

// Rotates by the EXIF orientation. Not ImageBufAlgo::reorient, which in OpenImageIO 2.4 handles
// orientation 5 as 7.
OIIO::ImageBuf Upright(const OIIO::ImageBuf& stored, int orientation) {
  namespace algo = OIIO::ImageBufAlgo;
  switch (orientation) {
    case 2:
      return algo::flop(stored);
    case 3:
      return algo::rotate180(stored);
    case 4:
      return algo::flip(stored);
    case 5:
      return algo::transpose(stored);
    case 6:
      return algo::rotate90(stored);
    case 7:
      return algo::rotate180(algo::transpose(stored));
    case 8:
      return algo::rotate270(stored);
    default:
      return stored;
  }
}

void WriteConverted(const Photo& photo, const fs::path& target) {
  const auto input = OpenImageInput(photo.path);
  if (!input) throw InputError("{}: {}", photo.path.string(), OIIO::geterror());
  OIIO::ImageSpec spec = input->spec();
  const bool linear = spec.format.is_floating_point();
  spec.set_format(OIIO::TypeFloat);
  if (photo.cropped_after_exif) {
    spec.erase_attribute("Exif:.*");
    spec.erase_attribute("FocalLength");
  }
  OIIO::ImageBuf source(spec);
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeFloat, source.localpixels())) {
    throw InputError("{}: {}", photo.path.string(), input->geterror());
  }
  const std::vector<int> channels = source.nchannels() >= 3 ? std::vector{0, 1, 2} : std::vector{0};
  OIIO::ImageBuf image =
      OIIO::ImageBufAlgo::channels(source, static_cast<int>(channels.size()), channels);
  if (linear) ExposeAndEncode(image);
  if (image.roi() != image.roi_full()) image = OIIO::ImageBufAlgo::cut(image, image.roi_full());
  image = Upright(image, photo.orientation);
  image.specmod().attribute("Orientation", 1);
  image.specmod().attribute("CompressionQuality", 95);
  image.specmod().attribute("oiio:ColorSpace", "sRGB");
  const auto output = CreateImageOutput(target);
  OIIO::ImageSpec bytes = image.spec();
  bytes.set_format(OIIO::TypeUInt8);
  if (image.has_error() || !output || !output->open(target.string(), bytes) ||
      !image.write(output.get()) || !output->close()) {
    throw InputError("{}: cannot be written: {}", target.string(),
                     image.has_error() ? image.geterror() : OIIO::geterror());
  }
}

void LinkOrCopy(const Photo& photo, const fs::path& target, PhotoLinks links) {
  std::error_code error;
  if (links == PhotoLinks::kSymbolic) {
    fs::create_symlink(photo.path, target, error);
  } else {
    fs::create_hard_link(fs::canonical(photo.path, error), target, error);
  }
  if (error) fs::copy_file(photo.path, target, error);
  if (error) throw InputError("{}: cannot be written: {}", target.string(), error.message());
}

}  // namespace

std::vector<ColmapImage> PlanColmapImages(const std::vector<Photo>& photos) {
  const auto size_of = [](const Photo& photo) {
    return fmt::format("{}x{}", photo.UprightWidth(), photo.UprightHeight());
  };
  std::set<std::string> sizes;
  std::set<std::string> taken;
  for (const Photo& photo : photos) {
    sizes.insert(size_of(photo));
    taken.insert(photo.name);
  }
  std::vector<ColmapImage> plan;
  for (int i = 0; i < static_cast<int>(photos.size()); ++i) {
    const Photo& photo = photos[i];
    ColmapImage image{i, photo.name, !ColmapCanUse(photo)};
    // Copies of JPEG and PNG keep their name and format; those of other formats become PNG.
    const bool keeps_name = photo.eight_bit && (photo.format == "jpeg" || photo.format == "png");
    if (image.converted && !keeps_name) {
      do image.name += ".png";
      while (!taken.insert(image.name).second);
    }
    if (sizes.size() > 1) image.name = size_of(photo) + "/" + image.name;
    plan.push_back(std::move(image));
  }
  return plan;
}

void WriteColmapImages(const std::vector<Photo>& photos, const std::vector<ColmapImage>& plan,
                       const fs::path& image_folder, int threads, PhotoLinks links) {
  std::error_code error;
  fs::create_directories(image_folder, error);
  for (const ColmapImage& image : plan) {
    if (!error) fs::create_directories((image_folder / image.name).parent_path(), error);
  }
  if (error) throw InputError("{}: cannot be created: {}", image_folder.string(), error.message());
  ParallelForEach(
      std::ssize(plan),
      [&](std::int64_t i) {
        const Photo& photo = photos[plan[i].photo];
        const fs::path target = image_folder / plan[i].name;
        plan[i].converted ? WriteConverted(photo, target) : LinkOrCopy(photo, target, links);
      },
      threads);
}

}  // namespace nerf::sfm
