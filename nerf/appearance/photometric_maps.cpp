#include "nerf/appearance/photometric_maps.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "nerf/parallel.h"
#include "sfm/input_error.h"
#include "sfm/progress.h"

namespace nerf::appearance {
namespace {

using Eigen::Vector3d;

constexpr float kSaturated = 0.998f;  // of the largest value that a file can hold
constexpr double kBlack = 1e-4;       // mean below which a photograph shows nothing
constexpr double kAgrees = 3;         // residuals; beyond it an observation says nothing of albedo
constexpr int kBlock = 4096;          // pixels a thread takes at a time

// The observations of the pixels inside the mask.
struct Observations {
  std::vector<int> pixels;    // index y * width + x
  std::vector<float> values;  // [pixel][light][channel], over the light's intensity
  std::vector<char> known;    // [pixel][light]: not saturated
};

std::vector<int> PixelsInside(const OlatCapture& capture) {
  const int count = capture.width * capture.height;
  std::vector<int> pixels;
  if (!capture.mask) {
    pixels.resize(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) pixels[static_cast<std::size_t>(i)] = i;
    return pixels;
  }
  const Image mask = ReadLinearImage(*capture.mask, InputEncoding::kLinear);
  for (int i = 0; i < count; ++i) {
    if (mask.pixels[static_cast<std::size_t>(i) * 3] > 0.5f) pixels.push_back(i);
  }
  if (pixels.empty()) {
    throw sfm::InputError("{}: the mask is black; paint the subject white", capture.mask->string());
  }
  return pixels;
}

void CheckExposure(const std::filesystem::path& file, double mean, double saturated) {
  if (!(mean > kBlack)) {
    throw sfm::InputError("{}: is black where the subject is; leave it out with its light",
                          file.string());
  }
  if (saturated > 0.5) {
    throw sfm::InputError("{}: {:.0f} % of the subject is saturated; expose it less", file.string(),
                          100 * saturated);
  }
}

Observations ReadObservations(const OlatCapture& capture, InputEncoding encoding) {
  Observations seen{PixelsInside(capture), {}, {}};
  const std::size_t lights = capture.lights.size();
  seen.values.resize(seen.pixels.size() * lights * 3);
  seen.known.resize(seen.pixels.size() * lights);
  sfm::ProgressLine progress("reading", static_cast<std::int64_t>(lights));
  for (std::size_t i = 0; i < lights; ++i) {
    progress.Update(static_cast<std::int64_t>(i), capture.images[i].filename().string());
    const Image image = ReadLinearImage(capture.images[i], encoding);
    const Color intensity = capture.lights[i].irradiance / std::numbers::pi;
    double sum = 0;
    double saturated = 0;
    for (std::size_t p = 0; p < seen.pixels.size(); ++p) {
      const float* pixel = &image.pixels[static_cast<std::size_t>(seen.pixels[p]) * 3];
      // Files of floats have no largest value: what is above 1 there was measured.
      const float highest = std::max({pixel[0], pixel[1], pixel[2]});
      const bool known = !(highest >= kSaturated && highest <= 1);
      saturated += known ? 0 : 1;
      seen.known[p * lights + i] = known;
      for (int c = 0; c < 3; ++c) {
        sum += pixel[c];
        seen.values[(p * lights + i) * 3 + c] = pixel[c] / static_cast<float>(intensity[c]);
      }
    }
    const auto count = static_cast<double>(seen.pixels.size());
    CheckExposure(capture.images[i], sum / (3 * count), saturated / count);
  }
  return seen;
}

// One pixel: its estimate, and the albedo of each channel.
struct Solved {
  SurfaceEstimate surface;
  Color albedo = Color::Zero();
};

Solved SolvePixel(const PhotometricSolver& solver, const OlatCapture& capture,
                  const Observations& seen, std::size_t p, std::vector<double>& b) {
  const std::size_t lights = capture.lights.size();
  const float* values = &seen.values[p * lights * 3];
  const char* known = &seen.known[p * lights];
  for (std::size_t i = 0; i < lights; ++i) {
    const float* v = values + i * 3;
    b[i] = known[i] ? std::max(0.0f, (v[0] + v[1] + v[2]) / 3) : -1.0;
  }
  Solved solved{solver.Solve(b)};
  const SurfaceEstimate& surface = solved.surface;
  const double tolerance = kAgrees * std::max(surface.residual, 1e-6) * surface.albedo;
  double squares = 0;
  Color products = Color::Zero();
  for (std::size_t i = 0; i < lights; ++i) {
    const double shading = std::max(0.0, capture.lights[i].to_light.dot(surface.normal));
    if (!known[i] || std::abs(b[i] - surface.albedo * shading) > tolerance) continue;
    squares += shading * shading;
    const float* v = values + i * 3;
    products += shading * Color(v[0], v[1], v[2]);
  }
  solved.albedo = squares > 0 ? Color(products / squares) : Color::Constant(surface.albedo);
  return solved;
}

double Median(std::vector<float> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace

PhotometricMaps SolvePhotometricStereo(const OlatCapture& capture, InputEncoding encoding,
                                       const StereoOptions& options) {
  const PhotometricSolver solver(capture.lights, options);
  const Observations seen = ReadObservations(capture, encoding);
  const auto linear = ColorEncoding::kLinear;
  PhotometricMaps maps{Image(capture.width, capture.height, 3, linear),
                       Image(capture.width, capture.height, 3, linear),
                       Image(capture.width, capture.height, 1, linear)};
  const auto count = static_cast<std::int64_t>(seen.pixels.size());
  std::vector<char> robust(seen.pixels.size(), 0);
  sfm::ProgressLine progress("solving", count);
  for (std::int64_t begin = 0; begin < count; begin += kBlock * NumThreads()) {
    progress.Update(begin);
    const std::int64_t block = std::min<std::int64_t>(count - begin, kBlock * NumThreads());
    ParallelFor(block, 64, [&](std::int64_t first, std::int64_t last) {
      std::vector<double> b(capture.lights.size());
      for (auto p = static_cast<std::size_t>(begin + first);
           p < static_cast<std::size_t>(begin + last); ++p) {
        const Solved solved = SolvePixel(solver, capture, seen, p, b);
        if (!(solved.surface.albedo > 0)) continue;
        const auto at = static_cast<std::size_t>(seen.pixels[p]);
        for (int c = 0; c < 3; ++c) {
          maps.normal.pixels[at * 3 + c] = static_cast<float>(solved.surface.normal[c]);
          maps.albedo.pixels[at * 3 + c] = static_cast<float>(solved.albedo[c]);
        }
        maps.residual.pixels[at] = static_cast<float>(solved.surface.residual);
        robust[p] = solved.surface.robust;
      }
    });
  }
  maps.pixels = static_cast<int>(count);
  maps.robust_pixels = static_cast<int>(std::ranges::count(robust, 1));
  std::vector<float> residuals;
  for (const int at : seen.pixels) {
    const float* n = &maps.normal.pixels[static_cast<std::size_t>(at) * 3];
    if (n[0] == 0 && n[1] == 0 && n[2] == 0) {
      ++maps.unknown_pixels;
    } else {
      residuals.push_back(maps.residual.pixels[static_cast<std::size_t>(at)]);
    }
  }
  maps.median_residual = Median(std::move(residuals));
  return maps;
}

InputEncoding EncodingByResidual(const OlatCapture& capture) {
  if (StoresLinearLight(capture.images.front())) return InputEncoding::kLinear;
  StereoOptions plain;
  plain.method = StereoMethod::kLeastSquares;
  const auto residual = [&](InputEncoding encoding) {
    return SolvePhotometricStereo(capture, encoding, plain).median_residual;
  };
  return residual(InputEncoding::kSrgb) <= residual(InputEncoding::kLinear)
             ? InputEncoding::kSrgb
             : InputEncoding::kLinear;
}

Image RelitByNormals(const PhotometricMaps& maps, const DirectionalLight& light) {
  Image relit(maps.normal.width, maps.normal.height, 3, ColorEncoding::kLinear);
  for (std::size_t i = 0; i < relit.pixels.size(); i += 3) {
    const float* n = &maps.normal.pixels[i];
    const double n_dot_l = Vector3d(n[0], n[1], n[2]).dot(light.to_light);
    for (int c = 0; c < 3; ++c) {
      relit.pixels[i + c] = static_cast<float>(maps.albedo.pixels[i + c] * std::max(0.0, n_dot_l) *
                                               light.irradiance[c] / std::numbers::pi);
    }
  }
  return relit;
}

Image NormalsToLookAt(const Image& normal) {
  Image picture(normal.width, normal.height, 3, ColorEncoding::kSrgb);
  for (std::size_t i = 0; i < normal.pixels.size(); i += 3) {
    const float* n = &normal.pixels[i];
    if (n[0] == 0 && n[1] == 0 && n[2] == 0) continue;
    for (int c = 0; c < 3; ++c) picture.pixels[i + c] = 0.5f + 0.5f * n[c];
  }
  return picture;
}

}  // namespace nerf::appearance
