#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "nerf/splats/gaussian_renderer.h"

namespace nerf {

// Renderers whose buffers are used again: allocating them takes as long as drawing. For any thread.
class RendererPool {
 public:
  // One for the exclusive use of the caller, who gives it back.
  std::unique_ptr<GaussianRenderer> Take() {
    const std::lock_guard lock(mutex_);
    if (unused_.empty()) return std::make_unique<GaussianRenderer>();
    std::unique_ptr<GaussianRenderer> renderer = std::move(unused_.back());
    unused_.pop_back();
    return renderer;
  }
  void Give(std::unique_ptr<GaussianRenderer> renderer) {
    const std::lock_guard lock(mutex_);
    unused_.push_back(std::move(renderer));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<GaussianRenderer>> unused_;
};

}  // namespace nerf
