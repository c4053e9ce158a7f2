#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace nerf {

// Writes a file atomically: to a temporary file beside it, flushed to disk, then renamed over the
// target; a power failure does not undo it. An existing file stays until the new one is complete.
// Throws InputError naming the file and the reason (folder missing, no space left, ...) and removes
// the temporary file.
void WriteFileAtomically(const std::filesystem::path& path, std::string_view bytes);

// The contents of a file. Throws InputError naming it when it cannot be read.
std::string ReadWholeFile(const std::filesystem::path& path);

// Removes a file, or a folder and its contents; does nothing where the path does not exist. Throws
// InputError naming it when that is not possible.
void RemoveAll(const std::filesystem::path& path);

// Creates the folder and its parents. Throws InputError naming it when that is not possible, or
// when files cannot be created in it. Removes what killed writers left in it
// (RemoveAbandonedFiles).
void MakeOutputFolder(const std::filesystem::path& folder);

}  // namespace nerf
