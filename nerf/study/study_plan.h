#pragma once

#include <string>
#include <vector>

namespace nerf {

// One training of a study.
struct StudySetting {
  std::string name;  // also of its run folder
  std::string preset;
  std::vector<std::string> assignments;  // "block.key=value"
  double share = 1;                      // training time, relative to the shortest
};

// The settings of a study: the presets for a short, a middle and a long time, and variants of
// `balanced` for the middle time that change one thing: levels or size of the hash table, width of
// the networks, samples per ray, precision, resolution of the photographs. For each time also one
// that fits Gaussians to a field. By increasing time.
//   downscale  of the photographs, unless a setting changes it
std::vector<StudySetting> StudySettings(int downscale);

// The training time of setting `next`, seconds.
//   left      seconds left for it and all later settings
//   overhead  seconds that each setting takes beside its training
double SecondsOfSetting(const std::vector<StudySetting>& settings, std::size_t next, double left,
                        double overhead);

}  // namespace nerf
