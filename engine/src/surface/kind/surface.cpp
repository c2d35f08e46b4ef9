#include "tessera/surface.h"

#include "base/overloaded.h"

namespace tessera { inline namespace abi_0_1 {
std::string_view kind_name(const Surface& surface) {
  return std::visit(Overloaded{
                        [](const BezierPatch& s) { return s.is_rational() ? "rational Bezier patch" : "Bezier patch"; },
                        [](const TensorPatch&) { return "tensor patch"; },
                        [](const BSplineSurface& s) { return s.is_rational() ? "NURBS surface" : "B-spline surface"; },
                        [](const HermitePatch&) { return "Hermite patch"; },
                        [](const HermiteNetwork&) { return "Hermite network"; },
                        [](const RuledSurface&) { return "ruled surface"; },
                        [](const CoonsPatch&) { return "Coons patch"; },
                        [](const ExplicitPolynomial&) { return "explicit polynomial"; },
                        [](const QuadricPiece&) { return "quadric"; },
                        [](const ParametricSurface&) { return "parametric surface"; },
                    },
                    surface);
}

Domain domain(const Surface& surface) {
  return std::visit(Overloaded{
                        [](const BezierPatch&) { return Domain{}; },
                        [](const ExplicitPolynomial& s) { return s.rectangle(); },
                        [](const QuadricPiece& s) { return s.range(); },
                        [](const auto& s) { return s.domain(); },
                    },
                    surface);
}

Result<SurfaceJet> evaluate_jet(const Surface& surface, double u, double v) {
  return std::visit([&](const auto& s) -> Result<SurfaceJet> { return evaluate_jet(s, u, v); }, surface);
}

std::array<double, 2> own_parameters(const Surface& surface, double u, double v) {
  const QuadricPiece* const piece = std::get_if<QuadricPiece>(&surface);
  if (!piece) return {u, v};
  const QuadricParameters canonical = canonical_parameters(*piece, u, v);
  return {canonical.u, canonical.v};
}

std::array<double, 2> grid_parameters(const Surface& surface, double u, double v) {
  const QuadricPiece* const piece = std::get_if<QuadricPiece>(&surface);
  if (!piece) return {u, v};
  const QuadricParameters grid = grid_parameters(*piece, u, v);
  return {grid.u, grid.v};
}

}}  // namespace tessera::abi_0_1
