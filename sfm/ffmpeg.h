#pragma once

#include <filesystem>
#include <functional>
#include <istream>
#include <string>
#include <vector>

namespace nerf::sfm {

// Runs ffmpeg or ffprobe on a film, and passes its standard output to `read`. Throws InputError
// naming the film if the program is missing or fails.
void RunFilmProgram(const char* name, const std::filesystem::path& film,
                    const std::vector<std::string>& arguments,
                    const std::function<void(std::istream& output)>& read);

struct FilmFacts {
  double seconds = 0;
  double frames_per_second = 0;  // 0 if unknown
  int width = 0, height = 0;     // pixels, as stored: a rotation flag is not applied
};

// Throws InputError naming the film if it cannot be read.
FilmFacts ProbeFilm(const std::filesystem::path& film);

}  // namespace nerf::sfm
