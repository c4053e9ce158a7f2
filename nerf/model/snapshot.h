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

// A model that never changes: one step of a training, or a trained run. All members are const and
// safe from any thread, while training goes on too.
class ModelSnapshot {
 public:
  // Takes over a model that nobody else changes.
  ModelSnapshot(Model model, std::int64_t step);
  ModelSnapshot(const ModelSnapshot&) = delete;  // the renderer borrows the model
  ModelSnapshot& operator=(const ModelSnapshot&) = delete;

  // A deep copy of a model between two steps of its training.
  static std::shared_ptr<const ModelSnapshot> Copy(const Model& model, std::int64_t step);

  // Pixels that the lens does not reach, and transparent ones, show the display background (white
  // where photographs have alpha, else black). Depth is along the ray, in normalized scene units.
  // Throws InputError where quality is not in [0, 1].
  RenderedView Render(const ViewRequest& view) const;
  // The rays' own renderer, for those who need more than views; must not outlive the snapshot.
  std::shared_ptr<const RayRenderer> Renderer(double quality = 1) const;

  const Model& GetModel() const { return model_; }
  const SceneFacts& Scene() const { return model_.scene; }
  std::int64_t Step() const { return step_; }

 private:
  const Model model_;
  const std::int64_t step_;
  const std::shared_ptr<const RayRenderer> exact_;
};

// Hands snapshots from a training to those who look at it: they ask, and the training thread
// publishes one after its current step. A training that nobody looks at copies nothing.
class SnapshotSlot {
 public:
  // The latest snapshot, null before the first; and asks for a newer one.
  std::shared_ptr<const ModelSnapshot> Latest();

  // For the training thread: whether a snapshot is asked for; then Publish.
  bool IsWanted() const;
  void Publish(std::shared_ptr<const ModelSnapshot> snapshot);

 private:
  std::atomic<bool> wanted_ = false;
  mutable std::mutex mutex_;
  std::shared_ptr<const ModelSnapshot> latest_;
};

}  // namespace nerf
