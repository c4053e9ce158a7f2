// Fits Gaussians to a capture for some seconds, and prints the PSNR on validation and held-out
// photographs:
//   splat_fit INPUT DOWNSCALE SECONDS|ITERATIONSi BEGIN [between=N] [splat option=value ...]
// BEGIN, one of points, hull, random, RUN, or two with a plus, says where Gaussians begin: at the
// input's sparse points, at the visual hull of what is opaque, at random points, or at the surfaces
// of the field of a trained run of the same photographs. The time that this takes is part of
// SECONDS, that of training the field is not. between=N adds N views that the field of RUN renders
// between the cameras.
#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <string>

#include "nerf/base/peak_memory.h"
#include "nerf/base/quantile.h"
#include "nerf/base/stopwatch.h"
#include "nerf/model/run_folder.h"
#include "nerf/pipeline/prepared_scene.h"
#include "nerf/pipeline/surface_points.h"
#include "nerf/scene/camera.h"
#include "nerf/splats/gaussian_camera.h"
#include "nerf/splats/gaussian_fit.h"
#include "nerf/splats/initial_gaussians.h"
#include "nerf/splats/target_pictures.h"
#include "nerf/splats/visual_hull.h"

namespace nerf {
namespace {

constexpr double kNear = 0.02;

double Psnr(const std::vector<View>& views, bool has_alpha, const GaussianCloud& cloud) {
  GaussianRenderer renderer;
  double sum = 0;
  for (const TargetView& view : TargetViewsOf(views)) {
    const TargetPicture target = TargetOf(view);
    const GaussianPicture& drawn = renderer.Draw(
        MakeGaussianCamera(view.camera, view.normalized_from_camera, kNear), cloud.Parameters());
    const float background = has_alpha ? 1.0f : 0.0f;
    double error = 0, count = 0;
    for (int y = 0; y < target.height; ++y) {
      for (int x = 0; x < target.width; ++x) {
        if (target.Row(TargetPicture::kWeight, y)[x] == 0) continue;
        const float T = drawn.Plane(3)[y * drawn.stride + x];
        const float opacity = target.Row(TargetPicture::kOpacity, y)[x];
        for (int c = 0; c < 3; ++c) {
          const auto rounded = [](float v) {
            return std::round(std::clamp(v, 0.0f, 1.0f) * 255) / 255;
          };
          const float shown = target.Row(c, y)[x] * opacity + (1 - opacity) * background;
          const float d =
              rounded(drawn.Plane(c)[y * drawn.stride + x] + T * background) - rounded(shown);
          error += d * d;
          ++count;
        }
      }
    }
    sum += -10 * std::log10(error / count);
  }
  return views.empty() ? 0 : sum / static_cast<double>(views.size());
}

// Views that the field of a run renders halfway between neighbouring cameras, at half the
// resolution.
std::vector<View> ViewsBetween(const std::filesystem::path& folder,
                               const std::vector<TargetView>& views, std::size_t count) {
  const OpenedRun run = OpenRun(folder);
  const SceneNormalization& frame = run.model->Scene().normalized_from_world;
  std::vector<View> between;
  for (std::size_t i = 0; i < count; ++i) {
    const TargetView& view = views[i * views.size() / count];
    const auto distance = [&](const TargetView& other) {
      const double d =
          (other.normalized_from_camera.translation() - view.normalized_from_camera.translation())
              .norm();
      return d > 0 ? d : std::numeric_limits<double>::infinity();
    };
    const TargetView& other = *std::ranges::min_element(views, {}, distance);
    View made;
    made.camera = Downscaled(view.camera, 2);
    made.normalized_from_camera =
        Eigen::Translation3d((view.normalized_from_camera.translation() +
                              other.normalized_from_camera.translation()) /
                             2) *
        Eigen::Quaterniond(view.normalized_from_camera.linear())
            .slerp(0.5, Eigen::Quaterniond(other.normalized_from_camera.linear()));
    const RenderedView rendered =
        run.model->Render({made.camera, frame.WorldFromCamera(made.normalized_from_camera)});
    for (std::size_t k = 0; k < rendered.opacity.pixels.size(); ++k) {
      // What has alpha is rendered before white.
      const float alpha = run.model->Scene().has_alpha ? rendered.opacity.pixels[k] : 1;
      for (int c = 0; c < 3; ++c) {
        const float straight = (rendered.rgb.pixels[3 * k + c] - (1 - alpha)) / alpha;
        made.rgba.push_back(static_cast<Eigen::half>(alpha > 0 ? straight : 0.0f));
      }
      made.rgba.push_back(static_cast<Eigen::half>(alpha));
    }
    between.push_back(std::move(made));
  }
  return between;
}

void SetOption(SplatOptions& options, const std::string& assignment) {
  const auto at = assignment.find('=');
  const std::string name = assignment.substr(0, at);
  const double value = std::stod(assignment.substr(at + 1));
  bool found = false;
  SplatOptions::Options(options, [&](const char* key, auto& field, const auto&...) {
    if (name != key) return;
    field = static_cast<std::remove_reference_t<decltype(field)>>(value);
    found = true;
  });
  if (!found) throw std::runtime_error(name);
}

std::vector<ColoredPoint> SparsePoints(const PreparedScene& scene) {
  std::vector<ColoredPoint> points;
  for (const SparsePoint& point : scene.posed.points) {
    points.push_back({scene.normalized_from_world.NormalizedFromWorld(point.x_in_world),
                      Eigen::Vector3f(point.rgb[0], point.rgb[1], point.rgb[2]) / 255});
  }
  return points;
}

std::vector<ColoredPoint> RandomPoints(int count) {
  std::vector<ColoredPoint> points;
  for (int i = 0; i < count; ++i) {
    points.push_back({Eigen::Vector3d::Random() * 0.7, {0.5f, 0.5f, 0.5f}});
  }
  return points;
}

std::vector<ColoredPoint> PointsOf(const std::string& begin, const PreparedScene& scene,
                                   const std::vector<TargetView>& views, int count) {
  if (const auto plus = begin.find('+'); plus != std::string::npos) {
    std::vector<ColoredPoint> points = PointsOf(begin.substr(0, plus), scene, views, count);
    const std::vector<ColoredPoint> others = PointsOf(begin.substr(plus + 1), scene, views, count);
    points.insert(points.end(), others.begin(), others.end());
    return points;
  }
  if (begin == "points") return SparsePoints(scene);
  if (begin == "random") return RandomPoints(count / 2);
  if (begin == "hull") return VisualHull(views, count);
  const OpenedRun run = OpenRun(begin);
  return FindSurfacePoints(*run.model, views, count, false, [](std::size_t) {})->points;
}

void Run(int argc, char** argv) {
  if (argc < 5)
    throw std::runtime_error("splat_fit INPUT DOWNSCALE SECONDS BEGIN [option=value ...]");
  DataOptions data;
  data.downscale = std::stoi(argv[2]);
  // 30: seconds; 2000i: iterations
  const double length = std::stod(argv[3]);
  const bool by_steps = std::string(argv[3]).back() == 'i';
  SplatOptions options;
  std::size_t between = 0;
  for (int i = 5; i < argc; ++i) {
    const std::string option = argv[i];
    if (option.starts_with("between=")) {
      between = std::stoul(option.substr(8));
    } else {
      SetOption(options, option);
    }
  }
  if (options.count == 0) options.count = 50000;
  const PipelineListener listener = [](const auto&) {};
  PreparedScene scene = PrepareScene(argv[1], "out/splat_fit", data, listener);
  const Dataset train = LoadDataset(scene.posed, data, {}, scene.normalized_from_world);
  PosedImages held_out = scene.posed;
  for (PosedImage& image : held_out.images) {
    if (image.split == Split::kTest)
      image.split = Split::kValidation;
    else if (image.split == Split::kValidation)
      image.split = Split::kTest;
  }
  const Dataset test = LoadDataset(held_out, data, {}, scene.normalized_from_world);
  std::vector<TargetView> views = TargetViewsOf(train.train);
  const std::vector<View> made =
      between > 0 ? ViewsBetween(argv[4], views, between) : std::vector<View>();
  const Stopwatch watch;
  const std::vector<ColoredPoint> points = PointsOf(argv[4], scene, views, options.count);
  for (const TargetView& view : TargetViewsOf(made)) views.push_back(view);
  GaussianFit fit(views, train.has_alpha,
                  BeginFit(GaussiansAtPoints(points, options.count, options.harmonics_order, 1)),
                  options, kNear, 1);
  fmt::print("{} points, set up in {:.2f} s, {} train views\n", points.size(), watch.Seconds(),
             train.train.size());
  double next = length / 4;
  double pause = 0;
  while (true) {
    const double spent = watch.Seconds() - pause;
    const double reached = by_steps ? static_cast<double>(fit.Steps()) : spent;
    if (reached >= next) {
      const Stopwatch evaluating;
      fmt::print(
          "{:6.1f} s {:6} iterations, {:.1f} ms each: validation {:.2f}, held out {:.2f} dB\n",
          spent, fit.Steps(), 1e3 * spent / std::max<std::int64_t>(1, fit.Steps()),
          Psnr(train.validation, train.has_alpha, fit.Cloud()),
          Psnr(test.validation, train.has_alpha, fit.Cloud()));
      std::fflush(stdout);
      pause += evaluating.Seconds();
      next += length / 4;
      if (reached >= length) break;
    }
    const double loss = fit.Step({std::min(1.0, reached / length), by_steps ? length : 2000});
    if (!std::isfinite(loss)) {
      fmt::print("the loss of iteration {} is not finite\n", fit.Steps());
      return;
    }
  }
  GaussianRenderer renderer;
  std::vector<double> frames;
  for (int round = 0; round < 3; ++round) {
    for (const View& view : train.train) {
      const kernels::GaussianCamera camera =
          MakeGaussianCamera(view.camera, view.normalized_from_camera, kNear);
      const Stopwatch frame;
      renderer.Draw(camera, fit.Cloud().Parameters());
      frames.push_back(1e3 * frame.Seconds());
    }
  }
  fmt::print("a frame {:.2f} ms in the median\n", Median(frames));
  fmt::print("training views {:.2f} dB, peak {:.0f} MB\n",
             Psnr(train.train, train.has_alpha, fit.Cloud()), PeakMegabytes());
}

}  // namespace
}  // namespace nerf

int main(int argc, char** argv) { nerf::Run(argc, argv); }
