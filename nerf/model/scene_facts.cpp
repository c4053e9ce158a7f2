#include "nerf/model/scene_facts.h"

namespace nerf {

SceneFacts FactsOf(const Dataset& data, const SceneNormalization& normalized_from_world) {
  SceneFacts facts = {data.encoding, data.has_alpha, normalized_from_world, {}, {}, {}};
  for (const View& view : data.train) {
    facts.photographs.push_back(view.name);
    facts.places.push_back({view.normalized_from_camera.translation(),
                            view.normalized_from_camera.linear().col(2), view.lens});
  }
  return facts;
}

nlohmann::json JsonFromScene(const SceneFacts& scene) {
  const SceneNormalization& n = scene.normalized_from_world;
  nlohmann::json rotation = nlohmann::json::array(), translation = nlohmann::json::array();
  for (int i = 0; i < 9; ++i) rotation.push_back(n.rotation(i / 3, i % 3));
  for (int i = 0; i < 3; ++i) translation.push_back(n.translation[i]);
  nlohmann::json places = nlohmann::json::array();
  for (const CameraPlace& p : scene.places) {
    places.push_back({{"centre", {p.centre.x(), p.centre.y(), p.centre.z()}},
                      {"axis", {p.axis.x(), p.axis.y(), p.axis.z()}},
                      {"lens", p.lens}});
  }
  return {{"encoding", scene.encoding == ColorEncoding::kSrgb ? "srgb" : "linear"},
          {"has_alpha", scene.has_alpha},
          {"scale", n.scale},
          {"rotation", rotation},
          {"translation", translation},
          {"photographs", scene.photographs},
          {"places", places}};
}

SceneFacts SceneFromJson(const nlohmann::json& scene) {
  SceneFacts facts;
  facts.encoding = scene.at("encoding") == "srgb" ? ColorEncoding::kSrgb : ColorEncoding::kLinear;
  facts.has_alpha = scene.at("has_alpha");
  facts.photographs = scene.value("photographs", std::vector<std::string>());
  for (const nlohmann::json& place : scene.value("places", nlohmann::json::array())) {
    CameraPlace p;
    for (int i = 0; i < 3; ++i) p.centre[i] = place.at("centre").at(i);
    for (int i = 0; i < 3; ++i) p.axis[i] = place.at("axis").at(i);
    p.lens = place.at("lens");
    facts.places.push_back(p);
  }
  SceneNormalization& n = facts.normalized_from_world;
  n.scale = scene.at("scale");
  for (int i = 0; i < 9; ++i) n.rotation(i / 3, i % 3) = scene.at("rotation").at(i);
  for (int i = 0; i < 3; ++i) n.translation[i] = scene.at("translation").at(i);
  return facts;
}

}  // namespace nerf
