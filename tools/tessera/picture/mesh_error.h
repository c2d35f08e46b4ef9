#pragma once
// `raycast --shade error`: the distance of a mesh from its surfaces.

#include <memory>
#include <string>

#include "console/report.h"
#include "line/command_line.h"
#include "render/mesh_distance.h"
#include "render/render.h"
#include "tessera/patch_set.h"

namespace tessera::cli {

struct MeshErrorOptions {
  std::string mesh;        ///< a file; empty: makes the certified tessellation
  double relative = 1e-3;  ///< its tolerance, a share of the model's size
};

struct MeshError {
  std::shared_ptr<const render::MeshDistance> mesh;
  std::size_t triangles = 0;
  double found = 0;  ///< the largest distance at points of a grid over each patch
  double red = 0;    ///< the distance of the last colour: the proven bound, or `found`
  bool certified = false;

  /// For render::Settings::error.
  double share(const Vec3& point) const { return mesh->distance(point, 4 * red) / red; }
  void add_to(Report& report) const;
  std::string caption() const;  ///< of the picture
};

/// Adds --mesh and --relative, which need --shade error. The check throws UsageError if that is missing.
void add_error_options(Command& command, MeshErrorOptions& options, const Option& shade);
void check_error_options(Command& command, render::Shade shade);

/// Measures the distance. Errors: those of reading, of the tessellation, and of render::MeshDistance.
Result<MeshError> measure_error(const MeshErrorOptions& options, const PatchSet& set);

}  // namespace tessera::cli
