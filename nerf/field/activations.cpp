#include "nerf/field/activations.h"

namespace nerf {
namespace {

struct TruncatedExpFunction : torch::autograd::Function<TruncatedExpFunction> {
  static torch::Tensor forward(torch::autograd::AutogradContext* ctx, const torch::Tensor& x) {
    const torch::Tensor y = torch::exp(torch::clamp(x, -kExpLimit, kExpLimit));
    ctx->save_for_backward({y});
    return y;
  }

  static torch::autograd::variable_list backward(torch::autograd::AutogradContext* ctx,
                                                 torch::autograd::variable_list grads) {
    return {grads[0] * ctx->get_saved_variables()[0]};
  }
};

}  // namespace

torch::Tensor TruncatedExp(const torch::Tensor& x) { return TruncatedExpFunction::apply(x); }

}  // namespace nerf
