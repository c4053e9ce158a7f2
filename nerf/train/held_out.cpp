#include "nerf/train/held_out.h"

#include <algorithm>
#include <utility>

namespace nerf {
namespace {

constexpr std::size_t kEnough = 4, kOneIn = 8;

template <class T>
void Remove(std::size_t place, std::vector<T>& from) {
  if (!from.empty()) from.erase(from.begin() + static_cast<std::ptrdiff_t>(place));
}

}  // namespace

HeldOut::HeldOut(Dataset& data, SceneFacts scene) : data_(data), scene_(std::move(scene)) {
  const std::size_t all = data.train.size(), there = data.validation.size();
  const std::size_t count = there >= kEnough ? 0 : std::min(kEnough - there, all / kOneIn);
  for (std::size_t k = 0; k < count; ++k) places_.push_back((2 * k + 1) * all / (2 * count));
  // From the back, so that the places before stay what they are.
  for (auto place = places_.rbegin(); place != places_.rend(); ++place) {
    data.validation.push_back(std::move(data.train[*place]));
    Remove(*place, data.train);
    Remove(*place, scene_.photographs);
    Remove(*place, scene_.places);
    Remove(*place, scene_.exposure_stops);
  }
}

HeldOut::~HeldOut() {
  for (const std::size_t place : places_) {
    data_.train.insert(data_.train.begin() + static_cast<std::ptrdiff_t>(place),
                       std::move(data_.validation.back()));
    data_.validation.pop_back();
  }
}

}  // namespace nerf
