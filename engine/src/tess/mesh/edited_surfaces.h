#pragma once
// Edits of spline surfaces, as edits of the Bezier patches that a set holds of them.

#include <memory>
#include <vector>

#include "convert/spline/edited_spline.h"
#include "tessera/tessellation.h"

namespace tessera { inline namespace abi_0_1 {

/// Holds the memory for conversions, so that repeated ones allocate nothing.
class EditedSurfaces {
 public:
  /// Converts the patches that moved control points act on. The result is valid until the next call. Errors, index =
  /// the edit: invalid_argument (patches of the set that are not those of the spline, a surface named twice, no such
  /// control point), count_mismatch (points); cancelled, out_of_memory.
  Result<PatchEdits> convert(const PatchSet& set, std::span<const SurfaceEdits> edits, const Execution& execution);
  /// Ends a call: `status` is the update's, by the edits that convert() returned. Returns it with the index of the
  /// surface's edit. After an error all points are computed anew next time.
  Status finish(const PatchSet& set, std::span<const SurfaceEdits> edits, const Status& status);

 private:
  struct Surface {
    explicit Surface(const BSplineSurface& spline) : converted(spline) {}
    EditedSpline converted;
    std::uint32_t number = 0;       ///< in the set
    std::uint32_t first_patch = 0;  ///< its patches follow each other
    bool is_edited = false;         ///< by the present call
  };

  /// Finds the surface that an edit names, or makes it.
  Result<Surface*> surface_of(const PatchSet& set, const SurfaceEdits& edit);

  std::vector<std::unique_ptr<Surface>> surfaces_;
  std::vector<std::uint32_t> patches_;
  std::vector<Vec3> points_;
};

}}  // namespace tessera::abi_0_1
