#pragma once
// Counts of a model: surfaces, patches, degrees, memory.

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "tessera/model.h"
#include "tessera/patch_set.h"

namespace tessera::cli {

/// The least and the largest of several values.
struct Range {
  double least = 0, largest = 0;
};

struct ModelCounts {
  std::map<std::string_view, std::size_t> kinds;       ///< kind -> surfaces
  std::map<std::pair<int, int>, std::size_t> degrees;  ///< (along u, along v) -> patches
  std::size_t rational = 0, control_points = 0;        ///< of patches
  std::size_t collapsed_sides = 0, patches_with_collapsed_sides = 0;
  Range u, v;  ///< the surfaces' own parameters
  std::size_t on_unit_square = 0;
  std::size_t model_bytes = 0, patch_bytes = 0, block_bytes = 0;
};

/// Counts. Sizes in memory are those of the surfaces with their points, weights, knots and trims, without the contents
/// of callables; of the patches; of their packed blocks with the tables that belong to them.
ModelCounts count_model(const Model& model, const PatchSet& set);

/// The size of a file; empty if it is not a regular file.
std::optional<std::uintmax_t> file_bytes(const std::string& path);

}  // namespace tessera::cli
