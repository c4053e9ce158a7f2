#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace nerf {

// Writes a file whole or not at all: into a temporary name beside it, flushed to the disk, then
// renamed over the target. Whatever stood there before stays until the new file is complete.
// Throws InputError naming the file and the reason (folder missing, no space left, ...); the
// temporary file is then removed.
void WriteFileAtomically(const std::filesystem::path& path, std::string_view bytes);

// The whole file. Throws InputError naming it when it cannot be read.
std::string ReadWholeFile(const std::filesystem::path& path);

// Removes a file, or a folder with all that is in it; nothing where nothing is there. Throws
// InputError naming it when that is not possible.
void RemoveAll(const std::filesystem::path& path);

// Makes the folder and its parents. Throws InputError naming it when that is not possible, or when
// files cannot be created in it.
void MakeOutputFolder(const std::filesystem::path& folder);

}  // namespace nerf
