#pragma once
// The hits of given rays as a table.

#include <span>

#include "io/output_file.h"
#include "tessera/model.h"
#include "tessera/ray_scene.h"

namespace tessera::cli {

struct HitCounts {
  std::size_t rays = 0, hits = 0, unrefined = 0;
};

/// u and v become the surfaces' own parameters.
HitCounts use_own_parameters(const Model& model, std::span<Hit> hits);

/// ray,hit,t,surface,patch,u,v,x,y,z,nx,ny,nz: a row for each ray; a miss has hit = 0 and empty fields.
void write_hits(OutputFile& out, std::span<const Hit> hits);

}  // namespace tessera::cli
