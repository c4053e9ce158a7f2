#include "nerf/scene/error_map.h"

#include <algorithm>

#include "nerf/base/input_error.h"
#include "nerf/base/random.h"

namespace nerf {
namespace {

// Side of a cell in pixels. Doubled until there are at most kMostCells cells, so that summing over
// them takes no noticeable part of a training step.
constexpr std::int64_t kSmallestEdge = 16;
constexpr std::int64_t kMostCells = 1 << 16;

// Weight of a new error in the running mean of its cell.
constexpr float kUpdateRate = 0.1f;

constexpr float kUnknown = -1.0f;

// Bounds of the error: from below, so that a cell which is converged for now is still drawn
// sometimes; from above, so that one cell does not take all the rays.
constexpr float kLeastError = 1e-7f, kMostError = 1.0f;

std::int64_t Cells(std::int64_t pixels, std::int64_t edge) { return (pixels + edge - 1) / edge; }

std::int64_t CellsOfViews(const std::vector<View>& views, std::int64_t edge) {
  std::int64_t count = 0;
  for (const View& view : views) {
    count += Cells(view.camera.width, edge) * Cells(view.camera.height, edge);
  }
  return count;
}

}  // namespace

ErrorMap::ErrorMap(const std::vector<View>& views)
    : views_(views), edge_(kSmallestEdge), first_cell_{0} {
  while (CellsOfViews(views, edge_) > std::max<std::int64_t>(kMostCells, views.size())) edge_ *= 2;
  for (const View& view : views) {
    const std::int64_t width = view.camera.width, height = view.camera.height;
    for (std::int64_t y = 0; y < height; y += edge_) {
      for (std::int64_t x = 0; x < width; x += edge_) {
        size_.push_back(
            static_cast<float>(std::min(edge_, width - x) * std::min(edge_, height - y)));
      }
    }
    first_cell_.push_back(static_cast<std::int64_t>(size_.size()));
  }
  error_.assign(size_.size(), kUnknown);
  cumulative_.resize(size_.size());
  UpdateCumulative();
}

std::int64_t ErrorMap::CellsAcross(std::size_t view) const {
  return Cells(views_[view].camera.width, edge_);
}

std::int64_t ErrorMap::CellOf(const Pixel& pixel) const {
  const std::int64_t width = views_[pixel.view].camera.width;
  const std::int64_t x = pixel.index % width, y = pixel.index / width;
  return first_cell_[pixel.view] + y / edge_ * CellsAcross(pixel.view) + x / edge_;
}

ErrorMap::Pixel ErrorMap::Draw(std::uint64_t bits) const {
  const double wanted = static_cast<double>(bits >> 11) * 0x1p-53 * cumulative_.back();
  const auto found = std::ranges::upper_bound(cumulative_, wanted) - cumulative_.begin();
  const std::int64_t cell = std::min<std::int64_t>(found, std::ssize(cumulative_) - 1);
  const auto after = std::ranges::upper_bound(first_cell_, cell);
  Pixel pixel;
  pixel.view = static_cast<std::size_t>(after - first_cell_.begin() - 1);

  const std::int64_t width = views_[pixel.view].camera.width;
  const std::int64_t in_view = cell - first_cell_[pixel.view], across = CellsAcross(pixel.view);
  const std::int64_t left = in_view % across * edge_, top = in_view / across * edge_;
  const std::int64_t columns = std::min(edge_, width - left);
  const auto in_cell =
      static_cast<std::int64_t>(Mix64(bits) % static_cast<std::uint64_t>(size_[cell]));
  pixel.index = (top + in_cell / columns) * width + left + in_cell % columns;
  return pixel;
}

void ErrorMap::Update(std::span<const std::int64_t> cells, std::span<const float> squared_error) {
  for (std::size_t r = 0; r < cells.size(); ++r) {
    float& error = error_[cells[r]];
    const float shown = std::min(squared_error[r], kMostError);
    error = error == kUnknown ? shown : error + kUpdateRate * (shown - error);
  }
  UpdateCumulative();
}

void ErrorMap::SetErrors(std::span<const float> errors) {
  if (errors.size() != error_.size()) {
    throw InputError(
        "the photographs are not those of the checkpoint: its error map has {2} cells, they have "
        "{0} of {1} pixels; train again",
        error_.size(), edge_, errors.size());
  }
  if (!std::ranges::all_of(errors, [](float e) { return e == kUnknown || (e >= 0 && e <= 1); })) {
    throw InputError("the checkpoint's error map holds values outside [0,1]; train again");
  }
  std::ranges::copy(errors, error_.begin());
  UpdateCumulative();
}

void ErrorMap::UpdateCumulative() {
  double known = 0, pixels = 0;
  for (std::size_t i = 0; i < error_.size(); ++i) {
    if (error_[i] == kUnknown) continue;
    known += static_cast<double>(error_[i] * size_[i]);
    pixels += static_cast<double>(size_[i]);
  }
  const float mean = pixels > 0 ? static_cast<float>(known / pixels) : 1.0f;
  double sum = 0;
  for (std::size_t i = 0; i < error_.size(); ++i) {
    const float error = error_[i] == kUnknown ? mean : error_[i];
    cumulative_[i] = sum += static_cast<double>(std::max(error, kLeastError) * size_[i]);
  }
}

}  // namespace nerf
