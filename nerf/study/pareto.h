#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace nerf {

struct CostAndValue {
  double cost = 0;   // less is better
  double value = 0;  // more is better
};

// The indices of the Pareto-optimal points, those that no other point dominates, by increasing cost
// and value. Equal points are all included, non-finite ones are not.
std::vector<std::size_t> ParetoFront(std::span<const CostAndValue> points);

}  // namespace nerf
