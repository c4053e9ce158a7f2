#pragma once

#include "nerf/kernels/bfloat16_product.h"

namespace nerf::kernels::native {

// The part of bfloat16_product.h that Highway 1.0.3 has no operation for: AVX512-BF16's dot product
// of pairs. False, and not to be called, on other processors and compilers.
bool HasBfloat16();
void Multiply(const Bfloat16Product& product, Epilogue epilogue);

}  // namespace nerf::kernels::native
