#include "nerf/study/pareto.h"

#include <algorithm>
#include <cmath>

namespace nerf {

std::vector<std::size_t> ParetoFront(std::span<const CostAndValue> points) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::isfinite(points[i].cost) && std::isfinite(points[i].value)) order.push_back(i);
  }
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    if (points[a].cost != points[b].cost) return points[a].cost < points[b].cost;
    return points[a].value > points[b].value;
  });
  std::vector<std::size_t> front;
  for (const std::size_t i : order) {
    const bool better = front.empty() || points[i].value > points[front.back()].value;
    const bool equal = !front.empty() && points[i].value == points[front.back()].value &&
                       points[i].cost == points[front.back()].cost;
    if (better || equal) front.push_back(i);
  }
  return front;
}

}  // namespace nerf
