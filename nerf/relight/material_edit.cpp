#include "nerf/relight/material_edit.h"

#include <algorithm>
#include <initializer_list>
#include <string>

#include "nerf/base/input_error.h"
#include "nerf/base/json_fields.h"

namespace nerf {
namespace {

void RequireKeys(const nlohmann::json& object, const JsonFields& fields,
                 std::initializer_list<const char*> known) {
  for (const auto& item : object.items()) {
    if (std::ranges::any_of(known, [&](const char* name) { return item.key() == name; })) continue;
    std::string names;
    for (const char* name : known) names += (names.empty() ? "" : ", ") + std::string(name);
    throw InputError("{} is unknown; use {}", fields.Where(item.key()), names);
  }
}

// Three numbers, or where `or_one` is set one for all.
std::optional<std::array<double, 3>> Triple(const nlohmann::json& object, const JsonFields& fields,
                                            const char* key, bool or_one) {
  if (!fields.Has(key)) return std::nullopt;
  if (or_one && object[key].is_number()) {
    const double value = *fields.Number(key);
    return std::array{value, value, value};
  }
  const nlohmann::json& list = *fields.Array(key);
  std::array<double, 3> values{};
  for (std::size_t k = 0; k < 3; ++k) {
    if (list.size() != 3 || !list[k].is_number()) {
      throw InputError("{} must be three numbers", fields.Where(key));
    }
    values[k] = list[k].get<double>();
  }
  return values;
}

void RequireInRange(double value, double low, double high, const std::string& where) {
  if (value >= low && value <= high) return;
  throw InputError("{} is {}; use {} to {}", where, value, low, high);
}

Eigen::AlignedBox3d BoxFrom(const nlohmann::json& json, const std::string& where) {
  const JsonFields fields(json, where + ".");
  RequireKeys(json, fields, {"min", "max"});
  const auto low = Triple(json, fields, "min", false), high = Triple(json, fields, "max", false);
  if (!low || !high) throw InputError("{} must have min and max", where);
  const Eigen::AlignedBox3d box(Eigen::Vector3d(low->data()), Eigen::Vector3d(high->data()));
  if (box.isEmpty()) throw InputError("{}: min is above max", where);
  return box;
}

// {"set": ...} or {"scale": ...} of colours.
void ReadColor(const nlohmann::json& json, const std::string& where, MaterialEdit& edit) {
  const JsonFields fields(json, where + ".");
  RequireKeys(json, fields, {"set", "scale"});
  edit.set_color = Triple(json, fields, "set", true);
  edit.scale_color = Triple(json, fields, "scale", true);
  for (int k = 0; k < 3 && edit.set_color; ++k) {
    RequireInRange((*edit.set_color)[k], 0, 1, fields.Where("set"));
  }
  for (int k = 0; k < 3 && edit.scale_color; ++k) {
    RequireInRange((*edit.scale_color)[k], 0, 1e6, fields.Where("scale"));
  }
}

MaterialEdit EditFrom(const nlohmann::json& json, const std::string& where,
                      const SceneNormalization& frame) {
  const JsonFields fields(json, where + ".");
  RequireKeys(json, fields, {"box", "albedo", "roughness", "metallic"});
  MaterialEdit edit;
  if (fields.Has("box")) {
    edit.box = MaterialEdit::Box{BoxFrom(json["box"], fields.Where("box")), frame};
  }
  if (fields.Has("albedo")) ReadColor(json["albedo"], fields.Where("albedo"), edit);
  if (fields.Has("roughness")) {
    const JsonFields own(json["roughness"], fields.Where("roughness") + ".");
    RequireKeys(json["roughness"], own, {"set", "scale"});
    edit.set_roughness = own.Number("set");
    edit.scale_roughness = own.Number("scale");
    if (edit.set_roughness) RequireInRange(*edit.set_roughness, 0, 1, own.Where("set"));
    if (edit.scale_roughness) RequireInRange(*edit.scale_roughness, 0, 1e6, own.Where("scale"));
  }
  if (fields.Has("metallic")) {
    const JsonFields own(json["metallic"], fields.Where("metallic") + ".");
    RequireKeys(json["metallic"], own, {"set"});
    edit.set_metallic = own.Number("set");
    if (edit.set_metallic) RequireInRange(*edit.set_metallic, 0, 1, own.Where("set"));
  }
  return edit;
}

torch::Tensor Row(const std::array<double, 3>& values, const torch::Tensor& like) {
  return torch::tensor({values[0], values[1], values[2]}, like.options());
}

}  // namespace

torch::Tensor IsInside(const MaterialEdit& edit, const torch::Tensor& positions) {
  torch::Tensor inside = torch::ones({positions.size(0)}, torch::kBool);
  if (!edit.box) return inside;
  const torch::Tensor plain = positions.detach().to(torch::kDouble).contiguous();
  for (std::int64_t p = 0; p < plain.size(0); ++p) {
    const Eigen::Vector3d x(plain.data_ptr<double>() + 3 * p);
    inside.data_ptr<bool>()[p] =
        edit.box->in_world.contains(edit.box->frame.WorldFromNormalized(x));
  }
  return inside;
}

void Apply(const MaterialEdit& edit, const torch::Tensor& positions, MaterialBatch& material) {
  const torch::Tensor inside = IsInside(edit, positions);
  const torch::Tensor column = inside.unsqueeze(1);
  torch::Tensor& color = material.base_color;
  if (edit.set_color) color = torch::where(column, Row(*edit.set_color, color), color);
  if (edit.scale_color) {
    color = torch::where(column, (color * Row(*edit.scale_color, color)).clamp(0, 1), color);
  }
  const bool changes_coat = edit.set_roughness || edit.scale_roughness || edit.set_metallic;
  if (changes_coat && material.IsMatt()) {
    material.roughness = torch::ones_like(color.select(1, 0));
    material.metallic = torch::zeros_like(material.roughness);
  }
  torch::Tensor& roughness = material.roughness;
  if (edit.set_roughness) {
    roughness = torch::where(inside, torch::full_like(roughness, *edit.set_roughness), roughness);
  }
  if (edit.scale_roughness) {
    roughness = torch::where(inside, roughness * *edit.scale_roughness, roughness);
  }
  if (changes_coat) roughness = roughness.clamp(kLeastRoughness, 1);
  if (edit.set_metallic) {
    material.metallic = torch::where(
        inside, torch::full_like(material.metallic, *edit.set_metallic), material.metallic);
  }
}

std::vector<MaterialEdit> ReadMaterialEdits(const std::filesystem::path& file,
                                            const SceneNormalization& frame,
                                            const std::vector<Eigen::Vector3f>& vertices) {
  const nlohmann::json root = ReadJsonFile(file);
  if (!root.is_array() || root.empty()) {
    throw InputError("{}: must be a list of edits, [{{\"albedo\": {{\"scale\": 0.5}}}}]",
                     file.string());
  }
  std::vector<MaterialEdit> edits;
  for (std::size_t i = 0; i < root.size(); ++i) {
    const std::string where = fmt::format("{}: [{}]", file.string(), i);
    edits.push_back(EditFrom(root[i], where, frame));
    if (!edits.back().box) continue;
    const Eigen::AlignedBox3d& box = edits.back().box->in_world;
    const bool holds_some = std::ranges::any_of(vertices, [&](const Eigen::Vector3f& vertex) {
      return box.contains(frame.WorldFromNormalized(vertex.cast<double>()));
    });
    if (holds_some) continue;
    Eigen::AlignedBox3d all;
    for (const Eigen::Vector3f& vertex : vertices) {
      all.extend(frame.WorldFromNormalized(vertex.cast<double>()));
    }
    throw InputError(
        "{}.box holds nothing of the surface, which is within [{:.3g}, {:.3g}, {:.3g}] to [{:.3g}, "
        "{:.3g}, {:.3g}] in the units of the input",
        where, all.min().x(), all.min().y(), all.min().z(), all.max().x(), all.max().y(),
        all.max().z());
  }
  return edits;
}

}  // namespace nerf
