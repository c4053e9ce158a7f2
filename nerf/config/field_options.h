#pragma once

namespace nerf {

// The networks behind the hash encoding; sizes as in Mueller et al. 2022, section 5.4.
struct FieldOptions {
  int hidden_width = 64;       // neurons in each hidden layer of both networks
  int geometry_features = 15;  // what the density network tells the colour network
  int color_layers = 2;        // hidden layers of the colour network

  void Check() const;
};

}  // namespace nerf
