#include "sfm/masks.h"

#include <system_error>

#include "nerf/image/image_files.h"

namespace nerf::sfm {
namespace {

namespace fs = std::filesystem;

void FindMask(PosedImage& image) {
  const fs::path folder = image.path.parent_path(), root = RootOf(image);
  const fs::path name = image.path.filename(), below_root = fs::path(image.name).parent_path();
  for (const fs::path& masks :
       {folder / "masks", folder.parent_path() / "masks", root / "masks" / below_root,
        root.parent_path() / "masks" / below_root}) {
    std::error_code ignored;
    if (!fs::is_directory(masks, ignored) || fs::equivalent(masks, folder, ignored)) continue;
    for (const fs::path& file : {masks / name, masks / name.stem()}) {
      if (const auto mask = FindImageFile(file)) {
        image.mask = *mask;
        return;
      }
    }
  }
}

}  // namespace

void FindMasks(PosedImages& posed) {
  for (PosedImage& image : posed.images) {
    if (image.mask.empty()) FindMask(image);
  }
}

}  // namespace nerf::sfm
