#pragma once

#include <cstdint>
#include <span>

#include "nerf/kernels/hash_encoding.h"

namespace nerf::kernels {

// HashEncodeForward and HashEncodeBackward for the fused engine: the cells of several samples to a
// vector, the features of an entry to a vector. The formula is that of hash_encoding.h.

// Writes samples [0, count) to rows of `row` floats, row >= layout.OutputSize().
//   level_weight  [levels] multiplies what a level gives; where 0 its table is not read
void HashEncodeTile(const HashGridLayout& layout, const float* table, const float* positions,
                    std::int64_t count, std::span<const float> level_weight, float* encoded,
                    std::int64_t row);

// Adds the gradient of one level, in the order of the samples: a level belongs to one thread, so
// that there are no atomics and results do not depend on the number of threads.
//   dL_dencoded  rows of `row` floats, as HashEncodeTile wrote `encoded`
//   dL_dtable    [entries, features] of the whole table
void HashScatterLevel(const HashGridLayout& layout, int level, float level_weight,
                      const float* positions, const float* dL_dencoded, std::int64_t row,
                      std::int64_t count, float* dL_dtable);

}  // namespace nerf::kernels
