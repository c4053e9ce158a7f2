#include "nerf/output/contact_sheet.h"

#include <algorithm>
#include <array>
#include <vector>

#include "nerf/image/image_convert.h"
#include "nerf/output/color_map.h"
#include "nerf/output/draw_text.h"

namespace nerf {
namespace {

constexpr int kMaxWidth = 2000;
constexpr int kTiles = 3;  // truth, rendering, difference
constexpr int kGap = 8;
constexpr int kMaxTileWidth = (kMaxWidth - (kTiles + 1) * kGap) / kTiles;
constexpr int kCaptionHeight = 20;
constexpr int kFontSize = 14;

using Tiles = std::array<Image, kTiles>;

Image Fitted(const Image& image) {
  const int factor = (image.width + kMaxTileWidth - 1) / kMaxTileWidth;
  return Downscale(image, std::clamp(factor, 1, std::min(image.width, image.height)));
}

void Paste(const Image& tile, int left, int top, Image& sheet) {
  for (int y = 0; y < tile.height; ++y) {
    const int width = std::min(tile.width, sheet.width - left);
    std::copy_n(tile.At(0, y), width * tile.channels, sheet.At(left, top + y));
  }
}

}  // namespace

Image ContactSheet(std::span<const ContactSheetRow> rows) {
  std::vector<Tiles> tiles;
  int tile_width = 0;
  const int caption_height = HasFont() ? kCaptionHeight : 0;
  int height = kGap;
  for (const ContactSheetRow& row : rows) {
    tiles.push_back({Fitted(OnWhite(row.truth)), Fitted(OnWhite(row.rendering)),
                     Fitted(ColorizeError(row.truth, row.rendering))});
    tile_width = std::max(tile_width, tiles.back()[0].width);
    height += caption_height + tiles.back()[0].height + kGap;
  }
  if (rows.empty()) return {};

  Image sheet(kTiles * tile_width + (kTiles + 1) * kGap, height, 3);
  std::ranges::fill(sheet.pixels, 1.0f);
  int top = kGap;
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    DrawText(rows[i].caption, kGap, top + kFontSize, kFontSize, sheet);
    top += caption_height;
    for (int k = 0; k < kTiles; ++k) {
      Paste(tiles[i][k], kGap + k * (tile_width + kGap), top, sheet);
    }
    top += tiles[i][0].height + kGap;
  }
  return sheet;
}

}  // namespace nerf
