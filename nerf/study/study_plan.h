#pragma once

#include <string>
#include <vector>

namespace nerf {

// One training of a study.
struct StudySetting {
  std::string name;  // of its run folder, too
  std::string preset;
  std::vector<std::string> assignments;  // "block.key=value"
  double share = 1;                      // of the study's training time, in parts of the shortest
};

// What a study tries: the presets for a short, a middle and a long time, and at the middle one
// `balanced` with one thing changed at a time: levels and size of the hash table, width of the
// networks, samples a ray, precision, resolution of the photographs. In rising order of time.
//   downscale  of the photographs, where no setting says otherwise
std::vector<StudySetting> StudySettings(int downscale);

// Seconds of training for setting `next`, when `left` seconds are left of the study for it and
// those after it, and a setting takes `overhead` seconds beside its training.
double SecondsOfSetting(const std::vector<StudySetting>& settings, std::size_t next, double left,
                        double overhead);

}  // namespace nerf
