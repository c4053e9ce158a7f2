#include "nerf/field/hash_encoding.h"

#include <ATen/CPUGeneratorImpl.h>

#include "nerf/base/parallel.h"
#include "nerf/field/tensor_span.h"

namespace nerf {
namespace {

constexpr std::int64_t kMinSamplesPerThread = 512;

struct HashEncodeFunction : torch::autograd::Function<HashEncodeFunction> {
  static torch::Tensor forward(torch::autograd::AutogradContext* ctx, const torch::Tensor& table,
                               const torch::Tensor& positions,
                               const kernels::HashGridLayout* layout) {
    const std::int64_t count = positions.size(0);
    torch::Tensor encoded = torch::empty({count, layout->OutputSize()}, table.options());
    AT_DISPATCH_FLOATING_TYPES(table.scalar_type(), "hash_encode_forward", [&] {
      ParallelFor(count, kMinSamplesPerThread, [&](std::int64_t first, std::int64_t last) {
        kernels::HashEncodeForward<scalar_t>(*layout, Span<const scalar_t>(table),
                                             Span<const scalar_t>(positions),
                                             Span<scalar_t>(encoded), first, last);
      });
    });
    ctx->save_for_backward({positions, table});
    ctx->saved_data["layout"] = reinterpret_cast<std::int64_t>(layout);
    ctx->saved_data["entries"] = table.size(0);
    return encoded;
  }

  static torch::autograd::variable_list backward(torch::autograd::AutogradContext* ctx,
                                                 torch::autograd::variable_list grads) {
    const torch::autograd::variable_list saved = ctx->get_saved_variables();
    const torch::Tensor &positions = saved[0], &table = saved[1];
    const auto* layout =
        reinterpret_cast<const kernels::HashGridLayout*>(ctx->saved_data["layout"].toInt());
    const torch::Tensor dL_dencoded = grads[0].contiguous();
    torch::Tensor dL_dtable =
        torch::zeros({ctx->saved_data["entries"].toInt(), layout->features}, dL_dencoded.options());
    AT_DISPATCH_FLOATING_TYPES(dL_dencoded.scalar_type(), "hash_encode_backward", [&] {
      ParallelFor(static_cast<std::int64_t>(layout->levels.size()), 1,
                  [&](std::int64_t first, std::int64_t last) {
                    kernels::HashEncodeBackward<scalar_t>(
                        *layout, Span<const scalar_t>(positions), Span<const scalar_t>(dL_dencoded),
                        Span<scalar_t>(dL_dtable), static_cast<int>(first), static_cast<int>(last));
                  });
    });
    if (!ctx->needs_input_grad(1)) return {dL_dtable, torch::Tensor(), torch::Tensor()};
    torch::Tensor dL_dposition = torch::zeros_like(positions);
    const std::vector<float> ones(layout->levels.size(), 1.0f);
    AT_DISPATCH_FLOATING_TYPES(dL_dencoded.scalar_type(), "hash_encode_position", [&] {
      ParallelFor(positions.size(0), kMinSamplesPerThread,
                  [&](std::int64_t first, std::int64_t last) {
                    kernels::HashEncodePositionBackward<scalar_t>(
                        *layout, Span<const scalar_t>(table), Span<const scalar_t>(positions),
                        Span<const scalar_t>(dL_dencoded), layout->OutputSize(), ones,
                        Span<scalar_t>(dL_dposition), first, last);
                  });
    });
    return {dL_dtable, dL_dposition, torch::Tensor()};
  }
};

}  // namespace

HashEncoding::HashEncoding(const kernels::HashGridOptions& options, std::uint64_t seed)
    : layout_(kernels::MakeHashGridLayout(options)) {
  auto generator = at::make_generator<at::CPUGeneratorImpl>(seed);
  const torch::Tensor initial =
      torch::empty({layout_.entries, layout_.features}).uniform_(-1e-4, 1e-4, generator);
  table_ = register_parameter("table", initial);
}

torch::Tensor HashEncoding::forward(const torch::Tensor& positions) {
  TORCH_CHECK(positions.dim() == 2 && positions.size(1) == 3,
              "HashEncoding: positions must be [N,3], got ", positions.sizes());
  TORCH_CHECK(positions.scalar_type() == table_.scalar_type(), "HashEncoding: positions are ",
              positions.scalar_type(), ", the table is ", table_.scalar_type());
  return HashEncodeFunction::apply(table_, positions.contiguous(), &layout_);
}

}  // namespace nerf
