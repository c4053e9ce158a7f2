#pragma once

#include <optional>
#include <vector>

#include "nerf/render/field_tile.h"
#include "nerf/render/proposal_tile.h"
#include "nerf/train/engine.h"

namespace nerf {

// What LibTorchEngine defines, a tile of rays at a time: placing of samples, encoding, networks,
// compositing, loss and the way back run one after the other while the tile's samples are in the
// core's cache, with kernels of our own on LibTorch's parameters, in float.
class FusedEngine : public Engine {
 public:
  explicit FusedEngine(EngineParts parts);
  ~FusedEngine() override;

  RenderOutput Render(const RayBatch& rays) override;
  StepResult AccumulateGradients(const TargetBatch& batch) override;
  void UpdateOccupancy(std::int64_t step, std::uint64_t seed) override;

 private:
  struct Tile;
  struct Worker;
  void Refresh();
  std::int64_t PlaceSamples(const RayBatch& rays, std::int64_t first, std::int64_t last,
                            Tile& tile) const;
  void KeepVisible(Tile& tile) const;
  std::int64_t Forward(const RayBatch& rays, std::int64_t first, std::int64_t last,
                       Tile& tile) const;
  void Backward(const TargetBatch& batch, std::int64_t first, Worker& worker,
                std::span<float> ray_error) const;

  EngineParts parts_;
  TileField field_;
  std::optional<TileProposal> proposal_;
  std::vector<Worker> workers_;  // one a thread
};

}  // namespace nerf
