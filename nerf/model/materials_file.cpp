#include "nerf/model/materials_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <utility>

#include "nerf/base/input_error.h"
#include "nerf/config/options_json.h"
#include "nerf/geometry/surface_mesh.h"
#include "nerf/model/checkpoint.h"

namespace nerf {
namespace {

constexpr int kVersion = 2;
constexpr char kDistance[] = "distance", kLight[] = "light", kField[] = "field.", kFit[] = "fit.";
constexpr int kMostCells = 4096;  // along an axis
constexpr int kMostLights = 4096;

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

nlohmann::json JsonFrom(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Eigen::Vector3d VectorFrom(const nlohmann::json& json) {
  const Eigen::Vector3d v(json.at(0).get<double>(), json.at(1).get<double>(),
                          json.at(2).get<double>());
  if (!v.allFinite()) throw InputError("a light is not finite");
  return v;
}

nlohmann::json JsonFrom(const LightGroup& light) {
  nlohmann::json lamps = nlohmann::json::array();
  for (const Lamp& lamp : light.lamps) {
    if (const auto* sun = std::get_if<DirectionalLight>(&lamp)) {
      lamps.push_back({{"direction", JsonFrom(sun->to_light)},
                       {"irradiance", JsonFrom(Eigen::Vector3d(sun->irradiance))}});
    } else {
      const auto& point = std::get<PointLight>(lamp);
      lamps.push_back({{"position", JsonFrom(point.x_in_world)},
                       {"intensity", JsonFrom(Eigen::Vector3d(point.intensity))}});
    }
  }
  return {{"name", light.name}, {"lamps", lamps}};
}

LightGroup LightFrom(const nlohmann::json& json) {
  LightGroup light;
  light.name = json.at("name").get<std::string>();
  for (const nlohmann::json& lamp : json.at("lamps")) {
    if (lamp.contains("direction")) {
      light.lamps.emplace_back(DirectionalLight{VectorFrom(lamp.at("direction")),
                                                VectorFrom(lamp.at("irradiance")).array()});
    } else {
      light.lamps.emplace_back(
          PointLight{VectorFrom(lamp.at("position")), VectorFrom(lamp.at("intensity")).array()});
    }
  }
  return light;
}

void ReadLights(const Checkpoint& checkpoint, int directions, RelightableSurface& surface) {
  const nlohmann::json& lights = checkpoint.meta.at("lights");
  if (!lights.is_array() || lights.empty() || lights.size() > kMostLights) {
    throw InputError("it has no light");
  }
  const auto count = static_cast<std::int64_t>(lights.size());
  torch::Tensor radiance = torch::empty({count, directions, 3});
  CopyTensor(checkpoint.tensors, kLight, radiance);
  for (std::int64_t g = 0; g < count; ++g) {
    surface.lights.push_back(LightFrom(lights[static_cast<std::size_t>(g)]));
    surface.lights.back().environment = radiance[g];
  }
}

// With a new material field.
Materials MaterialsFrom(const Checkpoint& checkpoint) {
  const nlohmann::json& meta = checkpoint.meta;
  if (const int version = meta.at("materials").get<int>(); version != kVersion) {
    throw InputError("its version is {} instead of {}", version, kVersion);
  }
  Materials materials;
  OptionsFromJson(meta.at("options"), "materials.", materials.options);
  CheckRanges(materials.options, "materials.");
  materials.resolution = meta.at("resolution").get<int>();
  materials.steps = meta.at("step").get<std::int64_t>();
  materials.seconds = meta.at("seconds").get<double>();
  materials.field_step = meta.at("field_step").get<std::int64_t>();
  RelightableSurface& surface = materials.surface;
  surface.distance = GridOf(checkpoint);
  surface.mesh = SurfaceMesh(surface.distance);
  surface.normal_offset = materials.options.normal_offset;
  surface.has_shadows = meta.at("shadows").get<bool>();
  surface.has_bounces = meta.at("bounces").get<bool>();
  Eigen::AlignedBox3d box;
  for (int k = 0; k < 3; ++k) {
    box.min()[k] = meta.at("box").at("min").at(k).get<double>();
    box.max()[k] = meta.at("box").at("max").at(k).get<double>();
  }
  if (!(box.sizes().minCoeff() > 0) || materials.resolution < 1 ||
      materials.resolution > kMostCells) {
    throw InputError("its material field is out of range");
  }
  surface.field =
      std::make_shared<MaterialField>(box, materials.resolution, meta.at("is_matt").get<bool>(), 0);
  const torch::NoGradGuard no_grad;
  for (const auto& item : surface.field->named_parameters()) {
    CopyTensor(checkpoint.tensors, kField + item.key(), item.value());
  }
  ReadLights(checkpoint, materials.options.directions, surface);
  return materials;
}

// Calls read(checkpoint); errors name the file.
template <class Read>
auto ReadFrom(const std::filesystem::path& file, const Read& read) {
  const Checkpoint checkpoint = ReadCheckpoint(file);
  try {
    return read(checkpoint);
  } catch (const std::exception& error) {  // of JSON, or InputError without the file's name
    throw InputError("{}: holds no materials ({}); find them again with nerf materials",
                     file.string(), error.what());
  }
}

}  // namespace

void WriteMaterials(const Materials& materials, const std::filesystem::path& file,
                    const InterruptedMaterials* fit) {
  const RelightableSurface& surface = materials.surface;
  const ScalarGrid& grid = surface.distance;
  const Eigen::AlignedBox3d& box = surface.field->Box();
  Checkpoint checkpoint;
  checkpoint.meta = {{"materials", kVersion},
                     {"grid", {{"cell", grid.cell}, {"origin", JsonFrom(grid.origin)}}},
                     {"box", {{"min", JsonFrom(box.min())}, {"max", JsonFrom(box.max())}}},
                     {"resolution", materials.resolution},
                     {"is_matt", surface.field->IsMatt()},
                     {"shadows", surface.has_shadows},
                     {"bounces", surface.has_bounces},
                     {"options", JsonFromOptions(materials.options)},
                     {"step", materials.steps},
                     {"seconds", materials.seconds},
                     {"field_step", materials.field_step}};
  std::vector<torch::Tensor> radiance;
  for (const LightGroup& light : surface.lights) {
    checkpoint.meta["lights"].push_back(JsonFrom(light));
    radiance.push_back(light.environment);
  }
  checkpoint.tensors[kLight] = torch::stack(radiance);
  checkpoint.tensors[kDistance] =
      torch::tensor(grid.values).view({grid.size.z(), grid.size.y(), grid.size.x()});
  for (const auto& item : surface.field->named_parameters()) {
    checkpoint.tensors[kField + item.key()] = item.value();
  }
  if (fit != nullptr) {
    checkpoint.meta["interrupted"] = {{"planned_seconds", fit->planned_seconds},
                                      {"planned_steps", fit->planned_steps},
                                      {"is_known", fit->is_known},
                                      {"light_of", fit->light_of},
                                      {"photographs", fit->photographs}};
    for (const auto& [name, tensor] : fit->state) checkpoint.tensors[kFit + name] = tensor;
  }
  WriteCheckpoint(file, checkpoint);
}

Materials ReadMaterials(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) {
    const std::string run = file.parent_path().string();
    throw InputError("{}: contains no {}; find materials first: nerf materials {}", run,
                     file.filename().string(), run);
  }
  return ReadFrom(file, MaterialsFrom);
}

std::optional<InterruptedMaterials> ReadInterruptedMaterials(const std::filesystem::path& file) {
  return ReadFrom(file, [](const Checkpoint& checkpoint) -> std::optional<InterruptedMaterials> {
    if (!checkpoint.meta.contains("interrupted")) return std::nullopt;
    const nlohmann::json& meta = checkpoint.meta.at("interrupted");
    InterruptedMaterials fit;
    fit.planned_seconds = meta.at("planned_seconds").get<double>();
    fit.planned_steps = meta.at("planned_steps").get<std::int64_t>();
    fit.is_known = meta.at("is_known").get<std::vector<bool>>();
    fit.light_of = meta.at("light_of").get<std::map<std::string, std::int64_t>>();
    fit.photographs = meta.at("photographs").get<std::string>();
    const std::size_t lights = checkpoint.meta.at("lights").size();
    const bool names_lights = std::ranges::all_of(fit.light_of, [&](const auto& item) {
      return item.second >= 0 && item.second < static_cast<std::int64_t>(lights);
    });
    if (fit.is_known.size() != lights || !names_lights) throw InputError("its lights differ");
    const std::string prefix = kFit;
    for (const auto& [name, tensor] : checkpoint.tensors) {
      if (name.starts_with(prefix)) fit.state[name.substr(prefix.size())] = tensor;
    }
    return fit;
  });
}

}  // namespace nerf
