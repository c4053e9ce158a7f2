#pragma once

#include "nerf/base/options.h"

namespace nerf {

// The networks behind the hash encoding; sizes as in Mueller et al. 2022, section 5.4. Declared
// here and not beside RadianceField, whose header includes LibTorch.
struct FieldOptions {
  int hidden_width = 64;
  int geometry_features = 15;
  int color_layers = 2;

  template <class Self, class Visitor>
  static void Options(Self& o, Visitor&& option) {
    option("hidden_width", o.hidden_width, "neurons", Between(1, 1024),
           "width of each hidden layer of the density and colour networks");
    option("geometry_features", o.geometry_features, "", Between(1, 256),
           "outputs of the density network that the colour network sees");
    option("color_layers", o.color_layers, "", Between(0, 8),
           "hidden layers of the colour network");
  }
};

}  // namespace nerf
