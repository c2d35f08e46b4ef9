#pragma once
// The facets over the patches of a set that grid mode traces.

#include <cstddef>
#include <memory>
#include <optional>

#include "ray/line/set_view.h"
#include "ray/tree/facet_tree.h"
#include "tessera/mesh.h"
#include "tessera/patch_set.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

class FacetSource {
 public:
  virtual ~FacetSource() = default;
  /// Makes the facets for the set as it is now, and the tree over them, which borrows them. After an error the tree is
  /// empty.
  virtual Status build(const SetView& set, FacetTree& tree, const Execution& execution) = 0;
  // The functions below describe the facets that were built.

  /// Returns an upper bound of the facets' distances from the surface.
  virtual double deviation(const SetView& set) const = 0;
  /// Returns the longest side of a facet in the parameters of its patch.
  virtual double largest_cell() const = 0;
  /// Converts a hit of the tree to a patch and its parameters.
  virtual FacetHit located(const FacetHit& hit) const = 0;
  virtual std::size_t memory_bytes() const = 0;
};

/// Makes grids of rate x rate cells per patch, evaluated into memory of their own. Errors: those of UniformGrid,
/// unsupported (too many vertices).
Result<std::unique_ptr<FacetSource>> grid_facets(const PatchSet& set, int rate, std::optional<Isa> isa);

/// Uses the triangles and quads of a mesh of the set in place; the mesh must stay there. Each build checks it. Errors
/// of a build: as of RayScene::make.
std::unique_ptr<FacetSource> mesh_facets(const Mesh& mesh);

}}  // namespace tessera::abi_0_1
