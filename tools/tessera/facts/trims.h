#pragma once
// The trimming loops of a model, and how they were repaired.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "stages/load.h"
#include "tessera/trim_loop.h"

namespace tessera::cli {

/// A remark about a loop of a surface; without a fault, the error for which the surface's loops cannot be used.
struct SurfaceRemark {
  std::size_t surface = 0;
  std::optional<std::size_t> loop;
  std::optional<LoopFault> fault;
  double size = 0;
  std::string text;
};

struct TrimFacts {
  std::size_t trimmed = 0, loops = 0;
  std::vector<SurfaceRemark> remarks;  ///< in the order of the surfaces
};

/// Repairs the loops of all surfaces, whose patches must be loaded, and gathers the remarks.
TrimFacts find_trims(const Loaded& loaded);

/// Adds the facts of `info`; in words only if a surface is trimmed.
void add_trims(Report& report, const TrimFacts& facts, const Model& model);

}  // namespace tessera::cli
