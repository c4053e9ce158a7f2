#pragma once

#include <memory>
#include <vector>

#include "nerf/render/engine.h"

namespace nerf {

class RadianceField;

// A field whose density and colour are the same everywhere and known, and both engines on it: rays
// inside the unit ball have pixels in closed form.
class KnownField {
 public:
  // density  1 / normalized scene unit, within what the activation can say
  // rgb      in (0,1)
  KnownField(double density, const std::vector<double>& rgb, const MarchOptions& march,
             bool with_proposal = false);
  ~KnownField();
  KnownField(const KnownField&) = delete;  // the engines borrow the parts
  KnownField& operator=(const KnownField&) = delete;

  // LibTorchEngine, then FusedEngine.
  const std::vector<std::shared_ptr<Engine>>& Engines() const { return engines_; }
  RadianceField& Field() { return *field_; }
  // The gradients that a step left, as one row; none are left behind.
  std::vector<double> TakeGradients();

  // Rays from the origin to all sides, on the background (0.2, 0.4, 0.6), that aim at grey.
  static TargetBatch RaysFromTheOrigin(int count);

 private:
  ModelParts parts_;
  std::shared_ptr<RadianceField> field_;
  std::vector<std::shared_ptr<Engine>> engines_;
};

}  // namespace nerf
