#pragma once
// Meshes of CAD parts beside those of OpenCASCADE's BRepMesh_IncrementalMesh at equal measured error.

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "peers/face_errors.h"
#include "peers/occt_shape.h"

namespace tessera::bench {

struct PartOptions {
  std::vector<std::filesystem::path> places;  ///< files, and folders of files
  std::string only;                           ///< a part of the names of files
  std::size_t points = 12000;                 ///< see FaceErrorMeter
  double relative = 1e-3;                     ///< the tolerance of Tessera's meshes, as a share of the size
  double angle = 0.5;                         ///< OpenCASCADE's angular deflection, radians
};

/// A mesh of OpenCASCADE's.
struct EqualMesh {
  double deflection = 0, error = 0;
  std::size_t triangles = 0;
};
/// Finds about the largest deflection at which OpenCASCADE's error is at most `own`, Tessera's. If even a quarter of
/// that is too large, as where a file has gaps, the deflection is `own` itself. Flat parts have no error: a thousandth
/// of Tessera's tolerance takes its place. Throws std::runtime_error if OpenCASCADE takes too long.
EqualMesh mesh_of_equal_error(OcctShape& theirs, const FaceErrorMeter& meter, double own, double tolerance,
                              double angle);

/// Prints the median and the ends of ratios, of which there must be one.
void print_ratios(const char* of, std::vector<double> ratios);

/// Prints a line for each file, and the medians and the ends of the ratios. Each file is read and meshed in a process
/// of its own, since some files crash OpenCASCADE or do not end; such a file has a line that says so.
void compare_parts(const PartOptions& options);

}  // namespace tessera::bench
