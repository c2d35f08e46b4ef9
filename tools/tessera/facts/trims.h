#pragma once
// The trimming loops of a model, and how they were repaired.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "console/json.h"
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

/// Lines of `info`; empty if no surface is trimmed.
std::string trims_lines(const TrimFacts& facts, const Loaded& loaded);
Json remarks_json(const TrimFacts& facts);

}  // namespace tessera::cli
