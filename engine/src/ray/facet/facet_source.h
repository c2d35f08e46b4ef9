#pragma once
// What grid mode traces: facets over the patches of a set.

#include <cstddef>
#include <memory>
#include <optional>

#include "ray/embree/embree_scene.h"
#include "ray/scene/set_view.h"
#include "tessera/mesh.h"
#include "tessera/patch_set.h"
#include "tessera/status.h"

namespace tessera::inline abi_0_1 {

class FacetSource {
 public:
  virtual ~FacetSource() = default;
  /// Makes the facets for the set as it is now and the BVH over them, which borrows them. After an error the scene is empty.
  virtual Status build(const SetView& set, EmbreeScene& scene, const Execution& execution) = 0;
  // Of what was built:
  /// An upper bound of the facets' distances from the surface.
  virtual double deviation(const SetView& set) const = 0;
  /// The longest side of a facet in the parameters of its patch.
  virtual double largest_cell() const = 0;
  /// What the BVH has met, by patch and its parameters.
  virtual FacetHit located(const FacetHit& hit) const = 0;
  virtual std::size_t memory_bytes() const = 0;
};

/// Grids of rate x rate cells a patch, evaluated into memory of their own. Errors: those of UniformGrid, unsupported (too
/// many vertices).
Result<std::unique_ptr<FacetSource>> grid_facets(const PatchSet& set, int rate, std::optional<Isa> isa);

/// The triangles and quads of a mesh of the set, where they are; it must stay there. Checked each time that it is built.
/// Errors of that: as of RayScene::make.
std::unique_ptr<FacetSource> mesh_facets(const Mesh& mesh);

}  // namespace tessera::inline abi_0_1
