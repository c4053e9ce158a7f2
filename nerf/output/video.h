#pragma once

#include <filesystem>
#include <string>

namespace nerf {

// Whether the ffmpeg program is found in PATH.
bool FfmpegIsInstalled();

// Name of a film's frame on disk, counted from 0: "00012.png".
std::string FrameName(int index);

// Makes an MP4 (H.264, 4:2:0, playable while it loads) of the first `frames` frames, FrameName(0),
// FrameName(1), ... in a folder, by way of the ffmpeg program. Odd sizes are padded by a pixel. The
// file appears whole or not at all. Throws InputError where ffmpeg is not installed, the
// ending is not .mp4, a frame is missing, or ffmpeg fails (with its last line).
void WriteVideo(const std::filesystem::path& frames_folder, int frames, double frames_per_second,
                const std::filesystem::path& video);

}  // namespace nerf
