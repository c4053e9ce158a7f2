#include "nerf/reference/mlp.h"

#include <algorithm>
#include <cstddef>

namespace nerf::reference {

std::vector<double> Mlp(const std::vector<int>& widths, const Weights& weights,
                        std::vector<double> x) {
  for (std::size_t l = 0; l + 1 < widths.size(); ++l) {
    std::vector<double> y(widths[l + 1], 0.0);
    for (int o = 0; o < widths[l + 1]; ++o) {
      for (int i = 0; i < widths[l]; ++i) y[o] += weights[l][o * widths[l] + i] * x[i];
      if (l + 2 < widths.size()) y[o] = std::max(y[o], 0.0);
    }
    x = y;
  }
  return x;
}

}  // namespace nerf::reference
