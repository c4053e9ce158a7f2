#include "nerf/render/engine.h"

#include "nerf/render/fused_engine.h"
#include "nerf/render/libtorch_engine.h"

namespace nerf {

std::unique_ptr<Engine> MakeEngine(const ModelParts& parts) {
  switch (parts.config.train.engine) {
    case EngineKind::kFused:
      return std::make_unique<FusedEngine>(parts);
    case EngineKind::kLibTorch:
      return std::make_unique<LibTorchEngine>(parts);
  }
  TORCH_CHECK(false, "MakeEngine: unknown engine");
}

}  // namespace nerf
