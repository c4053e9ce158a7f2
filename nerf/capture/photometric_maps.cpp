#include "nerf/capture/photometric_maps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

#include "nerf/base/input_error.h"
#include "nerf/base/parallel.h"
#include "nerf/base/progress.h"
#include "nerf/base/quantile.h"
#include "nerf/image/mask.h"

namespace nerf {
namespace {

using Eigen::Vector3d;

constexpr float kSaturated = 0.998f;  // relative to the largest integer value
constexpr double kBlack = 1e-4;       // largest mean of a black image of integers
constexpr double kOutlier = 3;        // residuals; farther observations are not used for the albedo
constexpr std::int64_t kBlock = 4096;            // pixels per thread between progress updates
constexpr std::size_t kEncodingPixels = 20'000;  // used to distinguish sRGB from linear

// The observations of some pixels.
struct Observations {
  std::span<const int> pixels;  // index y * width + x
  std::vector<float> values;    // [pixel][light][channel], divided by the intensity of the light
  std::vector<char> known;      // [pixel][light]: not saturated

  static constexpr std::size_t kBytes = 3 * sizeof(float) + sizeof(char);  // per pixel and light
};

std::vector<int> PixelsInside(const OlatCapture& capture) {
  const int count = capture.width * capture.height;
  std::vector<int> pixels;
  for (int i = 0; i < count; ++i) pixels.push_back(i);
  for (const std::filesystem::path& file : capture.masks) {
    const Image mask = ReadMaskCoverage(file, true);
    std::erase_if(pixels,
                  [&](int i) { return !(mask.pixels[static_cast<std::size_t>(i)] > 0.5f); });
    if (pixels.empty()) {
      throw InputError("{}: the mask is black; paint the subject white", file.string());
    }
  }
  return pixels;
}

// Whether a channel of a pixel may be clipped.
bool IsSaturated(const float* pixel) {
  return std::max({pixel[0], pixel[1], pixel[2]}) >= kSaturated;
}

void CheckExposure(const std::filesystem::path& file, const Image& image, bool integers,
                   std::span<const int> pixels) {
  double sum = 0;
  double saturated = 0;
  for (const int at : pixels) {
    const float* pixel = &image.pixels[static_cast<std::size_t>(at) * 3];
    sum += (pixel[0] + pixel[1] + pixel[2]) / 3;
    saturated += integers && IsSaturated(pixel) ? 1 : 0;
  }
  const auto count = static_cast<double>(pixels.size());
  // Floats have an arbitrary unit, however small.
  if (!(sum / count > (integers ? kBlack : 0))) {
    throw InputError("{}: the subject is black; remove the image and its light", file.string());
  }
  if (saturated / count > 0.5) {
    throw InputError("{}: {:.0f} % of the subject is saturated; use a shorter exposure",
                     file.string(), 100 * saturated / count);
  }
}

// Reads the observations of `pixels` from all images.
//   check  pixels that must not be black or mostly saturated; empty: has been checked
Observations ReadObservations(const OlatCapture& capture, InputEncoding encoding,
                              std::span<const int> pixels, std::span<const int> check) {
  const std::size_t lights = capture.lights.size();
  Observations observed{pixels, std::vector<float>(pixels.size() * lights * 3),
                        std::vector<char>(pixels.size() * lights)};
  ProgressLine progress("reading", static_cast<std::int64_t>(lights));
  for (std::size_t i = 0; i < lights; ++i) {
    const auto& file = capture.images[i];
    progress.Update(static_cast<std::int64_t>(i), file.filename().string());
    const Image image = ReadLinearImage(file, encoding);
    const bool integers = StoresIntegers(file);
    if (!check.empty()) CheckExposure(file, image, integers, check);
    const Color intensity = capture.lights[i].irradiance / std::numbers::pi;
    for (std::size_t p = 0; p < pixels.size(); ++p) {
      const float* pixel = &image.pixels[static_cast<std::size_t>(pixels[p]) * 3];
      observed.known[p * lights + i] = !(integers && IsSaturated(pixel));
      for (int c = 0; c < 3; ++c) {
        observed.values[(p * lights + i) * 3 + c] = pixel[c] / static_cast<float>(intensity[c]);
      }
    }
  }
  return observed;
}

// The estimate of a pixel with the albedo of each channel.
struct Solved {
  SurfaceEstimate surface;
  Color albedo = Color::Zero();
};

Solved SolvePixel(const PhotometricSolver& solver, const OlatCapture& capture,
                  const Observations& observed, std::size_t p, std::vector<double>& b) {
  const std::size_t lights = capture.lights.size();
  const float* values = &observed.values[p * lights * 3];
  const char* known = &observed.known[p * lights];
  for (std::size_t i = 0; i < lights; ++i) {
    const float* v = values + i * 3;
    b[i] = known[i] ? std::max(0.0f, (v[0] + v[1] + v[2]) / 3) : -1.0;
  }
  Solved solved{solver.Solve(b)};
  const SurfaceEstimate& surface = solved.surface;
  const double tolerance = kOutlier * std::max(surface.residual, 1e-6) * surface.albedo;
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

// Solves the observed pixels in parallel and stores them in the maps.
//   solved  number of pixels solved before, for the progress line
void SolvePixels(const PhotometricSolver& solver, const OlatCapture& capture,
                 const Observations& observed, std::int64_t solved, ProgressLine& progress,
                 PhotometricMaps& maps) {
  const auto count = std::ssize(observed.pixels);
  std::vector<char> robust(observed.pixels.size(), 0);
  for (std::int64_t begin = 0; begin < count; begin += kBlock * NumThreads()) {
    progress.Update(solved + begin);
    const std::int64_t block = std::min<std::int64_t>(count - begin, kBlock * NumThreads());
    ParallelFor(block, 64, [&](std::int64_t first, std::int64_t last) {
      std::vector<double> b(capture.lights.size());
      for (auto p = static_cast<std::size_t>(begin + first);
           p < static_cast<std::size_t>(begin + last); ++p) {
        const Solved pixel = SolvePixel(solver, capture, observed, p, b);
        if (!(pixel.surface.albedo > 0)) continue;
        const auto at = static_cast<std::size_t>(observed.pixels[p]);
        for (int c = 0; c < 3; ++c) {
          maps.normal.pixels[at * 3 + c] = static_cast<float>(pixel.surface.normal[c]);
          maps.albedo.pixels[at * 3 + c] = static_cast<float>(pixel.albedo[c]);
        }
        maps.residual.pixels[at] = static_cast<float>(pixel.surface.residual);
        robust[p] = pixel.surface.robust;
      }
    });
  }
  maps.robust_pixels += static_cast<int>(std::ranges::count(robust, 1));
}

void Summarise(std::span<const int> pixels, PhotometricMaps& maps) {
  std::vector<float> residuals;
  for (const int at : pixels) {
    const float* n = &maps.normal.pixels[static_cast<std::size_t>(at) * 3];
    if (n[0] == 0 && n[1] == 0 && n[2] == 0) {
      ++maps.unsolved_pixels;
    } else {
      residuals.push_back(maps.residual.pixels[static_cast<std::size_t>(at)]);
    }
  }
  maps.pixels = static_cast<int>(pixels.size());
  maps.median_residual = UpperMedian(residuals);
}

// Solves the pixels inside the mask, or about `max_pixels` evenly spread ones.
PhotometricMaps SolveSome(const OlatCapture& capture, InputEncoding encoding,
                          const StereoOptions& options, std::int64_t memory,
                          std::size_t max_pixels) {
  const PhotometricSolver solver(capture.lights, options);
  const std::vector<int> inside = PixelsInside(capture);
  std::vector<int> pixels;
  const std::size_t step = std::max<std::size_t>(1, inside.size() / max_pixels);
  for (std::size_t i = 0; i < inside.size(); i += step) pixels.push_back(inside[i]);
  const auto linear = ColorEncoding::kLinear;
  PhotometricMaps maps{Image(capture.width, capture.height, 3, linear),
                       Image(capture.width, capture.height, 3, linear),
                       Image(capture.width, capture.height, 1, linear)};
  const auto bytes = static_cast<std::int64_t>(Observations::kBytes * capture.lights.size());
  const auto at_once = static_cast<std::size_t>(std::max<std::int64_t>(1, memory / bytes));
  ProgressLine progress("solving", std::ssize(pixels));
  for (std::size_t begin = 0; begin < pixels.size(); begin += at_once) {
    const auto part = std::span(pixels).subspan(begin, std::min(at_once, pixels.size() - begin));
    const auto check = begin == 0 ? std::span<const int>(inside) : std::span<const int>();
    const Observations observed = ReadObservations(capture, encoding, part, check);
    SolvePixels(solver, capture, observed, static_cast<std::int64_t>(begin), progress, maps);
  }
  Summarise(pixels, maps);
  return maps;
}

}  // namespace

PhotometricMaps SolvePhotometricStereo(const OlatCapture& capture, InputEncoding encoding,
                                       const StereoOptions& options, std::int64_t memory) {
  return SolveSome(capture, encoding, options, memory, std::numeric_limits<std::size_t>::max());
}

InputEncoding EncodingByResidual(const OlatCapture& capture) {
  if (StoresLinearLight(capture.images.front())) return InputEncoding::kLinear;
  StereoOptions plain;
  plain.method = StereoMethod::kLeastSquares;
  const auto residual = [&](InputEncoding encoding) {
    return SolveSome(capture, encoding, plain, kObservationBytes, kEncodingPixels).median_residual;
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

Image NormalsAsColors(const Image& normal) {
  Image picture(normal.width, normal.height, 3, ColorEncoding::kSrgb);
  for (std::size_t i = 0; i < normal.pixels.size(); i += 3) {
    const float* n = &normal.pixels[i];
    if (n[0] == 0 && n[1] == 0 && n[2] == 0) continue;
    for (int c = 0; c < 3; ++c) picture.pixels[i + c] = 0.5f + 0.5f * n[c];
  }
  return picture;
}

}  // namespace nerf
