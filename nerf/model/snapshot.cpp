#include "nerf/model/snapshot.h"

#include <utility>

#include "nerf/render/view_renderer.h"
#include "nerf/scene/dataset.h"

namespace nerf {

ModelSnapshot::ModelSnapshot(Model model, std::int64_t step)
    : model_(std::move(model)), step_(step), exact_(MakeRenderer(model_)) {}

std::shared_ptr<const ModelSnapshot> ModelSnapshot::Copy(const Model& model, std::int64_t step) {
  return std::make_shared<const ModelSnapshot>(CloneModel(model), step);
}

std::shared_ptr<const RayRenderer> ModelSnapshot::Renderer(double quality) const {
  return quality == 1 ? exact_ : MakeRenderer(model_, quality);
}

RenderedView ModelSnapshot::Render(const ViewRequest& view) const {
  const SceneFacts& scene = model_.scene;
  return RenderView(*Renderer(view.quality), view.camera,
                    scene.normalized_from_world.NormalizedFromCamera(view.world_from_camera),
                    DisplayBackground(scene.has_alpha), scene.encoding, view.progress);
}

std::shared_ptr<const ModelSnapshot> SnapshotSlot::Latest() {
  was_used_ = true;
  requested_ = true;
  const std::lock_guard lock(mutex_);
  return latest_;
}

bool SnapshotSlot::IsRequested() const { return requested_; }
bool SnapshotSlot::WasUsed() const { return was_used_; }

void SnapshotSlot::Publish(std::shared_ptr<const ModelSnapshot> snapshot) {
  requested_ = false;
  const std::lock_guard lock(mutex_);
  latest_ = std::move(snapshot);
}

}  // namespace nerf
