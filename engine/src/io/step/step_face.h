#pragma once
// One face of a STEP file as a trimmed NURBS surface.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "io/step/step_geometry.h"
#include "io/step/step_topology.h"
#include "tessera/brep.h"
#include "tessera/nurbs_surface.h"
#include "tessera/status.h"
#include "tessera/trim_loop.h"

namespace tessera { inline namespace abi_0_1 {

/// Data that the faces of one part share.
struct StepFaceContext {
  const StepGeometry& geometry;
  std::span<const BrepEdge> edges;
  const std::vector<bool>& reversed_curves;  ///< of each edge, whether its curve runs from its end to its start
  std::span<const BrepVertex> vertices;
  double tolerance;  ///< points that are nearer to each other are one; > 0
};

/// An edge that the file does not have: along a pole, or along a side of a surface that is a face by itself.
struct StepOwnEdge {
  struct Use {
    std::size_t loop = 0, curve = 0;
  };
  BrepEdge edge;
  std::vector<Use> uses;
};

struct StepFaceResult {
  BSplineSurface surface;
  std::vector<TrimLoop> loops;
  bool whole = false;  ///< one loop runs along all sides of the domain, and trims nothing
  std::vector<StepOwnEdge> own_edges;
  double fit_error = 0;   ///< how far the surface is from the file's, where it had to be fitted
  bool is_rough = false;  ///< a curve of a loop is farther from the surface's nearest points than it should be
};

/// Converts a face. Errors: those of the geometry; unsupported (no bounds, no extent, an edge without a curve).
Result<StepFaceResult> step_face(const StepFace& face, const StepFaceContext& context);

}}  // namespace tessera::abi_0_1
