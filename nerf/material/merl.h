#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "nerf/material/brdf.h"

namespace nerf {

// Half and difference angles of a pair of directions. Source: Rusinkiewicz 1998.
struct RusinkiewiczAngles {
  double theta_h = 0;  // of the half vector, [0, pi/2]
  double theta_d = 0;  // of w_i in the half vector's frame, [0, pi/2]
  double phi_d = 0;    // [0, pi): reciprocity makes the other half the same
};
RusinkiewiczAngles AnglesOf(const Eigen::Vector3d& w_o, const Eigen::Vector3d& w_i);

// A pair of directions with given angles, in the plane phi_h = 0; they may lie below the surface.
struct DirectionPair {
  Eigen::Vector3d w_o, w_i;
};
DirectionPair DirectionsOf(const RusinkiewiczAngles& angles);

// A measured isotropic BRDF, as in the MERL database. Source: Matusik et al. 2003: 90 x 90 x 180
// bins of theta_h (by the square root: dense at the highlight), theta_d and phi_d. Values between
// the middles of bins are interpolated, bins that were not measured (negative) left out.
class MerlBrdf : public Brdf {
 public:
  static constexpr int kThetaH = 90;
  static constexpr int kThetaD = 90;
  static constexpr int kPhiD = 180;
  static constexpr int kBins = kThetaH * kThetaD * kPhiD;

  // Reads the binary format: three 32-bit sizes, then red, green and blue, kBins doubles each,
  // little endian. Throws InputError naming the file where it is cut short, too long, has
  // other sizes, or holds a value that is no number.
  static MerlBrdf Read(const std::filesystem::path& file);

  // Any BRDF as a measurement would find it, at the middles of the bins.
  static MerlBrdf Measure(const Brdf& brdf);

  // Throws InputError.
  void Write(const std::filesystem::path& file) const;

  Color Eval(const Eigen::Vector3d& w_o, const Eigen::Vector3d& w_i) const override;
  // Half of the draws follow the cosine, half the brightness of the highlight over theta_h.
  std::optional<BrdfSample> Sample(const Eigen::Vector3d& w_o,
                                   const Eigen::Array3d& u) const override;
  double Pdf(const Eigen::Vector3d& w_o, const Eigen::Vector3d& w_i) const override;

 private:
  explicit MerlBrdf(std::vector<Color> bins);

  double HalfVectorDensity(const Eigen::Vector3d& h) const;  // 1 / sr

  std::vector<Color> bins_;                       // [theta_h][theta_d][phi_d]; < 0: not measured
  std::array<double, kThetaH + 1> cumulative_{};  // of the half vectors' distribution over theta_h
};

}  // namespace nerf
