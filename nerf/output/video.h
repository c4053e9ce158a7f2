#pragma once

#include <filesystem>
#include <string>

namespace nerf {

// Whether the ffmpeg program is found in PATH.
bool FfmpegIsInstalled();

// File name of a frame, counted from 0: "00012.png".
std::string FrameName(int index);

// Encodes the first `frames` frames in a folder, FrameName(0), FrameName(1), ..., as an MP4 (H.264,
// 4:2:0, playable while it loads) with the program ffmpeg. Odd sizes are padded by a pixel. The
// file is written whole or not at all. Throws InputError if ffmpeg is not installed, the extension
// is not .mp4, a frame is missing, or ffmpeg fails (with the last line of its output).
void WriteVideo(const std::filesystem::path& frames_folder, int frames, double frames_per_second,
                const std::filesystem::path& video);

}  // namespace nerf
