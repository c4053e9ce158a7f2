#include "nerf/material/merl.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <string>

#include "nerf/base/atomic_file.h"
#include "nerf/base/input_error.h"
#include "nerf/geometry/directions.h"

namespace nerf {
namespace {

using Eigen::Vector3d;

static_assert(std::endian::native == std::endian::little, "MERL files are little endian");

using std::numbers::pi;
constexpr double kScale[3] = {1.0 / 1500, 1.15 / 1500, 1.66 / 1500};  // of the stored values
constexpr std::size_t kHeader = 3 * sizeof(std::int32_t);

Vector3d RotatedAboutY(const Vector3d& v, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {c * v.x() + s * v.z(), v.y(), c * v.z() - s * v.x()};
}

Vector3d RotatedAboutZ(const Vector3d& v, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y(), v.z()};
}

std::size_t BinIndex(int theta_h, int theta_d, int phi_d) {
  return (static_cast<std::size_t>(theta_h) * MerlBrdf::kThetaD + theta_d) * MerlBrdf::kPhiD +
         phi_d;
}

// theta_h at a position on the axis of bins, in units of bins.
double ThetaHAt(double position) {
  const double root = position / MerlBrdf::kThetaH;
  return root * root * pi / 2;
}

// The two bins whose centres enclose a position, and the weight of the upper one.
struct Interpolation {
  int lower, upper;
  double weight;
};
Interpolation Clamped(double position, int count) {
  const double p = std::clamp(position - 0.5, 0.0, count - 1.0);
  const int lower = std::min(static_cast<int>(p), count - 2);
  return {lower, lower + 1, p - lower};
}
Interpolation Periodic(double position, int count) {
  const double p = position - 0.5;
  const int lower = static_cast<int>(std::floor(p));
  return {(lower + count) % count, (lower + 1) % count, p - lower};
}

}  // namespace

RusinkiewiczAngles RusinkiewiczFromDirections(const Vector3d& w_o, const Vector3d& w_i) {
  const Vector3d h = HalfVector(w_o, w_i);
  const double theta_h = std::atan2(std::hypot(h.x(), h.y()), h.z());
  const double phi_h = std::atan2(h.y(), h.x());
  const Vector3d d = RotatedAboutY(RotatedAboutZ(w_i, -phi_h), -theta_h);
  double phi_d = std::atan2(d.y(), d.x());
  if (phi_d < 0) phi_d += pi;
  if (phi_d >= pi) phi_d -= pi;
  return {theta_h, std::atan2(std::hypot(d.x(), d.y()), d.z()), phi_d};
}

DirectionPair DirectionsFromRusinkiewicz(const RusinkiewiczAngles& angles) {
  const double s = std::sin(angles.theta_d);
  const Vector3d d(s * std::cos(angles.phi_d), s * std::sin(angles.phi_d),
                   std::cos(angles.theta_d));
  const Vector3d mirrored(-d.x(), -d.y(), d.z());
  return {RotatedAboutY(mirrored, angles.theta_h), RotatedAboutY(d, angles.theta_h)};
}

MerlBrdf::MerlBrdf(std::vector<Color> bins) : bins_(std::move(bins)) {
  for (int i = 0; i < kThetaH; ++i) {
    double brightness = 0;
    int measured = 0;
    for (int j = 0; j < kThetaD / 2; ++j) {  // beyond, Fresnel reflection dominates
      const Color& bin = bins_[BinIndex(i, j, kPhiD / 2)];
      if (bin.minCoeff() < 0) continue;
      brightness += Luminance(bin);
      ++measured;
    }
    brightness = brightness / std::max(1, measured) + 1e-9;
    // The weight of a ring of half vectors: brightness, foreshortening and solid angle.
    const double begin = ThetaHAt(i);
    const double end = ThetaHAt(i + 1);
    const double ring = std::sin(end) * std::sin(end) - std::sin(begin) * std::sin(begin);
    cumulative_[static_cast<std::size_t>(i) + 1] =
        cumulative_[static_cast<std::size_t>(i)] + brightness * ring;
  }
  for (double& value : cumulative_) value /= cumulative_.back();
}

MerlBrdf MerlBrdf::Read(const std::filesystem::path& file) {
  const std::string bytes = ReadWholeFile(file);
  constexpr std::size_t kExpected = kHeader + std::size_t{kBins} * 3 * sizeof(double);
  std::int32_t sizes[3] = {};
  if (bytes.size() >= kHeader) std::memcpy(sizes, bytes.data(), kHeader);
  if (bytes.size() < kHeader || sizes[0] != kThetaH || sizes[1] != kThetaD || sizes[2] != kPhiD) {
    throw InputError("{}: not a MERL BRDF: the sizes are {} x {} x {}, expected 90 x 90 x 180",
                     file.string(), sizes[0], sizes[1], sizes[2]);
  }
  if (bytes.size() != kExpected) {
    throw InputError("{}: {} bytes instead of the {} of a MERL BRDF; copy the file again",
                     file.string(), bytes.size(), kExpected);
  }
  std::vector<Color> bins(kBins);
  for (int c = 0; c < 3; ++c) {
    for (int i = 0; i < kBins; ++i) {
      double value = 0;
      std::memcpy(&value,
                  bytes.data() + kHeader + (static_cast<std::size_t>(c) * kBins + i) * sizeof value,
                  sizeof value);
      if (!std::isfinite(value)) {
        throw InputError("{}: value {} of channel {} is {}, expected a finite number",
                         file.string(), i, c, value);
      }
      bins[static_cast<std::size_t>(i)][c] = value * kScale[c];
    }
  }
  return MerlBrdf(std::move(bins));
}

MerlBrdf MerlBrdf::Tabulate(const Brdf& brdf) {
  std::vector<Color> bins(kBins);
  for (int i = 0; i < kThetaH; ++i) {
    for (int j = 0; j < kThetaD; ++j) {
      for (int k = 0; k < kPhiD; ++k) {
        const RusinkiewiczAngles angles{ThetaHAt(i + 0.5), (j + 0.5) * pi / 2 / kThetaD,
                                        (k + 0.5) * pi / kPhiD};
        const auto [w_o, w_i] = DirectionsFromRusinkiewicz(angles);
        const bool above = w_o.z() > 0 && w_i.z() > 0;
        bins[BinIndex(i, j, k)] = above ? brdf.Eval(w_o, w_i) : Color::Constant(-1);
      }
    }
  }
  return MerlBrdf(std::move(bins));
}

void MerlBrdf::Write(const std::filesystem::path& file) const {
  std::string bytes(kHeader + bins_.size() * 3 * sizeof(double), '\0');
  const std::int32_t sizes[3] = {kThetaH, kThetaD, kPhiD};
  std::memcpy(bytes.data(), sizes, kHeader);
  std::size_t at = kHeader;
  for (int c = 0; c < 3; ++c) {
    for (const Color& bin : bins_) {
      const double value = bin[c] / kScale[c];
      std::memcpy(bytes.data() + at, &value, sizeof value);
      at += sizeof value;
    }
  }
  WriteFileAtomically(file, bytes);
}

Color MerlBrdf::Eval(const Vector3d& w_o, const Vector3d& w_i) const {
  if (w_o.z() <= 0 || w_i.z() <= 0) return Color::Zero();
  const RusinkiewiczAngles angles = RusinkiewiczFromDirections(w_o, w_i);
  const Interpolation h = Clamped(std::sqrt(angles.theta_h / (pi / 2)) * kThetaH, kThetaH);
  const Interpolation d = Clamped(angles.theta_d / (pi / 2) * kThetaD, kThetaD);
  const Interpolation phi = Periodic(angles.phi_d / pi * kPhiD, kPhiD);
  Color sum = Color::Zero();
  double weights = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const bool up_h = (corner & 1) != 0;
    const bool up_d = (corner & 2) != 0;
    const bool up_phi = (corner & 4) != 0;
    const double weight = (up_h ? h.weight : 1 - h.weight) * (up_d ? d.weight : 1 - d.weight) *
                          (up_phi ? phi.weight : 1 - phi.weight);
    const Color& bin = bins_[BinIndex(up_h ? h.upper : h.lower, up_d ? d.upper : d.lower,
                                      up_phi ? phi.upper : phi.lower)];
    if (bin.minCoeff() < 0) continue;
    sum += weight * bin;
    weights += weight;
  }
  return weights > 0 ? Color(sum / weights) : Color::Zero();
}

double MerlBrdf::HalfVectorDensity(const Vector3d& h) const {
  const double theta = std::atan2(std::hypot(h.x(), h.y()), h.z());
  const int i = std::clamp(static_cast<int>(std::sqrt(theta / (pi / 2)) * kThetaH), 0, kThetaH - 1);
  const double begin = std::sin(ThetaHAt(i));
  const double end = std::sin(ThetaHAt(i + 1));
  const auto* mass = &cumulative_[static_cast<std::size_t>(i)];
  // Within a ring sin^2(theta) is uniform, so that the density over solid angle is cos(theta).
  return (mass[1] - mass[0]) * h.z() / (pi * (end * end - begin * begin));
}

std::optional<BrdfSample> MerlBrdf::Sample(const Vector3d& w_o, const Eigen::Array3d& u) const {
  if (w_o.z() <= 0) return std::nullopt;
  Vector3d w_i;
  if (u.z() < 0.5) {
    w_i = CosineOnHemisphere(u.head<2>());
  } else {
    const auto above = std::ranges::upper_bound(cumulative_, u.x());
    const int i = std::clamp(static_cast<int>(above - cumulative_.begin()) - 1, 0, kThetaH - 1);
    const auto* mass = &cumulative_[static_cast<std::size_t>(i)];
    const double share = std::clamp((u.x() - mass[0]) / (mass[1] - mass[0]), 0.0, 1.0);
    const double begin = std::pow(std::sin(ThetaHAt(i)), 2);
    const double end = std::pow(std::sin(ThetaHAt(i + 1)), 2);
    const double sin2 = begin + (end - begin) * share;
    const double phi = 2 * pi * u.y();
    const Vector3d h(std::sqrt(sin2) * std::cos(phi), std::sqrt(sin2) * std::sin(phi),
                     std::sqrt(std::max(0.0, 1 - sin2)));
    w_i = 2 * w_o.dot(h) * h - w_o;
  }
  if (w_i.z() <= 0) return std::nullopt;
  const double pdf = Pdf(w_o, w_i);
  if (!(pdf > 0)) return std::nullopt;
  return BrdfSample{w_i, Eval(w_o, w_i), pdf};
}

double MerlBrdf::Pdf(const Vector3d& w_o, const Vector3d& w_i) const {
  if (w_o.z() <= 0 || w_i.z() <= 0) return 0;
  const Vector3d h = HalfVector(w_o, w_i);
  const double highlight = HalfVectorDensity(h) / std::max(4 * w_o.dot(h), 1e-12);
  return 0.5 * w_i.z() / pi + 0.5 * highlight;
}

}  // namespace nerf
