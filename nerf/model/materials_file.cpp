#include "nerf/model/materials_file.h"

#include <array>
#include <exception>
#include <string>
#include <utility>

#include "nerf/base/input_error.h"
#include "nerf/config/options_json.h"
#include "nerf/geometry/level_set_mesh.h"
#include "nerf/model/checkpoint.h"

namespace nerf {
namespace {

constexpr char kDistance[] = "distance", kLight[] = "light", kField[] = "field.";
constexpr int kMostCells = 4096;  // along an axis

ScalarGrid GridOf(const Checkpoint& checkpoint) {
  const nlohmann::json& meta = checkpoint.meta.at("grid");
  const torch::Tensor values = checkpoint.tensors.at(kDistance);
  ScalarGrid grid;
  grid.cell = meta.at("cell").get<double>();
  bool is_valid = values.dim() == 3 && values.scalar_type() == torch::kFloat && grid.cell > 0 &&
                  torch::isfinite(values).all().item<bool>();
  for (int k = 0; k < 3 && is_valid; ++k) {
    grid.origin[k] = meta.at("origin").at(k).get<double>();
    grid.size[k] = static_cast<int>(values.size(2 - k));
    is_valid = grid.size[k] >= 2 && grid.size[k] <= kMostCells;
  }
  if (!is_valid) {
    throw InputError("its surface is out of range");
  }
  const torch::Tensor plain = values.contiguous();
  grid.values.assign(plain.data_ptr<float>(), plain.data_ptr<float>() + plain.numel());
  return grid;
}

}  // namespace

void WriteMaterials(const Materials& materials, const std::filesystem::path& file) {
  const ScalarGrid& grid = materials.surface.distance;
  const Eigen::AlignedBox3d& box = materials.surface.field->Box();
  Checkpoint checkpoint;
  checkpoint.meta = {
      {"materials", 1},  // version of the format
      {"grid",
       {{"cell", grid.cell}, {"origin", {grid.origin.x(), grid.origin.y(), grid.origin.z()}}}},
      {"box",
       {{"min", {box.min().x(), box.min().y(), box.min().z()}},
        {"max", {box.max().x(), box.max().y(), box.max().z()}}}},
      {"resolution", materials.resolution},
      {"options", JsonFromOptions(materials.options)},
      {"step", materials.steps},
      {"field_step", materials.field_step}};
  checkpoint.tensors[kDistance] =
      torch::tensor(grid.values).view({grid.size.z(), grid.size.y(), grid.size.x()});
  checkpoint.tensors[kLight] = materials.surface.light;
  for (const auto& item : materials.surface.field->named_parameters()) {
    checkpoint.tensors[kField + item.key()] = item.value();
  }
  WriteCheckpoint(file, checkpoint);
}

Materials ReadMaterials(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) {
    const std::string run = file.parent_path().string();
    throw InputError("{}: contains no {}; find materials first: nerf materials {}", run,
                     file.filename().string(), run);
  }
  const Checkpoint checkpoint = ReadCheckpoint(file);
  try {
    const nlohmann::json& meta = checkpoint.meta;
    Materials materials;
    OptionsFromJson(meta.at("options"), "materials.", materials.options);
    CheckRanges(materials.options, "materials.");
    materials.resolution = meta.at("resolution").get<int>();
    materials.steps = meta.at("step").get<std::int64_t>();
    materials.field_step = meta.at("field_step").get<std::int64_t>();
    RelightableSurface& surface = materials.surface;
    surface.distance = GridOf(checkpoint);
    surface.mesh = LevelSetMesh(surface.distance, 0);
    surface.normal_offset = materials.options.normal_offset;
    Eigen::AlignedBox3d box;
    for (int k = 0; k < 3; ++k) {
      box.min()[k] = meta.at("box").at("min").at(k).get<double>();
      box.max()[k] = meta.at("box").at("max").at(k).get<double>();
    }
    if (!(box.sizes().minCoeff() > 0) || materials.resolution < 1 ||
        materials.resolution > kMostCells) {
      throw InputError("its material field is out of range");
    }
    surface.field = std::make_shared<MaterialField>(box, materials.resolution, 0);
    const torch::NoGradGuard no_grad;
    for (const auto& item : surface.field->named_parameters()) {
      CopyTensor(checkpoint.tensors, kField + item.key(), item.value());
    }
    surface.light = torch::empty({materials.options.directions, 3});
    CopyTensor(checkpoint.tensors, kLight, surface.light);
    return materials;
  } catch (const std::exception& error) {  // of JSON, or InputError without the file's name
    throw InputError("{}: holds no materials ({}); find them again with nerf materials",
                     file.string(), error.what());
  }
}

}  // namespace nerf
