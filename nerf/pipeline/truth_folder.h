#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace nerf {

// What is known of a held-out view of a scene whose materials are known. Absent: not known.
struct TruthView {
  std::string name;  // of the photograph, without its extension, or its last folder
  std::optional<std::filesystem::path> albedo, normal;
  std::optional<std::filesystem::path> material;       // R roughness, G metallic
  std::map<std::string, std::filesystem::path> relit;  // by the name of the light
};

// A light of relit views: a map, and the factor by which pictures show it brighter.
struct TruthLight {
  std::filesystem::path map;
  double gain = 1;
};

struct TruthFolder {
  std::vector<TruthView> views;
  std::map<std::string, TruthLight> lights;
};

// Reads which truth a folder has, in one of two forms:
//   - transforms_test.json, whose frames have "gt", the beginning of the names of truth
//     (GT_albedo.exr, GT_normal.exr, GT_material.exr), and "relit", pictures by the names of
//     "lights", which have a "file" and maybe a "png_exposure"; "light" of a frame is that of its
//     own picture;
//   - a folder for each view, with albedo.png (linear), normal.png and rgba_LIGHT.png, as in
//     TensoIR-synthetic (Jin et al. 2023); the map of a light is LIGHT.hdr or LIGHT.exr.
// Maps are looked for in `maps`, in the folder, in its parent, and in folders environments and
// high_res_envmaps_2k of both.
//   maps  empty: none is given
// Throws InputError naming what is missing.
TruthFolder ReadTruthFolder(const std::filesystem::path& folder, const std::filesystem::path& maps);

}  // namespace nerf
