#pragma once
// The integrals over the kept part of one surface.

#include <optional>
#include <vector>

#include "measure/strip.h"
#include "tessera/convert.h"
#include "tessera/measures.h"
#include "tessera/model.h"
#include "tessera/trim_region.h"

namespace tessera { inline namespace abi_0_1 {

/// A surface as patches, and the region that its loops keep.
struct MeasuredFace {
  PatchGrid grid;
  std::optional<TrimRegion> region = {};  ///< made for patches; nothing: all is kept
  ParameterPoint loop_error = {};         ///< see kept_strips()
  double data_error = 0;                  ///< of each control point
  bool proven = true;
  Status fault = {};  ///< why the loops could not be used
};

/// Converts a surface. `loops`: in its own parameters; none: all is kept. Errors: those of to_bezier().
Result<MeasuredFace> make_face(const ModelSurface& surface, const std::vector<TrimLoop>& loops);

/// The integrals over a face.
struct FaceIntegrals {
  ExactSums area, flux;
  bool proven = true;
};
/// Integrates over a face, relative to a centre of moments.
FaceIntegrals integrate(const MeasuredFace& face, const Vec3& centre, bool area, bool flux,
                        const MeasureOptions& options);

/// Checks the options. Errors: invalid_argument.
Status check_options(const MeasureOptions& options);

}}  // namespace tessera::abi_0_1
