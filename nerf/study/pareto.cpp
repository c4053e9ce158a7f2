#include "nerf/study/pareto.h"

#include <algorithm>
#include <cmath>

namespace nerf {

std::vector<std::size_t> ParetoFront(std::span<const Offer> offers) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < offers.size(); ++i) {
    if (std::isfinite(offers[i].cost) && std::isfinite(offers[i].value)) order.push_back(i);
  }
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    if (offers[a].cost != offers[b].cost) return offers[a].cost < offers[b].cost;
    return offers[a].value > offers[b].value;
  });
  std::vector<std::size_t> front;
  for (const std::size_t i : order) {
    const bool better = front.empty() || offers[i].value > offers[front.back()].value;
    const bool equal = !front.empty() && offers[i].value == offers[front.back()].value &&
                       offers[i].cost == offers[front.back()].cost;
    if (better || equal) front.push_back(i);
  }
  return front;
}

}  // namespace nerf
