#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>

#include "nerf/model/model.h"
#include "nerf/model/scene_model.h"

namespace nerf {

// An immutable model: one step of a training, or a trained run. All members are const and
// thread-safe, also during training.
class ModelSnapshot : public SceneModel {
 public:
  // Takes ownership of a model, whose modules must not be shared.
  ModelSnapshot(Model model, std::int64_t step);
  ModelSnapshot(const ModelSnapshot&) = delete;  // the renderer has a reference to the model
  ModelSnapshot& operator=(const ModelSnapshot&) = delete;

  // A snapshot of a model in training, between two steps; copies its modules.
  static std::shared_ptr<const ModelSnapshot> Copy(const Model& model, std::int64_t step);

  RenderedView Render(const ViewRequest& view) const override;
  // The renderer of rays; must not outlive the snapshot.
  std::shared_ptr<const RayRenderer> Renderer(double quality = 1) const;

  const Model& GetModel() const { return model_; }
  const Config& GetConfig() const override { return model_.config; }
  const SceneFacts& Scene() const override { return model_.scene; }
  std::int64_t Step() const override { return step_; }

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
