#pragma once

#include "nerf/kernels/bfloat16_product.h"

namespace nerf::kernels::native {

// The part of bfloat16_product.h for which Highway 1.0.3 has no operation: AVX512-BF16's dot
// product of pairs. On other processors and compilers HasBfloat16 is false and Multiply must not be
// called.
bool HasBfloat16();
void Multiply(const Bfloat16Product& product, Epilogue epilogue);

}  // namespace nerf::kernels::native
