#include "convert/peer_surface.h"

#include <memory>

#include "tessera/convert.h"

namespace tessera::test {
namespace {

/// The value; if there is none, stores the status in the surface.
template <class T>
std::shared_ptr<const T> kept(const Result<T>& result, PeerSurface& surface) {
  if (result.ok()) return std::make_shared<const T>(*result);
  surface.status = result.status();
  surface.routes.clear();
  return nullptr;
}

Route patches_route(std::shared_ptr<const PatchGrid> grid) {
  return {"patches", [grid](double u, double v) { return grid->evaluate_jet(u, v); }};
}

/// The Bezier patches of all pieces as one grid.
Result<PatchGrid> peer_grid(std::span<const TensorPatch> pieces) {
  std::vector<double> breaks_u{pieces[0].domain().u0}, breaks_v{pieces[0].domain().v0};
  std::vector<BezierPatch> patches;
  for (const TensorPatch& piece : pieces) {
    if (piece.domain().u1 > breaks_u.back()) breaks_u.push_back(piece.domain().u1);
    if (piece.domain().v1 > breaks_v.back()) breaks_v.push_back(piece.domain().v1);
    const Result<PatchGrid> one = to_bezier(piece);
    if (!one) return one.status();
    patches.push_back(one->patches()[0]);
  }
  return PatchGrid::make(breaks_u, breaks_v, patches);
}

}  // namespace

void PeerSurface::add(const Result<BSplineSurface>& surface) {
  const auto spline = kept(surface, *this);
  if (!spline) return;
  routes.push_back({"de Boor", [spline](double u, double v) { return evaluate_jet(*spline, u, v); }});
  if (const auto grid = kept(to_bezier(*spline), *this)) routes.push_back(patches_route(grid));
}

void PeerSurface::add(const Result<BezierPatch>& patch) {
  const auto own = kept(patch, *this);
  if (own) routes.push_back({"its own patch", [own](double u, double v) { return evaluate_jet(*own, u, v); }});
}

void PeerSurface::add(std::span<const TensorPatch> pieces) {
  const std::vector<TensorPatch> own(pieces.begin(), pieces.end());
  routes.push_back({"its bases", [own](double u, double v) -> std::optional<SurfaceJet> {
                      for (const TensorPatch& piece : own)
                        if (piece.domain().contains(u, v)) return evaluate_jet(piece, u, v);
                      return std::nullopt;
                    }});
  if (const auto grid = kept(peer_grid(pieces), *this)) routes.push_back(patches_route(grid));
}

}  // namespace tessera::test
