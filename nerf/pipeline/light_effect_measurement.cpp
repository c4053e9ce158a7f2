#include "nerf/pipeline/light_effect_measurement.h"

#include <algorithm>
#include <utility>

#include "nerf/base/input_error.h"
#include "nerf/base/stopwatch.h"
#include "nerf/image/image_metrics.h"
#include "nerf/model/evaluation.h"
#include "nerf/relight/relit_view.h"

namespace nerf {
namespace {

constexpr int kAllBounces = 2;

// A held-out photograph, and what of the surface it shows.
struct HeldOut {
  Image photograph;  // on white, where it has alpha
  DepthMap depth;
};

std::vector<HeldOut> HeldOutViews(const OpenedRun& run) {
  const SceneFacts& scene = run.model->Scene();
  const std::vector<const PosedImage*> images = ImagesOf(run.posed, Split::kTest);
  if (images.empty()) throw InputError("the run has no held-out photographs");
  const int downscale = run.model->GetConfig().data.downscale;
  std::vector<HeldOut> views;
  Evaluate(*run.model, run.posed, images, {}, [&](const EvaluatedView& view) {
    const Camera camera =
        Downscaled(run.posed.cameras[static_cast<std::size_t>(view.image->camera)], downscale);
    const RenderedView rendered = run.model->Render({camera, view.image->world_from_camera});
    views.push_back(
        {*view.truth,
         {camera, scene.normalized_from_world.NormalizedFromCamera(view.image->world_from_camera),
          rendered.depth, rendered.opacity}});
  });
  if (views.empty()) throw InputError("none of the held-out photographs can be read");
  return views;
}

// The mean PSNR of the opaque pixels on white, with and without the light of the facets.
struct Score {
  double psnr = 0, psnr_without_specular = 0;
  double seconds = 0;  // of a view
};

Image Shown(const HeldOut& view, const SeenSurface& seen, const torch::Tensor& linear) {
  Image shown(view.depth.camera.width, view.depth.camera.height, 4, ColorEncoding::kLinear);
  const torch::Tensor plain = linear.contiguous();
  for (std::size_t i = 0; i < seen.pixels.size(); ++i) {
    const auto p = static_cast<std::size_t>(seen.pixels[i]);
    std::copy_n(plain.data_ptr<float>() + 3 * i, 3, &shown.pixels[4 * p]);
    shown.pixels[4 * p + 3] = view.depth.opacity.pixels[p];
  }
  return shown;
}

Score ScoreOf(const std::vector<HeldOut>& views, const RelightableSurface& surface, int bounces,
              const std::function<void()>& done) {
  const Stopwatch watch;
  Relighter relighter(surface);
  relighter.SetLight(surface.lights.front(), bounces);
  Score score;
  for (const HeldOut& view : views) {
    const SeenSurface seen = relighter.See(view.depth);
    const RelitPixels relit = relighter.Reflect(seen);
    const torch::Tensor sum = relit.direct + relit.indirect;
    score.psnr += Psnr(Shown(view, seen, sum), view.photograph);
    score.psnr_without_specular += Psnr(Shown(view, seen, sum - relit.specular), view.photograph);
    done();
  }
  const auto count = static_cast<double>(views.size());
  return {score.psnr / count, score.psnr_without_specular / count, watch.Seconds() / count};
}

}  // namespace

LightEffectMeasurements MeasureLightEffects(
    const OpenedRun& run, const Materials& materials,
    const std::function<void(std::size_t done, std::size_t of)>& progress) {
  const std::vector<HeldOut> views = HeldOutViews(run);
  const RelightableSurface& surface = materials.surface;
  const std::size_t passes = 1 + (surface.has_shadows ? 1 : 0) + (surface.has_bounces ? 1 : 0);
  std::size_t done = 0;
  const auto step = [&] { progress(++done, passes * views.size()); };
  const Score all = ScoreOf(views, surface, kAllBounces, step);
  LightEffectMeasurements result;
  result.psnr = all.psnr;
  if (surface.has_shadows) {
    RelightableSurface unshadowed = surface;
    unshadowed.has_shadows = false;
    const Score without = ScoreOf(views, unshadowed, 0, step);
    result.effects.push_back({"shadows", without.psnr, all.seconds, without.seconds});
  }
  if (surface.has_bounces) {
    const Score without = ScoreOf(views, surface, 0, step);
    result.effects.push_back({"bounces", without.psnr, all.seconds, without.seconds});
  }
  if (!surface.field->IsMatt()) {
    result.effects.push_back({"specular", all.psnr_without_specular, all.seconds, all.seconds});
  }
  return result;
}

}  // namespace nerf
