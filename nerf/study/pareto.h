#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace nerf {

// Something that costs and something that it is worth.
struct CostAndValue {
  double cost = 0;   // less is better
  double value = 0;  // more is better
};

// The points that no other beats: none costs at most as much and is worth at least as much, unless
// it is equal to it in both. In order of cost, along which value rises.
// What is not finite is on no front.
std::vector<std::size_t> ParetoFront(std::span<const CostAndValue> points);

}  // namespace nerf
