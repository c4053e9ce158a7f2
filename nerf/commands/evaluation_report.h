#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "nerf/model/evaluation.h"
#include "nerf/pipeline/effect_measurement.h"
#include "nerf/pipeline/light_effect_measurement.h"
#include "nerf/pipeline/truth_comparison.h"

namespace nerf {

// The scores and costs for eval.json.
nlohmann::json JsonFromEvaluation(const Evaluation& evaluation);
// Prints a table of the views and their mean, and the cost of a frame.
void PrintEvaluation(const Evaluation& evaluation);

// The content of effects_worth.json, and the same as a table.
//   steps  of each training
nlohmann::json JsonFromMeasurements(const std::vector<EffectMeasurement>& effects, int steps);
void PrintMeasurements(const std::vector<EffectMeasurement>& effects, int steps);

// The same of the effects of light, of a run with materials.
nlohmann::json JsonFromLightEffects(const LightEffectMeasurements& measured);
void PrintLightEffects(const LightEffectMeasurements& measured);

// The content of truth.json, and the same as a table.
nlohmann::json JsonFromComparison(const TruthComparison& comparison);
void PrintComparison(const TruthComparison& comparison);

}  // namespace nerf
