#include "nerf/render/volume_rendering.h"

#include <cmath>

#include "nerf/base/parallel.h"
#include "nerf/field/tensor_span.h"
#include "nerf/kernels/volume_rendering.h"

namespace nerf {
namespace {

constexpr std::int64_t kMinRaysPerThread = 16;

template <class Real>
kernels::RaySegments<Real> Segments(const torch::autograd::variable_list& v) {
  return {Span<const std::int64_t>(v[0]), Span<const Real>(v[1]), Span<const Real>(v[3]),
          Span<const Real>(v[4]),         Span<const Real>(v[2]), Span<const Real>(v[5])};
}

// Throws c10::Error with the index of the first ray whose intervals have a negative length or are
// out of order, or NaN.
void CheckOrder(const torch::Tensor& ray_begin, const torch::Tensor& dt, const torch::Tensor& t) {
  const auto begin = Span<const std::int64_t>(ray_begin);
  AT_DISPATCH_FLOATING_TYPES(dt.scalar_type(), "check_order", [&] {
    const auto lengths = Span<const scalar_t>(dt), places = Span<const scalar_t>(t);
    for (std::size_t r = 0; r + 1 < begin.size(); ++r) {
      for (std::int64_t i = begin[r]; i < begin[r + 1]; ++i) {
        TORCH_CHECK(lengths[i] >= 0, "RenderVolume: ray ", r, ": dt is ", lengths[i], " at sample ",
                    i, "; it must be 0 or more");
        TORCH_CHECK(i == begin[r] ? !std::isnan(places[i]) : places[i] >= places[i - 1],
                    "RenderVolume: ray ", r, ": t decreases or is NaN at sample ", i);
      }
    }
  });
}

struct VolumeRenderingFunction : torch::autograd::Function<VolumeRenderingFunction> {
  static torch::autograd::variable_list forward(torch::autograd::AutogradContext* ctx,
                                                const torch::Tensor& ray_begin,
                                                const torch::Tensor& sigma,
                                                const torch::Tensor& radiance,
                                                const torch::Tensor& dt, const torch::Tensor& t,
                                                const torch::Tensor& background) {
    const torch::autograd::variable_list in = {ray_begin, sigma, radiance, dt, t, background};
    const std::int64_t rays = ray_begin.size(0) - 1;
    torch::Tensor rgb = torch::empty({rays, 3}, sigma.options());
    torch::Tensor opacity = torch::empty({rays}, sigma.options());
    torch::Tensor depth = torch::empty({rays}, sigma.options());
    AT_DISPATCH_FLOATING_TYPES(sigma.scalar_type(), "composite_forward", [&] {
      const kernels::Composited<scalar_t> out = {Span<scalar_t>(rgb), Span<scalar_t>(opacity),
                                                 Span<scalar_t>(depth)};
      ParallelFor(rays, kMinRaysPerThread, [&](std::int64_t first, std::int64_t last) {
        kernels::CompositeForward<scalar_t>(Segments<scalar_t>(in), out, first, last);
      });
    });
    ctx->save_for_backward(in);
    return {rgb, opacity, depth};
  }

  static torch::autograd::variable_list backward(torch::autograd::AutogradContext* ctx,
                                                 torch::autograd::variable_list grads) {
    const torch::autograd::variable_list in = ctx->get_saved_variables();
    const std::int64_t rays = in[0].size(0) - 1;
    const torch::Tensor dL_drgb = grads[0].contiguous();
    const torch::Tensor dL_dopacity = grads[1].contiguous();
    const torch::Tensor dL_ddepth = grads[2].contiguous();
    torch::Tensor dL_dsigma = torch::empty_like(in[1]);
    torch::Tensor dL_dradiance = torch::empty_like(in[2]);
    torch::Tensor dL_dbackground = torch::empty_like(in[5]);
    AT_DISPATCH_FLOATING_TYPES(in[1].scalar_type(), "composite_backward", [&] {
      const kernels::CompositedGradients<scalar_t> grad = {Span<const scalar_t>(dL_drgb),
                                                           Span<const scalar_t>(dL_dopacity),
                                                           Span<const scalar_t>(dL_ddepth)};
      const kernels::SegmentGradients<scalar_t> out = {
          Span<scalar_t>(dL_dsigma), Span<scalar_t>(dL_dradiance), Span<scalar_t>(dL_dbackground)};
      ParallelFor(rays, kMinRaysPerThread, [&](std::int64_t first, std::int64_t last) {
        kernels::CompositeBackward<scalar_t>(Segments<scalar_t>(in), grad, out, first, last);
      });
    });
    const torch::Tensor none;
    return {none, dL_dsigma, dL_dradiance, none, none, dL_dbackground};
  }
};

struct WeightsFunction : torch::autograd::Function<WeightsFunction> {
  static torch::Tensor forward(torch::autograd::AutogradContext* ctx,
                               const torch::Tensor& ray_begin, const torch::Tensor& sigma,
                               const torch::Tensor& dt) {
    torch::Tensor weights = torch::empty_like(sigma);
    AT_DISPATCH_FLOATING_TYPES(sigma.scalar_type(), "weights_forward", [&] {
      ParallelFor(
          ray_begin.size(0) - 1, kMinRaysPerThread, [&](std::int64_t first, std::int64_t last) {
            kernels::WeightsForward<scalar_t>(Span<const std::int64_t>(ray_begin),
                                              Span<const scalar_t>(sigma), Span<const scalar_t>(dt),
                                              Span<scalar_t>(weights), first, last);
          });
    });
    ctx->save_for_backward({ray_begin, sigma, dt});
    return weights;
  }

  static torch::autograd::variable_list backward(torch::autograd::AutogradContext* ctx,
                                                 torch::autograd::variable_list grads) {
    const torch::autograd::variable_list in = ctx->get_saved_variables();
    const torch::Tensor dL_dweights = grads[0].contiguous();
    torch::Tensor dL_dsigma = torch::empty_like(in[1]);
    AT_DISPATCH_FLOATING_TYPES(in[1].scalar_type(), "weights_backward", [&] {
      ParallelFor(in[0].size(0) - 1, kMinRaysPerThread, [&](std::int64_t first, std::int64_t last) {
        kernels::WeightsBackward<scalar_t>(Span<const std::int64_t>(in[0]),
                                           Span<const scalar_t>(in[1]), Span<const scalar_t>(in[2]),
                                           Span<const scalar_t>(dL_dweights),
                                           Span<scalar_t>(dL_dsigma), first, last);
      });
    });
    return {torch::Tensor(), dL_dsigma, torch::Tensor()};
  }
};

}  // namespace

torch::Tensor RenderWeights(const torch::Tensor& ray_begin, const torch::Tensor& sigma,
                            const torch::Tensor& dt) {
  TORCH_CHECK(ray_begin.dim() == 1 && ray_begin.scalar_type() == torch::kLong,
              "RenderWeights: ray_begin must be [R+1] int64, got ", ray_begin.sizes());
  TORCH_CHECK(sigma.dim() == 1 && dt.sizes() == sigma.sizes(),
              "RenderWeights: expected sigma [S], dt [S]; got ", sigma.sizes(), dt.sizes());
  return WeightsFunction::apply(ray_begin.contiguous(), sigma.contiguous(), dt.contiguous());
}

VolumeRendering RenderVolume(const torch::Tensor& ray_begin, const torch::Tensor& sigma,
                             const torch::Tensor& radiance, const torch::Tensor& dt,
                             const torch::Tensor& t, const torch::Tensor& background) {
  const std::int64_t samples = sigma.size(0);
  const std::int64_t rays = ray_begin.size(0) - 1;
  TORCH_CHECK(ray_begin.dim() == 1 && rays >= 0 && ray_begin.scalar_type() == torch::kLong,
              "RenderVolume: ray_begin must be [R+1] int64, got ", ray_begin.sizes());
  TORCH_CHECK(ray_begin[rays].item<std::int64_t>() == samples, "RenderVolume: ray_begin ends at ",
              ray_begin[rays].item<std::int64_t>(), ", but there are ", samples, " samples");
  TORCH_CHECK(sigma.sizes() == at::IntArrayRef({samples}) &&
                  radiance.sizes() == at::IntArrayRef({samples, 3}) &&
                  dt.sizes() == sigma.sizes() && t.sizes() == sigma.sizes() &&
                  background.sizes() == at::IntArrayRef({rays, 3}),
              "RenderVolume: expected sigma [S], radiance [S,3], dt [S], t [S], background [R,3]; "
              "got ",
              sigma.sizes(), radiance.sizes(), dt.sizes(), t.sizes(), background.sizes());
  CheckOrder(ray_begin.contiguous(), dt.contiguous(), t.contiguous());
  const auto out = VolumeRenderingFunction::apply(ray_begin.contiguous(), sigma.contiguous(),
                                                  radiance.contiguous(), dt.contiguous(),
                                                  t.contiguous(), background.contiguous());
  return {out[0], out[1], out[2]};
}

}  // namespace nerf
