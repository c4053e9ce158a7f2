#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "nerf/pipeline/effect_measurement.h"
#include "nerf/pipeline/evaluation.h"

namespace nerf {

// What eval.json holds of an evaluation.
nlohmann::json JsonFromEvaluation(const Evaluation& evaluation);
// A row for each view and their mean, and what a frame took.
void PrintEvaluation(const Evaluation& evaluation);

// What effects_worth.json holds, and the same as a table.
//   steps  of each training
nlohmann::json JsonFromMeasurements(const std::vector<EffectMeasurement>& effects, int steps);
void PrintMeasurements(const std::vector<EffectMeasurement>& effects, int steps);

}  // namespace nerf
