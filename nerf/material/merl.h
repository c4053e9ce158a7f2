#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "nerf/material/brdf.h"

namespace nerf {

// Half and difference angles of a pair of directions. Source: Rusinkiewicz 1998.
struct RusinkiewiczAngles {
  double theta_h = 0;  // of the half vector, [0, pi/2]
  double theta_d = 0;  // of w_i in the frame of the half vector, [0, pi/2]
  double phi_d = 0;    // [0, pi); the other half is the same by reciprocity
};
RusinkiewiczAngles RusinkiewiczFromDirections(const Eigen::Vector3d& w_o,
                                              const Eigen::Vector3d& w_i);

// A pair of directions with these angles and phi_h = 0; they may be below the surface.
struct DirectionPair {
  Eigen::Vector3d w_o, w_i;
};
DirectionPair DirectionsFromRusinkiewicz(const RusinkiewiczAngles& angles);

// A measured isotropic BRDF as in the MERL database. Source: Matusik et al. 2003: 90 x 90 x 180
// bins of theta_h (by its square root: denser at the highlight), theta_d and phi_d. Values are
// interpolated between the centres of bins; bins without a measurement (negative) are ignored.
class MerlBrdf : public Brdf {
 public:
  static constexpr int kThetaH = 90;
  static constexpr int kThetaD = 90;
  static constexpr int kPhiD = 180;
  static constexpr int kBins = kThetaH * kThetaD * kPhiD;

  // Reads the binary format: three 32-bit sizes, then red, green and blue, kBins doubles each,
  // little endian. Throws InputError naming the file if its length or sizes are wrong, or a value
  // is not finite.
  static MerlBrdf Read(const std::filesystem::path& file);

  // Tabulates another BRDF at the centres of the bins.
  static MerlBrdf Tabulate(const Brdf& brdf);

  // Throws InputError.
  void Write(const std::filesystem::path& file) const;

  Color Eval(const Eigen::Vector3d& w_o, const Eigen::Vector3d& w_i) const override;
  // Draws half of the directions in proportion to the cosine, half by the brightness over theta_h.
  std::optional<BrdfSample> Sample(const Eigen::Vector3d& w_o,
                                   const Eigen::Array3d& u) const override;
  double Pdf(const Eigen::Vector3d& w_o, const Eigen::Vector3d& w_i) const override;

 private:
  explicit MerlBrdf(std::vector<Color> bins);

  double HalfVectorDensity(const Eigen::Vector3d& h) const;  // 1 / sr

  std::vector<Color> bins_;  // [theta_h][theta_d][phi_d]; negative: not measured
  std::array<double, kThetaH + 1> cumulative_{};  // distribution of half vectors over theta_h
};

}  // namespace nerf
