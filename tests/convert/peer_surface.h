#pragma once
// A surface of a peer in all ways that the library can evaluate it.

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tessera/nurbs_surface.h"
#include "tessera/tensor_patch.h"

namespace tessera::test {

/// One way to evaluate a surface by its own parameters; empty outside its domain.
struct Route {
  const char* name;
  std::function<std::optional<SurfaceJet>(double u, double v)> jet;
};

struct PeerSurface {
  std::string name;
  int dimension = 3;  ///< planar surfaces leave z alone
  Status status;      ///< why the library rejects the surface, which then has no routes
  std::vector<Route> routes;

  // Each adds the routes by the reference evaluator and by the Bezier patches.
  void add(const Result<BSplineSurface>& surface);
  void add(const Result<BezierPatch>& patch);
  /// Pieces between breakpoints, those of one strip of u after the other.
  void add(std::span<const TensorPatch> pieces);
};

}  // namespace tessera::test
