#pragma once

#include "nerf/material/brdf.h"

namespace nerf {

// A diffuse surface: f_r = albedo / pi. Source: Lambert 1760.
class Lambert : public Brdf {
 public:
  // albedo  in [0,1]
  explicit Lambert(const Color& albedo) : albedo_(albedo) {}

  Color Eval(const Eigen::Vector3d& w_o, const Eigen::Vector3d& w_i) const override;
  std::optional<BrdfSample> Sample(const Eigen::Vector3d& w_o,
                                   const Eigen::Array3d& u) const override;
  double Pdf(const Eigen::Vector3d& w_o, const Eigen::Vector3d& w_i) const override;

 private:
  Color albedo_;
};

}  // namespace nerf
