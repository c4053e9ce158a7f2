#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace nerf::kernels {

// Splits pixels of four interleaved 16-bit floats into planes of floats, each times its scale.
//   pixels  [P,4], the bits of the halves
//   planes  [P] each
void PlanesOfHalves(std::span<const std::uint16_t> pixels, const std::array<float, 4>& scale,
                    const std::array<float*, 4>& planes);

}  // namespace nerf::kernels
