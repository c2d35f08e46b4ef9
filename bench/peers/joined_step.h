#pragma once
// STEP files of any size, assembled of others.

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace tessera::bench {

/// Makes one STEP file of the instances of several files, again and again until its text has `size` bytes at least.
/// Instances get numbers of their own; each file's products become further roots. Throws std::runtime_error if a file
/// cannot be read or has no DATA section, and if there are none.
std::string joined_step(const std::vector<std::filesystem::path>& files, std::size_t size);

}  // namespace tessera::bench
