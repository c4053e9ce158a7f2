#pragma once

#include <atomic>
#include <optional>
#include <string>

#include "nerf/model/representation_record.h"
#include "nerf/pipeline/gaussian_training.h"

namespace nerf {

struct Trial {
  std::optional<ComparedPsnr> psnr;
  std::string why_not;  // where there is none, and it was not stopped
};

// A short fit of few Gaussians to the surfaces of a field in training, at a low resolution,
// compared with that field on the validation photographs. Its Gaussians are discarded.
//   seconds   of the trial with all that belongs to it; 0: `steps` iterations
Trial TryGaussians(const Model& field, const Dataset& data, double seconds, std::int64_t steps,
                   const std::atomic<bool>& stop, const PipelineListener& listener);

// Whether a trial promises that Gaussians will be better at the end.
bool SplatsPromiseMore(const ComparedPsnr& trial);

}  // namespace nerf
