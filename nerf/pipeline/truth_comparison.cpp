#include "nerf/pipeline/truth_comparison.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "nerf/base/input_error.h"
#include "nerf/base/quantile.h"
#include "nerf/base/stopwatch.h"
#include "nerf/field/radiance_field.h"
#include "nerf/image/image_io.h"
#include "nerf/image/image_metrics.h"
#include "nerf/model/evaluation.h"
#include "nerf/pipeline/photograph_lights.h"
#include "nerf/relight/relit_view.h"

namespace nerf {
namespace {

namespace fs = std::filesystem;

// A held-out view with its truth, and what the surface and the field show there.
struct ComparedView {
  const TruthView* truth;
  RenderedView rendered;
  SeenSurface seen;
  torch::Tensor density_normal;  // [P,3] of the field's density
  torch::Tensor radiance;        // [P,3] linear, that the field shows
};

const TruthView* TruthOf(const TruthFolder& truth, const std::string& image) {
  const fs::path name(image);
  const auto found = std::ranges::find_if(truth.views, [&](const TruthView& view) {
    return view.name == image || view.name == name.stem() ||
           view.name == name.parent_path().filename();
  });
  return found == truth.views.end() ? nullptr : &*found;
}

Image ReadTruth(const fs::path& file, const Camera& camera) {
  Image truth = ReadImage(file, false);
  if (truth.width == camera.width && truth.height == camera.height) return truth;
  throw InputError("{}: has {}x{} pixels, the held-out view {}x{}; give truth of its size",
                   file.string(), truth.width, truth.height, camera.width, camera.height);
}

// [P,3] from its density's gradient, towards where it falls.
torch::Tensor DensityNormals(const Model& model, const torch::Tensor& position) {
  std::vector<torch::Tensor> parts;
  constexpr std::int64_t kChunk = 1 << 14;
  for (std::int64_t begin = 0; begin < position.size(0); begin += kChunk) {
    const torch::Tensor at = position.slice(0, begin, std::min(position.size(0), begin + kChunk));
    // Contracted space is the scene itself inside the unit ball, where surfaces are.
    torch::Tensor in_cube = (at / 4 + 0.5).clamp(0, 1).set_requires_grad(true);
    const torch::Tensor sum = model.field->ContractedDensity(in_cube).sum();
    const torch::Tensor gradient = torch::autograd::grad({sum}, {in_cube})[0];
    parts.push_back(-gradient / gradient.norm(2, 1, true).clamp_min(1e-12));
  }
  return parts.empty() ? torch::zeros({0, 3}) : torch::cat(parts);
}

class Comparison {
 public:
  Comparison(const OpenedRun& run, Materials materials, const TruthFolder& truth, int bounces,
             const std::function<void(std::size_t, std::size_t)>& progress)
      : run_(run),
        frame_(run.model->Scene().normalized_from_world),
        materials_(std::move(materials)),
        truth_(truth),
        bounces_(bounces),
        progress_(progress),
        relighter_(materials_.surface) {}

  TruthComparison Run() {
    const std::vector<const PosedImage*> images = ImagesOf(run_.posed, Split::kTest);
    steps_ = images.size() + truth_.lights.size();
    for (const PosedImage* image : images) {
      Look(*image);
      progress_(++done_, steps_);
    }
    if (views_.empty()) throw InputError("the truth has none of the held-out views of the run");
    result_.views = std::ssize(views_);
    Normals();
    Roughness();
    const auto found = [](const ComparedView& view) {
      torch::Tensor albedo = view.seen.material.base_color;
      if (!view.seen.material.IsMatt()) {
        albedo = albedo * (1 - view.seen.material.metallic.unsqueeze(1));
      }
      return albedo;
    };
    Albedo(found, result_.found);
    Albedo([](const ComparedView& view) { return view.radiance; }, result_.trivial);
    Relit();
    return std::move(result_);
  }

 private:
  void Look(const PosedImage& image) {
    const TruthView* truth = TruthOf(truth_, image.name);
    if (truth == nullptr) return;
    ComparedView view{truth, {}, {}, {}, {}};
    const Camera& camera = run_.posed.cameras[static_cast<std::size_t>(image.camera)];
    view.rendered = run_.model->Render({camera, image.world_from_camera});
    view.seen = relighter_.See({camera, frame_.NormalizedFromCamera(image.world_from_camera),
                                view.rendered.depth, view.rendered.opacity});
    view.density_normal = DensityNormals(run_.model->GetModel(), view.seen.position);
    view.radiance = torch::empty_like(view.seen.normal);
    const bool is_linear = view.rendered.rgb.encoding == ColorEncoding::kLinear;
    for (std::size_t i = 0; i < view.seen.pixels.size(); ++i) {
      for (int c = 0; c < 3; ++c) {
        const auto p = static_cast<std::size_t>(view.seen.pixels[i]);
        const float value = view.rendered.rgb.pixels[3 * p + c];
        view.radiance.data_ptr<float>()[3 * i + c] = is_linear ? value : LinearFromSrgb(value);
      }
    }
    cameras_.push_back(camera);
    views_.push_back(std::move(view));
  }

  // Of pixels with truth; those that the surface lacks are off by 90 degrees.
  void Normals() {
    std::array<double, 2> sums = {0, 0};
    double count = 0;
    for (std::size_t i = 0; i < views_.size(); ++i) {
      const ComparedView& view = views_[i];
      if (!view.truth->normal) continue;
      const Image truth = ReadTruth(*view.truth->normal, cameras_[i]);
      const bool is_encoded = truth.encoding == ColorEncoding::kSrgb;  // n / 2 + 1/2 in a PNG
      std::vector<std::int64_t> row_of(truth.pixels.size() / truth.channels, -1);
      for (std::size_t r = 0; r < view.seen.pixels.size(); ++r) {
        row_of[static_cast<std::size_t>(view.seen.pixels[r])] = static_cast<std::int64_t>(r);
      }
      for (std::size_t p = 0; p < row_of.size(); ++p) {
        const float* const pixel = &truth.pixels[truth.channels * p];
        Eigen::Vector3f expected(pixel[0], pixel[1], pixel[2]);
        if (is_encoded) expected = 2 * expected - Eigen::Vector3f::Ones();
        const bool has_truth = truth.channels < 4 || pixel[kAlphaChannel] > 0.5f;
        if (!has_truth || expected.norm() < 0.5f) continue;
        ++count;
        const auto angle = [&](const torch::Tensor& normals) {
          if (row_of[p] < 0) return 90.0;
          const Eigen::Vector3f n(normals.data_ptr<float>() + 3 * row_of[p]);
          const double cosine = (frame_.rotation.transpose() * n.cast<double>())
                                    .dot(expected.cast<double>().normalized());
          return std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
        };
        sums[0] += angle(view.seen.normal);
        sums[1] += angle(view.density_normal);
      }
    }
    if (count == 0) return;
    result_.found.normal_degrees = sums[0] / count;
    result_.trivial.normal_degrees = sums[1] / count;
  }

  void Roughness() {
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < views_.size(); ++i) {
      const ComparedView& view = views_[i];
      if (!view.truth->material || view.seen.material.IsMatt()) continue;
      const Image truth = ReadTruth(*view.truth->material, cameras_[i]);
      const torch::Tensor roughness = view.seen.material.roughness.contiguous();
      for (std::size_t r = 0; r < view.seen.pixels.size(); ++r) {
        const float expected =
            truth.pixels[truth.channels * static_cast<std::size_t>(view.seen.pixels[r])];
        if (expected == 0) continue;  // outside
        sum += std::abs(static_cast<double>(roughness.data_ptr<float>()[r] - expected));
        ++count;
      }
    }
    if (count > 0) result_.found.roughness_error = sum / count;
  }

  // PSNR of a view of which the colours of seen pixels are linear.
  double PsnrOf(const ComparedView& view, const torch::Tensor& linear, const Image& truth) const {
    Image shown(truth.width, truth.height, 4, ColorEncoding::kLinear);
    const torch::Tensor plain = linear.contiguous();
    for (std::size_t r = 0; r < view.seen.pixels.size(); ++r) {
      const auto p = static_cast<std::size_t>(view.seen.pixels[r]);
      std::copy_n(plain.data_ptr<float>() + 3 * r, 3, &shown.pixels[4 * p]);
      shown.pixels[4 * p + 3] = view.rendered.opacity.pixels[p];
    }
    return Psnr(shown, truth);
  }

  template <class AlbedoOf>
  void Albedo(const AlbedoOf& albedo_of, TruthScores& scores) {
    constexpr float kWhole = 0.999f, kDark = 1e-3f;
    std::array<std::vector<double>, 3> ratios;
    std::vector<Image> truths(views_.size());
    double views = 0;
    for (std::size_t i = 0; i < views_.size(); ++i) {
      const ComparedView& view = views_[i];
      if (!view.truth->albedo) continue;
      truths[i] = ReadTruth(*view.truth->albedo, cameras_[i]);
      truths[i].encoding = ColorEncoding::kLinear;  // TensoIR's PNG are linear
      const Image& truth = truths[i];
      const torch::Tensor albedo = albedo_of(view).contiguous();
      ++views;
      for (std::size_t r = 0; r < view.seen.pixels.size(); ++r) {
        const float* const pixel =
            &truth.pixels[truth.channels * static_cast<std::size_t>(view.seen.pixels[r])];
        if (truth.channels > 3 && pixel[kAlphaChannel] < kWhole) continue;
        for (int c = 0; c < 3; ++c) {
          const float found = albedo.template data_ptr<float>()[3 * r + c];
          if (pixel[c] > kDark && found > kDark) {
            ratios[static_cast<std::size_t>(c)].push_back(static_cast<double>(pixel[c] / found));
          }
        }
      }
    }
    if (views == 0) return;
    for (std::size_t c = 0; c < 3; ++c) {
      scores.scale[c] = ratios[c].empty() ? 1 : Median(ratios[c]);
    }
    double scaled = 0, unscaled = 0;
    for (std::size_t i = 0; i < views_.size(); ++i) {
      if (!views_[i].truth->albedo) continue;
      const torch::Tensor albedo = albedo_of(views_[i]);
      const torch::Tensor scale =
          torch::tensor({scores.scale[0], scores.scale[1], scores.scale[2]}, albedo.options());
      scaled += PsnrOf(views_[i], albedo * scale, truths[i]);
      unscaled += PsnrOf(views_[i], albedo, truths[i]);
    }
    scores.albedo_psnr = scaled / views;
    scores.albedo_psnr_unscaled = unscaled / views;
  }

  void Relit() {
    MaterialEdit scale;
    scale.scale_color = result_.found.scale;
    materials_.surface.edits.push_back(scale);
    for (ComparedView& view : views_) Apply(scale, view.seen.position, view.seen.material);
    double lights = 0, views = 0;
    for (const auto& [name, light] : truth_.lights) {
      const Stopwatch watch;
      PlannedLight planned;
      planned.environment = EnvironmentMap::Read(light.map);
      planned.exposure = std::log2(light.gain);
      relighter_.SetLight(LightInFrame(planned, frame_, materials_.surface.Directions()), bounces_);
      result_.light_seconds += watch.Seconds();
      ++lights;
      double psnr = 0, trivial = 0, count = 0;
      for (std::size_t i = 0; i < views_.size(); ++i) {
        const auto file = views_[i].truth->relit.find(name);
        if (file == views_[i].truth->relit.end()) continue;
        const Image truth = ReadTruth(file->second, cameras_[i]);
        const Stopwatch reflecting;
        const RelitPixels relit = relighter_.Reflect(views_[i].seen);
        result_.view_seconds += reflecting.Seconds();
        ++views;
        ++count;
        psnr += PsnrOf(views_[i], relit.direct + relit.indirect, truth);
        trivial += PsnrOf(views_[i], views_[i].radiance, truth);
      }
      if (count > 0) {
        result_.found.relit_psnr[name] = psnr / count;
        result_.trivial.relit_psnr[name] = trivial / count;
      }
      progress_(++done_, steps_);
    }
    result_.light_seconds /= std::max(1.0, lights);
    result_.view_seconds /= std::max(1.0, views);
  }

  const OpenedRun& run_;
  const SceneNormalization& frame_;
  Materials materials_;
  const TruthFolder& truth_;
  int bounces_;
  const std::function<void(std::size_t, std::size_t)>& progress_;
  Relighter relighter_;
  std::vector<ComparedView> views_;
  std::vector<Camera> cameras_;  // of them
  std::size_t done_ = 0, steps_ = 0;
  TruthComparison result_;
};

}  // namespace

TruthComparison CompareWithTruth(
    const OpenedRun& run, Materials materials, const TruthFolder& truth, int bounces,
    const std::function<void(std::size_t done, std::size_t of)>& progress) {
  return Comparison(run, std::move(materials), truth, bounces, progress).Run();
}

}  // namespace nerf
