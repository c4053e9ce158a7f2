#include "nerf/commands/training_display.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace nerf {
namespace {

constexpr double kGain = 0.5;  // dB, whose time is shown

// PSNR, and the time of the last and the next decibels: "27.30 dB, last +0.5 dB cost 40 s, next
// about 90 s".
std::string QualityAndCost(const QualityCurve& curve) {
  std::string text;
  if (const auto psnr = curve.Last()) text += fmt::format("{:.2f} dB", *psnr);
  if (const auto last = curve.SecondsOfLast(kGain)) {
    text += fmt::format(", last +{} dB cost {}", kGain, FormatSeconds(*last));
  }
  if (const auto next = curve.SecondsForNext(kGain)) {
    text += fmt::format(", next about {}", FormatSeconds(*next));
  }
  return text;
}

template <class... Args>
void Print(fmt::format_string<Args...> format, Args&&... args) {
  fmt::print(format, std::forward<Args>(args)...);
  std::fflush(stdout);
}

}  // namespace

std::string DescribeFrames(const sfm::FilmFrames& frames, const std::filesystem::path& folder) {
  std::string text =
      fmt::format("{} frames of {:.1f} s in {}", frames.frames, frames.seconds, folder.string());
  if (frames.blurred > 0) text += fmt::format("; {} blurred parts passed over", frames.blurred);
  if (frames.existed) text += " (taken before)";
  return text;
}

void TrainingDisplay::operator()(const PipelineEvent& event) {
  std::visit([this](const auto& e) { Show(e); }, event);
}

void TrainingDisplay::Show(const Warning& event) { spdlog::warn("{}", event.text); }

void TrainingDisplay::Show(const WaitEstimated& event) {
  if (event.film_seconds > 0) {
    Print("{} frames of the film: choosing them takes about {}, their poses {}, training {}\n",
          event.photographs, FormatDuration(event.film_seconds), FormatDuration(event.pose_seconds),
          FormatDuration(event.training_seconds));
    return;
  }
  Print("{} photographs: their poses take about {}, then training about {}\n", event.photographs,
        FormatDuration(event.pose_seconds), FormatDuration(event.training_seconds));
}

void TrainingDisplay::Show(const FilmRead& event) {
  Print("{}: {}\n", event.film.string(), DescribeFrames(event.frames, event.folder));
}

void TrainingDisplay::Show(const PosesFound& event) {
  const sfm::ColmapReport& report = event.report;
  double seconds = 0;
  for (const auto& [step, step_seconds] : report.seconds) seconds += step_seconds;
  Print("poses: {} of {} photographs registered, {} points, reprojection error {:.2f} px, {}\n",
        report.registered, report.photos, report.points, report.mean_reprojection_error,
        FormatDuration(seconds));
  Print("poses: {}\n", sfm::Describe(report.verdict));
}

void TrainingDisplay::Show(const PointsFound& event) {
  if (event.report.consistency.IsDoubtful()) {  // which was warned of
    Print("{}\n", sfm::Describe(event.report));
    return;
  }
  Print("poses: {}; {}\n", sfm::Describe(event.report.consistency), sfm::Describe(event.report));
}

void TrainingDisplay::Show(const ResolutionChosen& event) {
  Print("{} x {} photographs are trained on at {} x {} pixels; --downscale 1 trains on all\n",
        event.width, event.height, event.width / event.downscale, event.height / event.downscale);
}

void TrainingDisplay::Show(const InspectionProgress& event) {
  if (!progress_) progress_.emplace("inspecting", event.photographs);
  if (event.done < event.photographs) {
    progress_->Update(event.done);
  } else {
    progress_.reset();
  }
}

void TrainingDisplay::Show(const CaptureInspected& event) {
  const std::vector<Verdict>& verdicts = event.inspection->verdicts;
  if (event.inspection->stops.empty()) {
    // Most effects are undecided: print a line instead of the table.
    std::vector<std::string> facts;
    for (const Verdict& v : verdicts) {
      const bool is_unbounded = v.effect == kUnboundedEffect.name;
      if (v.on && !is_unbounded) facts.push_back(v.effect);
      if (v.decided && !v.on && is_unbounded) facts.push_back("not " + v.effect);
    }
    fmt::print("effects: as configured, because there are no sparse points to inspect{}{}\n",
               facts.empty() ? "" : "; but ", fmt::join(facts, ", "));
  } else {
    fmt::print("effects that the capture calls for ({:.1f} s):\n{}", event.seconds,
               TableOf(verdicts));
  }
  if (!event.requested.empty()) {
    fmt::print("as requested, regardless of the capture: {}\n", fmt::join(event.requested, ", "));
  }
  std::fflush(stdout);
}

void TrainingDisplay::Show(const DataPlanned& event) {
  const DataPlan& plan = event.plan;
  const std::string share =
      plan.stored_pixels == plan.pixels
          ? ""
          : fmt::format(", a random one of every {:.3g} pixels (limited by data.memory_mb)",
                        static_cast<double>(plan.pixels) / static_cast<double>(plan.stored_pixels));
  Print(
      "{} threads; {} images to train on, {} to validate, {} held out; {}x{} pixels; {} MB of "
      "pixels held{}\n",
      event.threads, plan.train, plan.validation, plan.held_out, event.width, event.height,
      plan.Bytes() >> 20, share);
}

void TrainingDisplay::Show(const VerdictReached& event) { Print("{}", RowOf(event.verdict)); }

void TrainingDisplay::Show(const EffectsTried& event) {
  Print("trials took {:.1f} s\n", event.seconds);
}

void TrainingDisplay::Show(const EffectsUndecided& event) {
  Print("inconclusive, therefore as configured: {}\n", fmt::join(event.effects, ", "));
}

void TrainingDisplay::Show(const BudgetPlanned& event) {
  Print("time budget {}: preset {}, about {:.0f} steps of the field in {}\n",
        FormatDuration(event.seconds), event.preset, event.steps,
        FormatDuration(event.field_seconds));
}

void TrainingDisplay::Show(const PosesRefined& event) {
  const PoseRefinementSummary& s = event.summary;
  Print(
      "poses: cameras rotated by {:.3f} degrees (median; maximum {:.3f}) and translated by {:.3g} "
      "units (maximum {:.3g}); focal lengths changed by at most {:.2f} %\n",
      s.median_degrees, s.max_degrees, s.median_shift, s.max_shift, 100 * s.max_focal);
}

void TrainingDisplay::Show(const TrainerEvent& event) {
  if (const auto* step = std::get_if<StepTaken>(&event)) Show(*step);
}

void TrainingDisplay::Show(const StepTaken& event) {
  constexpr double kSmoothing = 0.95;
  const bool timed = train_.time_budget > 0;
  const std::int64_t done = timed ? std::llround(event.spent_seconds) : event.step;
  if (!progress_) {
    progress_.emplace("training", timed ? std::llround(train_.time_budget) : train_.steps, done);
  }
  const double keep = rays_per_second_ == 0 ? 0.0 : kSmoothing;
  loss_ = keep * loss_ + (1 - keep) * event.loss;
  rays_per_second_ = keep * rays_per_second_ + (1 - keep) * event.rays_per_second;
  if (!ProgressLine::IsTerminal()) return;
  progress_->Update(done, fmt::format("loss {:.5f}  {:.1f}k rays/s  {}", loss_,
                                      rays_per_second_ / 1e3, QualityAndCost(*event.curve)));
}

void TrainingDisplay::Show(const SurfacesRendered& event) {
  if (!progress_) {
    progress_.emplace("surfaces of the field", static_cast<std::int64_t>(event.views));
  }
  progress_->Update(static_cast<std::int64_t>(event.done));
  if (event.done == event.views) progress_.reset();
}

void TrainingDisplay::Show(const MaterialsStepped& event) {
  constexpr std::int64_t kParts = 1000;
  if (!progress_) progress_.emplace("finding materials", kParts);
  if (!ProgressLine::IsTerminal()) return;
  progress_->Update(std::llround(std::min(1.0, event.fraction) * kParts),
                    fmt::format("step {}  {:.2f} dB", event.step, event.psnr));
}

void TrainingDisplay::Show(const LightEffectsDecided& event) {
  progress_.reset();
  const auto state = [](bool on) { return on ? "on" : "off"; };
  Print("light: shadows {}, bounces {}{}; specular {}{}\n", state(event.shadows),
        state(event.bounces),
        event.blocked
            ? fmt::format(" ({:.1f} % of the directions are blocked)", 100 * *event.blocked)
            : "",
        state(event.specular),
        event.specular_db ? fmt::format(" (a coat explains the photographs better by {:.2f} dB)",
                                        *event.specular_db)
                          : "");
}

void TrainingDisplay::Show(const MaterialsFound& event) {
  progress_.reset();
  Print("{} materials of a surface of {} vertices under {} light{}: {} steps in {:.1f} s{}\n",
        event.finished ? "found" : "stopped, kept", event.vertices, event.lights,
        event.lights == 1 ? "" : "s", event.steps, event.seconds,
        event.psnr > 0 ? fmt::format(", {:.2f} dB", event.psnr) : "");
  if (event.is_relative) {
    Print(
        "a light is not known, so its brightness and that of the materials are relative: its mean "
        "is near white\n");
  }
}

void TrainingDisplay::Show(const GaussiansStepped& event) {
  constexpr std::int64_t kParts = 1000;
  if (!progress_) progress_.emplace("fitting Gaussians", kParts);
  if (!ProgressLine::IsTerminal()) return;
  progress_->Update(std::llround(event.fraction * kParts),
                    fmt::format("iteration {}, loss {:.4f}{}", event.step, event.loss,
                                event.psnr > 0 ? fmt::format("  {:.2f} dB", event.psnr) : ""));
}

void TrainingDisplay::Show(const RepresentationDecided& event) {
  progress_.reset();
  if (event.tried) {
    Print("a trial of Gaussians: {:.2f} dB where the field has {:.2f}; {}\n", event.tried->splats,
          event.tried->field,
          event.makes_splats ? "they follow the field" : "the field goes on alone");
  } else if (!event.makes_splats) {
    Print("no Gaussians: {}\n", event.why_not);
  }
}

void TrainingDisplay::Show(const GaussiansFailed& event) {
  progress_.reset();
  spdlog::warn("no Gaussians, the field is kept: {}", event.why);
}

void TrainingDisplay::Show(const GaussiansEnded& event) {
  progress_.reset();
  const GaussianSummary& fit = event.fit;
  Print("{} {} Gaussians in {} iterations, {:.1f} s\n", fit.finished ? "fitted" : "stopped, kept",
        fit.gaussians, fit.steps, fit.seconds);
  if (fit.seconds_per_frame > 0) Print("a frame takes {:.1f} ms\n", 1e3 * fit.seconds_per_frame);
  if (!event.reached) return;
  const auto [field, splats] = *event.reached;
  const auto last = fit.curve.SecondsOfLast(kGain);
  Print("validation: Gaussians {:.2f} dB, the field {:.2f} dB{}; {} better by {:.2f} dB\n", splats,
        field,
        last
            ? fmt::format(" (the last {} dB of the Gaussians cost {})", kGain, FormatSeconds(*last))
            : "",
        splats > field ? "Gaussians are" : "the field is", std::abs(splats - field));
}

void TrainingDisplay::Show(const TrainingEnded& event) {
  progress_.reset();
  const TrainSummary& summary = event.summary;
  const std::string psnr = summary.validation_psnr > 0
                               ? fmt::format(", validation {:.2f} dB", summary.validation_psnr)
                               : "";
  const std::string run = event.run.string();
  if (!summary.finished) {
    Print("stopped at step {}, saved{}\ncontinue with: nerf train --resume -o {}\n", summary.step,
          psnr, run);
    return;
  }
  fmt::print("trained {} steps in {:.1f} s{}\n", summary.step, summary.training_seconds, psnr);
  if (event.options.target_psnr > 0) {
    fmt::print("target of {} dB {}\n", event.options.target_psnr,
               summary.reached_target ? "reached" : "not reached");
  }
  const auto last = summary.curve.SecondsOfLast(kGain), next = summary.curve.SecondsForNext(kGain);
  if (last && next) {
    fmt::print("the last {} dB cost {}; {} dB more would take about {} more\n", kGain,
               FormatSeconds(*last), kGain, FormatSeconds(*next));
  }
  if (event.picture) {
    fmt::print("{}: a photograph, its rendering, the error\n", event.picture->string());
  } else {
    fmt::print("{}\n", run);
  }
  Print("next: nerf eval {}\n", run);
}

}  // namespace nerf
