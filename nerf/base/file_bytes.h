#pragma once

#include <filesystem>
#include <string>

namespace nerf {

// The contents of a regular file, for untrusted files: never blocks on a pipe, and memory is
// bounded by the size of the file. Throws InputError naming the file when it is missing, not a
// regular file, or unreadable.
std::string ReadFileBytes(const std::filesystem::path& file);

}  // namespace nerf
