#include "nerf/config/field_options.h"

#include "nerf/base/input_error.h"

namespace nerf {

void FieldOptions::Check() const {
  if (hidden_width < 1 || hidden_width > 1024) {
    throw InputError("config: field.hidden_width is {}; use 1 to 1024", hidden_width);
  }
  if (geometry_features < 1 || geometry_features > 256) {
    throw InputError("config: field.geometry_features is {}; use 1 to 256", geometry_features);
  }
  if (color_layers < 0 || color_layers > 8) {
    throw InputError("config: field.color_layers is {}; use 0 to 8", color_layers);
  }
}

}  // namespace nerf
