#pragma once
// Meshes of CAD parts beside those of OpenCASCADE's BRepMesh_IncrementalMesh at equal measured error.

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace tessera::bench {

struct PartOptions {
  std::vector<std::filesystem::path> places;  ///< files, and folders of files
  std::string only;                           ///< a part of the names of files
  std::size_t points = 12000;                 ///< see FaceErrorMeter
  double relative = 1e-3;                     ///< the tolerance of Tessera's meshes, as a share of the size
  double angle = 0.5;                         ///< OpenCASCADE's angular deflection, radians
};

/// Prints a line for each file, and the medians and the ends of the ratios. Each file is read and meshed in a process
/// of its own, since some files crash OpenCASCADE or do not end; such a file has a line that says so.
void compare_parts(const PartOptions& options);

}  // namespace tessera::bench
