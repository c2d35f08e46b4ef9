#pragma once
// Options of the stage that makes meshes: density, sharing of vertices, limits.

#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "line/arguments.h"
#include "line/command_line.h"
#include "tessera/tessellation.h"

namespace tessera::cli {

constexpr double degree = std::numbers::pi / 180;

/// The tolerance without an option of density, a share of the model's size.
inline constexpr double default_share = 1e-3;

struct MeshOptions {
  std::optional<Extent> grid;
  TessellationOptions certified;  ///< used if there is no grid
  bool is_default = false;        ///< whether no density is on the command line
  std::uint64_t max_memory = 0;   ///< bytes of the mesh; 0: a share of what is free
  bool quads = false;
  bool strict = false;         ///< whether faults of the mesh are errors
  bool has_precision = false;  ///< whether the user has chosen that of positions
  double pixels = 0;           ///< above 0 if requested
  View view;
};

/// Adds the options for how fine the mesh is, and returns them.
std::vector<const Option*> add_density(Command& command, MeshOptions& options);
/// Sets the default tolerance if none of the options for density is on the command line.
void set_default(const std::vector<const Option*>& density, MeshOptions& options);
/// Adds the limits and kinds of meshes.
void add_mesh_options(Command& command, MeshOptions& options);
/// Adds the camera of --pixels.
void add_view(Command& command, MeshOptions& options);

/// Returns the options of the library that the command line's stand for.
TessellationOptions plan_options(const MeshOptions& options);

}  // namespace tessera::cli
