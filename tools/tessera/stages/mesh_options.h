#pragma once
// How tessera tessellate divides surfaces: density, sharing of vertices, limits.

#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "line/arguments.h"
#include "line/command_line.h"
#include "stages/load.h"
#include "tessera/tessellation.h"

namespace tessera::cli {

constexpr double degree = std::numbers::pi / 180;

struct TessellateOptions {
  ModelOptions models;
  std::string output, format;
  std::optional<Extent> grid;
  TessellationOptions certified;  ///< used if there is no grid
  bool is_default = false;        ///< whether no density is on the command line
  std::uint64_t max_memory = 0;   ///< bytes of the mesh; 0: a share of what is free
  std::uint64_t piece_bytes = 0;  ///< memory of a piece; 0: the model is meshed as a whole
  bool quads = false;
  bool strict = false;         ///< whether faults of the mesh are errors
  bool has_precision = false;  ///< whether the user has chosen that of positions
  double pixels = 0;           ///< above 0 if requested
  View view;
};

/// Adds the options for how fine the mesh is, and returns them. Without any, a relative tolerance is used.
std::vector<const Option*> add_density(Command& command, TessellateOptions& options);
/// Adds the limits and kinds of meshes.
void add_mesh_options(Command& command, TessellateOptions& options);
/// Adds the camera of --pixels.
void add_view(Command& command, TessellateOptions& options);

}  // namespace tessera::cli
