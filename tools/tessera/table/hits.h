#pragma once
// The hits of rays as a table.

#include <cstddef>

#include "io/file/output_file.h"
#include "tessera/model.h"
#include "tessera/ray_scene.h"

namespace tessera::cli {

struct HitCounts {
  std::size_t rays = 0;
  std::size_t hits = 0;  ///< rays that hit anything
  std::size_t points = 0;
  std::size_t unrefined = 0, uncertified = 0, incomplete = 0, edge = 0;  ///< points with that flag
};

/// Converts u and v to the surfaces' own parameters, and counts.
HitCounts use_own_parameters(const Model& model, HitLists& lists);

/// Writes ray,hit,t,surface,patch,u,v,x,y,z,nx,ny,nz,edge,name, the last that of the surface or face: a row for each
/// hit; for a ray without hits one row with hit = 0 and empty fields.
void write_hits(OutputFile& out, const Model& model, const HitLists& lists);

}  // namespace tessera::cli
