#include "sfm/masks.h"

#include <system_error>

namespace nerf::sfm {

namespace fs = std::filesystem;

void FindMasks(PosedImages& posed) {
  for (PosedImage& image : posed.images) {
    const fs::path folder = image.path.parent_path(), name = image.path.filename();
    for (const fs::path& masks : {folder / "masks", folder.parent_path() / "masks"}) {
      for (const fs::path& file :
           {masks / (name.string() + ".png"), masks / fs::path(name).replace_extension(".png")}) {
        std::error_code ignored;
        if (image.mask.empty() && fs::is_regular_file(file, ignored)) image.mask = file;
      }
    }
  }
}

}  // namespace nerf::sfm
