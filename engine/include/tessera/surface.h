#pragma once
// A surface of any kind. tessera/convert.h converts it.
//
// Threads: any number of calls at once on const surfaces, if their functions allow it.

#include <array>
#include <string_view>
#include <variant>

#include "tessera/bezier_patch.h"
#include "tessera/coons_patch.h"
#include "tessera/hermite_patch.h"
#include "tessera/nurbs_surface.h"
#include "tessera/parametric_surface.h"
#include "tessera/quadric.h"
#include "tessera/tensor_patch.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// A surface of any kind.
using Surface = std::variant<BezierPatch, TensorPatch, BSplineSurface, HermitePatch, HermiteNetwork, RuledSurface,
                             CoonsPatch, ExplicitPolynomial, QuadricPiece, ParametricSurface>;

/// Returns the kind's name for messages: "Bezier patch", "NURBS surface" and others.
std::string_view kind_name(const Surface& surface);
/// Returns the rectangle of the surface's own parameters; [0,1]^2 for a Bezier patch.
Domain domain(const Surface& surface);
/// Evaluates by the kind's own reference evaluator. Errors: those of callables.
Result<SurfaceJet> evaluate_jet(const Surface& surface, double u, double v);
/// Returns the surface's own parameters of the point that its patches have at (u,v) of to_bezier()'s grid. They are
/// (u,v) for all kinds but quadrics, whose arcs are rational: see canonical_parameters().
std::array<double, 2> own_parameters(const Surface& surface, double u, double v);
/// Returns the parameters in to_bezier()'s grid of the point at the surface's own (u,v): the inverse of
/// own_parameters().
std::array<double, 2> grid_parameters(const Surface& surface, double u, double v);

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
