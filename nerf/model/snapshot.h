#pragma once

#include <Eigen/Geometry>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>

#include "nerf/model/model.h"
#include "nerf/render/image_renderer.h"
#include "nerf/scene/posed_images.h"

namespace nerf {

// A view to render, in the frame and units of the input.
struct ViewRequest {
  Camera camera;
  Eigen::Isometry3d world_from_camera;  // OpenCV axes
  double quality = 1;                   // 0 (fast) to 1 (exact): RenderQuality::Of
  // Called with the number of pixels done; throw from it to stop.
  std::function<void(std::int64_t)> progress = {};
};

// An immutable model: one step of a training, or a trained run. All members are const and
// thread-safe, also during training.
class ModelSnapshot {
 public:
  // Takes ownership of a model, whose modules must not be shared.
  ModelSnapshot(Model model, std::int64_t step);
  ModelSnapshot(const ModelSnapshot&) = delete;  // the renderer has a reference to the model
  ModelSnapshot& operator=(const ModelSnapshot&) = delete;

  // A snapshot of a model in training, between two steps; copies its modules.
  static std::shared_ptr<const ModelSnapshot> Copy(const Model& model, std::int64_t step);

  // Pixels outside the lens's field of view, and transparent ones, have the display background
  // (white if photographs have alpha, else black). Depth is along the ray, in normalized units.
  // Throws InputError if quality is not in [0, 1].
  RenderedView Render(const ViewRequest& view) const;
  // The renderer of rays; must not outlive the snapshot.
  std::shared_ptr<const RayRenderer> Renderer(double quality = 1) const;

  const Model& GetModel() const { return model_; }
  const SceneFacts& Scene() const { return model_.scene; }
  std::int64_t Step() const { return step_; }

 private:
  const Model model_;
  const std::int64_t step_;
  const std::shared_ptr<const RayRenderer> exact_;
};

// Passes snapshots from the training thread to viewers on request: after a request, the training
// thread publishes one snapshot at the end of its step. Without requests nothing is copied.
class SnapshotSlot {
 public:
  // Returns the latest snapshot, null before the first, and requests a newer one.
  std::shared_ptr<const ModelSnapshot> Latest();

  // For the training thread: publish a snapshot if one is requested, and the last one if the slot
  // was used.
  bool IsRequested() const;
  // Whether there ever was a request.
  bool WasUsed() const;
  void Publish(std::shared_ptr<const ModelSnapshot> snapshot);

 private:
  std::atomic<bool> requested_ = false, was_used_ = false;
  mutable std::mutex mutex_;
  std::shared_ptr<const ModelSnapshot> latest_;
};

}  // namespace nerf
