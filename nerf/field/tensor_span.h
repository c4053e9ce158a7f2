#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "nerf/field/libtorch.h"

namespace nerf {

// A view of a contiguous CPU tensor's elements.
template <class T>
std::span<T> Span(const torch::Tensor& tensor) {
  return {tensor.data_ptr<std::remove_const_t<T>>(), static_cast<std::size_t>(tensor.numel())};
}

// A vector as a tensor of the given shape and type. Without a conversion of the type the tensor
// shares the vector's memory, which must then outlive it.
template <class T>
torch::Tensor TensorOf(const std::vector<T>& values, at::IntArrayRef shape, torch::Dtype dtype) {
  const auto own = c10::CppTypeToScalarType<T>::value;
  return torch::from_blob(const_cast<T*>(values.data()), shape, own).to(dtype);
}

}  // namespace nerf
