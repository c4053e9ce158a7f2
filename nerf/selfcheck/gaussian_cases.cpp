// Gaussians, where they are hard to draw: rows 41 to 49 of the hard cases.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <random>

#include "nerf/scene/scene_normalization.h"
#include "nerf/selfcheck/gaussian_drawing.h"
#include "nerf/selfcheck/gaussian_scene.h"
#include "nerf/selfcheck/numeric_case.h"
#include "nerf/splats/gaussian_renderer.h"

namespace nerf {
namespace {

using namespace gaussian_drawing;
using reference::Gaussian;
using reference::GaussianView;

// A perspective camera draws nothing with its mean nearer than `near` along the axis; nothing is
// mirrored from behind.
double NothingBehindACameraIsDrawn() {
  WorstError worst;
  const GaussianView view = SmallView();
  for (const double z : {-1e6, -3.0, -0.02, -1e-7, 0.0, 1e-7, 0.0199}) {
    for (const double size : {1e-3, 0.5, 100.0}) {
      Gaussian g = At(z, size);
      g.mean.x() = 0.01;
      const Drawn drawn = Draw({g}, view);
      worst.Add(drawn.alpha);
      RequireFinite(drawn, worst);
      for (const float value : drawn.gradients) worst.Add(value);
    }
  }
  for (const double z : {0.0201, 0.05, 0.5}) RequireFinite(Draw({At(z, 0.5)}, view), worst);
  return worst.Get();
}

// Discs, needles and points; those seen from the edge have a projected covariance of determinant 0.
double FlatGaussiansCoverTheirShare() {
  WorstError worst;
  for (const CameraModel model : {CameraModel::kPinhole, CameraModel::kOpenCVFisheye}) {
    const GaussianView view = SmallView(model);
    for (int flat = 1; flat < 8; ++flat) {
      for (const double turned : {0.0, 0.7, std::numbers::pi / 2}) {
        Gaussian g = At(2, 0.2);
        for (int k = 0; k < 3; ++k) {
          if (flat >> k & 1) g.log_scale[k] = -15;
        }
        g.rotation = Eigen::Vector4d(std::cos(turned / 2), std::sin(turned / 2), 0, 0);
        const Drawn drawn = Draw({g}, view);
        RequireFinite(drawn, worst);
        worst.Add(Difference(drawn, {g}, view));
      }
    }
  }
  return worst.Get();
}

// The sum of alpha is opacity 2 pi sigma_x sigma_y but for the part that is cut, 1 / (255 opacity),
// on the average over where it is between the pixels.
double AlphaDoesNotChangeWithDistance() {
  WorstError worst;
  const double opacity = 0.99 / (1 + std::exp(-6.0)), size = 0.3;
  for (const double distance : {3.0, 10.0, 50.0, 300.0, 3000.0}) {
    const GaussianView view = SmallView();
    double alpha = 0;
    constexpr int kPlaces = 8;
    for (int i = 0; i < kPlaces * kPlaces; ++i) {
      Gaussian g = At(distance, size, 6);
      g.mean.x() = (i % kPlaces + 0.5) / kPlaces * distance / kFocal;
      g.mean.y() = (i / kPlaces + 0.5) / kPlaces * distance / kFocal;
      alpha += Draw({g}, view).alpha / (kPlaces * kPlaces);
    }
    const double sigma = size * kFocal / distance;
    const double whole = opacity * 2 * std::numbers::pi * sigma * sigma;
    worst.AddRelative(alpha, whole * (1 - 1 / (255 * opacity)));
  }
  return worst.Get();
}

double OpacitiesOfAnySizeStayInRange() {
  WorstError worst;
  const GaussianView view = SmallView();
  for (const double logit : {-1e4, -20.0, 0.0, 16.0, 40.0, 1e4}) {
    const std::vector<Gaussian> two = {At(2, 0.2, logit), At(3, 0.4, logit)};
    const Drawn drawn = Draw(two, view);
    RequireFinite(drawn, worst);
    const float* const T = drawn.picture.Plane(GaussianPicture::kTransmittance);
    for (int y = 0; y < 40; ++y) {
      for (int x = 0; x < 48; ++x) {
        const float left = T[y * drawn.picture.stride + x];
        worst.Require(left > 0 && left <= 1);
      }
    }
    worst.Add(Difference(drawn, two, view));
    // Where it is seen, its opacity has a gradient: no value is out of reach.
    if (logit > 0 && logit < 50) {
      worst.Require(drawn.gradients[16 * kernels::kOpacityRow] != 0);
    }
  }
  return worst.Get();
}

double EqualDistancesInAnyOrderAreTheSame() {
  WorstError worst;
  const GaussianView view = SmallView();
  std::vector<Gaussian> gaussians = RandomGaussians(40, 0, 3);
  for (Gaussian& g : gaussians) g.mean = 3 * g.mean.normalized();
  for (std::size_t i = 1; i < gaussians.size(); i += 2) gaussians[i].mean = gaussians[i - 1].mean;
  const Drawn first = Draw(gaussians, view);
  std::mt19937 random(1);
  for (int order = 0; order < 4; ++order) {
    std::ranges::shuffle(gaussians, random);
    const Drawn other = Draw(gaussians, view);
    for (int plane = 0; plane < GaussianPicture::kPlanes; ++plane) {
      for (int y = 0; y < 40; ++y) {
        const float* const a = first.picture.Plane(plane) + y * first.picture.stride;
        const float* const b = other.picture.Plane(plane) + y * other.picture.stride;
        worst.Require(std::memcmp(a, b, 48 * sizeof(float)) == 0);
      }
    }
  }
  return worst.Get();
}

// The light that is left, relative, until blending ends.
double ThousandsOfLayersLeaveTheirLight() {
  WorstError worst;
  const GaussianView view = SmallView();
  for (const int layers : {10, 300, 10000}) {
    for (const double tau : {1e-6, 1e-2, 1.0, 8.0}) {
      std::vector<Gaussian> gaussians;
      // Of all layers together; as large as the picture.
      const double alpha = -std::expm1(-tau / layers);
      const double logit = std::log(alpha / (static_cast<double>(kernels::kMostOpacity) - alpha));
      for (int i = 0; i < layers; ++i) gaussians.push_back(At(2 + 1e-4 * i, 20, logit));
      const Drawn drawn = Draw(gaussians, view);
      RequireFinite(drawn, worst);
      const auto truth = DrawGaussians({gaussians.front()}, view);
      // One layer's transmittance to the power of their number, at the centre.
      const std::size_t centre = 20 * 48 + 24;
      const long double left = std::pow(static_cast<long double>(truth[centre].transmittance),
                                        static_cast<long double>(layers));
      worst.AddRelative(
          drawn.picture.Plane(GaussianPicture::kTransmittance)[20 * drawn.picture.stride + 24],
          left);
    }
  }
  return worst.Get();
}

// A scene of a millimetre and one of ten kilometres, far from the origin, in normalized units, look
// alike: whatever the frame, the picture of the same Gaussians is the same.
double ScenesOfAnySizeAreDrawnAlike() {
  WorstError worst;
  const GaussianView view = SmallView();
  const std::vector<Gaussian> gaussians = RandomGaussians(30, 0, 5);
  for (const double scale : {1e-3, 1e4}) {
    const Eigen::Vector3d origin = scale * Eigen::Vector3d(50, 520, -3);
    SceneNormalization frame;
    frame.scale = 1 / scale;
    frame.translation = -origin / scale;
    std::vector<Gaussian> again = gaussians;
    for (Gaussian& g : again) {  // there and back
      g.mean = frame.NormalizedFromWorld(scale * g.mean + origin);
    }
    Eigen::Isometry3d pose = view.camera_from_normalized.inverse();
    pose.translation() = scale * pose.translation() + origin;
    GaussianView moved = view;
    moved.camera_from_normalized = frame.NormalizedFromCamera(pose).inverse();
    worst.Add(Difference(Draw(again, moved), gaussians, view));
  }
  return worst.Get();
}

double QuaternionsOfAnyLengthAreRotations() {
  WorstError worst;
  const GaussianView view = SmallView();
  for (const double length : {0.0, 1e-38, 1e-30, 1e-3, 1e3, 1e30}) {
    Gaussian g = At(2, 0.2);
    g.log_scale.x() = -3;
    g.rotation = length * Eigen::Vector4d(0.5, 0.1, -0.7, 0.3).normalized();
    const Drawn drawn = Draw({g}, view);
    RequireFinite(drawn, worst);
    Gaussian same = g;
    same.rotation = length > 1e-36 ? Eigen::Vector4d(0.5, 0.1, -0.7, 0.3).normalized()
                                   : Eigen::Vector4d(1, 0, 0, 0);
    worst.Add(Difference(drawn, {same}, view));
  }
  return worst.Get();
}

// As large as the scene and far beyond the screen, seen along one axis.
double HugeGaussiansStayFinite() {
  WorstError worst;
  for (const CameraModel model : {CameraModel::kPinhole, CameraModel::kOpenCVFisheye}) {
    const GaussianView view = SmallView(model);
    for (const double size : {10.0, 1e3, 1e8}) {
      for (const double distance : {0.1, 5.0, 1e5}) {
        Gaussian g = At(distance, size);
        g.log_scale.y() = -8;
        g.mean.x() = distance;
        RequireFinite(Draw({g}, view), worst);
      }
    }
  }
  // Diagonal needles with their mean far outside: their exponents are differences of large numbers.
  for (const double outside : {1e2, 1e4, 1e5}) {
    Gaussian g = At(1, 1e-3);
    g.log_scale.x() = std::log(10 * outside / kFocal);
    g.mean += outside / kFocal * Eigen::Vector3d(1, 1, 0);
    g.rotation =
        Eigen::Vector4d(std::cos(std::numbers::pi / 8), 0, 0, std::sin(std::numbers::pi / 8));
    const Drawn drawn = Draw({g, At(2, 1)}, SmallView());
    RequireFinite(drawn, worst);
    for (int y = 0; y < 40; ++y) {
      for (int x = 0; x < 48; ++x) {
        worst.Require(drawn.picture.Row(GaussianPicture::kTransmittance, y)[x] > 0);
      }
    }
  }
  // One that is much larger than the screen covers all of it.
  GaussianView telescope = SmallView();
  telescope.camera.params = {1e5, 1e5, 24, 20};
  const Drawn drawn = Draw({At(0.1, 2000, 0)}, telescope);
  worst.Require(std::abs(drawn.alpha / (48 * 40) - 0.495) < 1e-4);
  return worst.Get();
}

}  // namespace

std::vector<NumericCase> GaussianCases() {
  return {
      {"NothingBehindACameraIsDrawn", "alpha, gradient", kExact, true, NothingBehindACameraIsDrawn},
      {"FlatGaussiansCoverTheirShare", "colour, against double", Within(2e-5, 2.2e-6), true,
       FlatGaussiansCoverTheirShare},
      {"AlphaDoesNotChangeWithDistance", "sum over the picture, relative", Within(3e-3, 5.1e-4),
       true, AlphaDoesNotChangeWithDistance},
      {"OpacitiesOfAnySizeStayInRange", "colour, against double", Within(9e-6, 1.0e-6), true,
       OpacitiesOfAnySizeStayInRange},
      {"EqualDistancesInAnyOrderAreTheSame", "bits", kExact, true,
       EqualDistancesInAnyOrderAreTheSame},
      {"ThousandsOfLayersLeaveTheirLight", "light left, relative", Within(7e-6, 7.8e-7), true,
       ThousandsOfLayersLeaveTheirLight},
      {"QuaternionsOfAnyLengthAreRotations", "colour, against double", Within(2e-5, 2.2e-6), true,
       QuaternionsOfAnyLengthAreRotations},
      {"ScenesOfAnySizeAreDrawnAlike", "colour, against double", Within(2e-5, 2.2e-6), true,
       ScenesOfAnySizeAreDrawnAlike},
      {"HugeGaussiansStayFinite", "finite or not", kExact, true, HugeGaussiansStayFinite},
  };
}

}  // namespace nerf
