#pragma once
// Parts of a model that are meshed one by one as the whole would be.
//
// Memory: results own theirs, arguments are not kept. Threads: any number of calls at once, if the functions of the
// model's surfaces allow it.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tessera/convert.h"
#include "tessera/geometry.h"
#include "tessera/model.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// Where the surfaces of a model lie.
struct SurfaceExtents {
  std::vector<Box3> boxes;  ///< `[surface]`: of the control points of the patches that loops keep; empty if none is
  FitError fit_error;       ///< the largest of all surfaces, certified if all are
  /// Returns the box of all surfaces.
  Box3 box() const {
    Box3 all;
    for (const Box3& box : boxes) all.extend(box);
    return all;
  }
};
/// Converts all surfaces and finds their extents. Errors: those of make_patch_set() for the model.
Result<SurfaceExtents> surface_extents(const Model& model, const FitOptions& fit = {});

/// Some surfaces of a model, and all surfaces around them. tessellate_part() (part_mesh.h) divides the wanted ones, and
/// cuts them, as a set of the whole model does.
struct ModelPart {
  /// Surfaces in the order of the whole; of instances those that have any of them, with shapes of their own that hold
  /// these faces and their edges and vertices. Shells are left out.
  Model model;
  std::vector<std::uint64_t> surfaces;  ///< `[surface of this model]`: its index in the whole; increasing
  std::size_t first = 0, end = 0;       ///< the wanted ones, as indices into model.surfaces; the others surround them
  Box3 own_box;                         ///< of the wanted ones; empty if loops keep nothing of them
  Box3 box;                             ///< of the whole model
  FitError fit_error;                   ///< of the whole model
};

/// Returns the surfaces from `first` until `end` of a model, and two rings around them: first the surfaces that touch
/// these, then those that touch the first ring. Surfaces touch if their boxes come within `reach` of each other in each
/// coordinate, or if they are of one instance and share an edge or a vertex. The second ring counts where welding moves
/// the borders of the first, and where chords of a face cross and are divided.
///
/// - `extents`: of the model.
/// - `reach`: a length, at least 0; see part_reach().
///
/// Errors: those of check_topology(); invalid_argument (a range that ends beyond the last surface or before it begins;
/// a negative reach), count_mismatch (boxes), out_of_memory. Memory: surfaces share geometry with the whole; loops
/// whose coedges have other numbers here are copied.
Result<ModelPart> part_of(const Model& model, const SurfaceExtents& extents, std::size_t first, std::size_t end,
                          double reach);

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
