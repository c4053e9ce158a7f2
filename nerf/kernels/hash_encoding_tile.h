#pragma once

#include <cstdint>
#include <span>

#include "nerf/kernels/hash_encoding.h"

namespace nerf::kernels {

// HashEncodeForward and HashEncodeBackward of hash_encoding.h for the fused engine, vectorized over
// the cells of samples and over the features of an entry.

// Encodes samples [0, count) into rows of `row` floats, row >= layout.OutputSize().
//   level_weight  [levels] factor of each level's features; a level of weight 0 is not read
void HashEncodeTile(const HashGridLayout& layout, const float* table, const float* positions,
                    std::int64_t count, std::span<const float> level_weight, float* encoded,
                    std::int64_t row);

// The backward pass in the table: adds the gradient of one level, in the order of the samples. One
// thread owns a level, so that there are no atomics and results do not depend on the number of
// threads.
//   dL_dencoded  rows of `row` floats, as HashEncodeTile wrote `encoded`
//   dL_dtable    [entries, features] of the whole table
void HashScatterLevel(const HashGridLayout& layout, int level, float level_weight,
                      const float* positions, const float* dL_dencoded, std::int64_t row,
                      std::int64_t count, float* dL_dtable);

}  // namespace nerf::kernels
