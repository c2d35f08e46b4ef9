#pragma once
// Rays to time exact and grid scenes: coherent, incoherent and grazing ones at a torus of bicubic patches.

#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "support/synthetic_sets.h"
#include "support/torus.h"
#include "tessera/patch_set.h"
#include "tessera/ray_scene.h"

namespace tessera::bench {

constexpr std::size_t ray_count = 65536;

/// A torus, and rays at it.
struct TorusRays {
  TorusRays(std::size_t side, bool rational);

  test::Torus torus;
  std::vector<BezierPatch> patches;
  PatchSet set;
  bool is_rational;
  std::map<std::string, std::vector<Ray>> rays;  ///< by kind, ray_count each
};

}  // namespace tessera::bench
