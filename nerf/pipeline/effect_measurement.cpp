#include "nerf/pipeline/effect_measurement.h"

#include <optional>

#include "nerf/base/input_error.h"
#include "nerf/pipeline/held_out_halves.h"
#include "nerf/pipeline/prepared_scene.h"
#include "nerf/scene/dataset.h"
#include "sfm/transforms_json.h"

namespace nerf {
namespace {

// The photographs of a run, with the held-out ones as the validation split.
PosedImages ReadWithHeldOutAsValidation(const std::filesystem::path& poses) {
  PosedImages posed = sfm::ReadTransformsJson(poses);
  bool any_held_out = false;
  for (PosedImage& image : posed.images) {
    if (image.split == Split::kValidation) image.split = Split::kTrain;
    if (image.split == Split::kTest) image.split = Split::kValidation;
    any_held_out = any_held_out || image.split == Split::kValidation;
  }
  if (!any_held_out) {
    throw InputError(
        "{}: no photograph is held out to measure effects on; use at least 8 photographs",
        poses.string());
  }
  return posed;
}

// Masks with the meaning `empty` define the scene, so there is no result without them.
bool IsMeasurable(const EffectsOptions& effects, const EffectDescriptor& effect) {
  const bool defines_scene =
      &effect == &kMasksEffect && effects.masks && effects.masks->meaning == MaskMeaning::kEmpty;
  return Simulates(effects, effect) && !defines_scene;
}

}  // namespace

std::vector<EffectMeasurement> MeasureEffects(
    const OpenedRun& run, int steps, const PipelineListener& listener,
    const std::function<void(std::size_t, std::size_t, const EffectDescriptor&)>& progress) {
  const Model& model = run.model->GetModel();
  const SceneNormalization& normalized_from_world = model.scene.normalized_from_world;
  const PosedImages posed = ReadWithHeldOutAsValidation(run.posed.source);
  const std::filesystem::path folder = run.posed.source.parent_path();
  Dataset data = LoadPhotographs(posed, model.config, normalized_from_world, folder, listener);
  const auto train = [&](const Config& config, const Dataset& photographs) {
    return TrainShortly(config, FactsOf(photographs, normalized_from_world), photographs, steps);
  };
  // Without masks, training includes the masked pixels; validation is on the same pixels.
  const auto train_without = [&](const EffectDescriptor& effect) {
    const Config without = WithEffect(model.config, effect, false);
    if (&effect != &kMasksEffect) return train(without, data);
    Dataset unmasked = LoadPhotographs(posed, without, normalized_from_world, folder, listener);
    unmasked.validation = data.validation;
    return train(without, unmasked);
  };
  std::vector<const EffectDescriptor*> effects;
  for (const EffectDescriptor* effect : AllEffects()) {
    if (IsMeasurable(model.config.effects, *effect)) effects.push_back(effect);
  }
  std::vector<EffectMeasurement> all;
  for (const EffectDescriptor* effect : effects) {
    std::optional<HeldOutHalves> halves;
    if (effect->measured_on_halves) halves.emplace(data);
    if (halves && halves->Count() == 0) halves.reset();
    // Alternating, so that both are measured under the same load.
    const ShortTraining with = train(model.config, data);
    progress(2 * all.size() + 1, 2 * effects.size(), *effect);
    all.push_back({effect, with, train_without(*effect), halves.has_value()});
    progress(2 * all.size(), 2 * effects.size(), *effect);
  }
  return all;
}

}  // namespace nerf
