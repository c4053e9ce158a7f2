#pragma once

#include <filesystem>
#include <optional>

namespace nerf::sfm {

// Whether a file has the extension of a film: mp4, mov, mkv, webm, ...
bool HasFilmExtension(const std::filesystem::path& file);

struct FilmFrames {
  int frames = 0;        // written
  int blurred = 0;       // parts of the film that were passed over because all of them is blurred
  double seconds = 0;    // length of the film
  bool existed = false;  // written by an earlier call
};

struct FilmPlan {
  int frames = 0;
  int longest_side = 0;  // of a frame, pixels
  double seconds = 0;    // that ExtractFrames takes, roughly
};

// What ExtractFrames will do. Throws as it does.
FilmPlan PlanFrames(const std::filesystem::path& film, int count);

// The frames that an earlier ExtractFrames took from this film with this count; nothing if there
// are none. Throws InputError naming the folder if it has files that must not be replaced.
std::optional<FilmFrames> EarlierFrames(const std::filesystem::path& film,
                                        const std::filesystem::path& folder, int count);

// Takes sharp frames at even distances out of a film (ChooseFrames), upright as the film is shown,
// and writes them to a folder as frame_00001.jpg, ... with film.json, by which a second call with
// the same film and number finds them done. An earlier folder of frames is replaced.
//   count  of frames; 0: DefaultFrameCount
// Needs the programs ffmpeg and ffprobe. Throws InputError naming the film if they are missing or
// cannot read it, or if it lasts less than a second; or the folder, if it has other files.
FilmFrames ExtractFrames(const std::filesystem::path& film, const std::filesystem::path& folder,
                         int count);

}  // namespace nerf::sfm
