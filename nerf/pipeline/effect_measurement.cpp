#include "nerf/pipeline/effect_measurement.h"

#include <optional>

#include "nerf/base/input_error.h"
#include "nerf/pipeline/held_out_halves.h"
#include "nerf/pipeline/prepared_scene.h"
#include "nerf/scene/dataset.h"
#include "sfm/transforms_json.h"

namespace nerf {
namespace {

// The photographs, with those held out as validation photographs.
PosedImages ValidatedOnHeldOut(const std::filesystem::path& poses) {
  PosedImages posed = sfm::ReadTransformsJson(poses);
  bool any = false;
  for (PosedImage& image : posed.images) {
    if (image.split == Split::kValidation) image.split = Split::kTrain;
    if (image.split == Split::kTest) image.split = Split::kValidation;
    any = any || image.split == Split::kValidation;
  }
  if (!any) {
    throw InputError("{}: no photograph is held out to measure effects on; take 8 at least",
                     poses.string());
  }
  return posed;
}

// Of masks that mean empty there is nothing to measure: what they hide is not of the scene.
bool IsMeasurable(const EffectsOptions& effects, const EffectDescriptor& effect) {
  const bool empties =
      &effect == &kMasks && effects.masks && effects.masks->meaning == MaskMeaning::kEmpty;
  return Simulates(effects, effect) && !empties;
}

}  // namespace

std::vector<EffectMeasurement> MeasureEffects(
    const OpenedRun& run, int steps, const PipelineListener& listener,
    const std::function<void(std::size_t, std::size_t, const EffectDescriptor&)>& progress) {
  const Model& model = run.model->GetModel();
  const SceneNormalization& normalized_from_world = model.scene.normalized_from_world;
  const PosedImages posed = ValidatedOnHeldOut(run.posed.source);
  const std::filesystem::path folder = run.posed.source.parent_path();
  Dataset data = LoadPhotographs(posed, model.config, normalized_from_world, folder, listener);
  const auto train = [&](const Config& config, const Dataset& photographs) {
    return TrainShortly(config, FactsOf(photographs, normalized_from_world), photographs, steps);
  };
  // Without masks what they hide is trained on; measured are the same pixels.
  const auto train_without = [&](const EffectDescriptor& effect) {
    const Config without = WithEffect(model.config, effect, false);
    if (&effect != &kMasks) return train(without, data);
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
    // With and without in turn, so that both see the same load on the machine.
    const ShortTraining with = train(model.config, data);
    progress(2 * all.size() + 1, 2 * effects.size(), *effect);
    all.push_back({effect, with, train_without(*effect), halves.has_value()});
    progress(2 * all.size(), 2 * effects.size(), *effect);
  }
  return all;
}

}  // namespace nerf
