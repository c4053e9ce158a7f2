#pragma once

#include <memory>
#include <vector>

#include "nerf/render/engine.h"

namespace nerf {

class RadianceField;

// A field of known, constant density and colour, and both engines on it: the pixels of rays inside
// the unit ball have a closed form.
class KnownField {
 public:
  //   density  1 / normalized scene unit, within the range of the activation
  //   rgb      in (0,1)
  KnownField(double density, const std::vector<double>& rgb, const MarchOptions& march,
             bool with_proposal = false);
  ~KnownField();
  KnownField(const KnownField&) = delete;  // the engines borrow the parts
  KnownField& operator=(const KnownField&) = delete;

  // LibTorchEngine, then FusedEngine.
  const std::vector<std::shared_ptr<Engine>>& Engines() const { return engines_; }
  RadianceField& Field() { return *field_; }
  // The accumulated gradients of all parameters, flattened into one row. Clears them.
  std::vector<double> TakeGradients();

  // Rays from the origin in all directions, with background (0.2, 0.4, 0.6) and target grey (0.5).
  static TargetBatch RaysFromTheOrigin(int count);

 private:
  ModelParts parts_;
  std::shared_ptr<RadianceField> field_;
  std::vector<std::shared_ptr<Engine>> engines_;
};

}  // namespace nerf
