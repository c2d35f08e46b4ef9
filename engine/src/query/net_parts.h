#pragma once
// Parts of a patch as nets of their own.

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "base/impl_access.h"
#include "query/nearest_foot.h"
#include "query/piece_facts.h"
#include "ray/leaf/leaf_cuts.h"
#include "ray/line/ray_line.h"
#include "ray/net/projected_net.h"
#include "tessera/bezier_patch.h"
#include "tessera/geometry.h"
#include "tessera/trim_region.h"
#include "trim/trim_region_impl.h"

namespace tessera { inline namespace abi_0_1 {

/// The net of a patch in a scene's coordinates, and those of its parts.
class NetParts {
 public:
  NetParts() = default;
  NetParts(const BezierPatch& patch, const SceneFrame& frame) { start(patch, frame); }

  void start(const BezierPatch& patch, const SceneFrame& frame) {
    shape_ = {patch.degree_u(), patch.degree_v()};
    is_rational_ = patch.is_rational();
    write_patch(patch, frame, whole_);
  }
  /// Returns the net of a part, until the next call.
  PieceNet part(const PatchPart& area) {
    std::copy_n(whole_, components() * shape_.size(), part_);
    if (area.u0 > 0 || area.u1 < 1) restrict_net(shape_, components(), part_, true, area.u0, area.u1);
    if (area.v0 > 0 || area.v1 < 1) restrict_net(shape_, components(), part_, false, area.v0, area.v1);
    return {shape_.m(), shape_.n(), is_rational_, part_};
  }

 private:
  static constexpr std::size_t most = std::size_t{4} * (max_degree + 1) * (max_degree + 1);
  int components() const { return is_rational_ ? 4 : 3; }

  NetShape<0, 0> shape_{1, 1};
  bool is_rational_ = false;
  double whole_[most], part_[most];
};

/// Whether a part is better halved along u: there it is much longer, or its derivatives turn more. Towards a pole,
/// parts that are as long as wide turn as much around it, however small they are.
template <class T>
bool halves_u(const PieceFacts<T>& f) {
  constexpr double much = 4, least_turn = 0.1, no_bound = 1e20;
  const auto size = [](const T(&bend)[3][2]) {
    double sum = 0;
    for (const auto& [low, high] : bend) sum += double(std::max(-low, high));
    return sum;
  };
  const double xy = double(f.bend_xy[0]) + double(f.bend_xy[1]) + double(f.bend_xy[2]);
  const double length_u = double(f.length_u), length_v = double(f.length_v);
  const double by_u = length_u * (size(f.bend_xx) + xy), by_v = length_v * (size(f.bend_yy) + xy);
  const double turn = std::max(by_u, by_v), longer = std::max(length_u, length_v);
  const bool by_length = longer > much * std::min(length_u, length_v) || turn < least_turn || xy > no_bound;
  return by_length ? length_u >= length_v : by_u >= by_v;
}

/// Returns the halves of a part.
template <class T>
std::pair<PatchPart, PatchPart> halves(const PatchPart& area, const PieceFacts<T>& facts) {
  PatchPart lower = area, upper = area;
  if (halves_u(facts))
    lower.u1 = upper.u0 = 0.5 * (area.u0 + area.u1);
  else
    lower.v1 = upper.v0 = 0.5 * (area.v0 + area.v1);
  return {lower, upper};
}

/// Returns a part of a patch in the parameters of its surface.
inline Domain rectangle_of(const Domain& patch, const PatchPart& area) {
  return {patch.u_at(area.u0), patch.u_at(area.u1), patch.v_at(area.v0), patch.v_at(area.v1)};
}

/// Returns the side of all points of a rectangle of a face, or `border` if a loop may pass. Cells of a region tell this
/// for rectangles of up to two cells in a row, so wider ones are halved a few times.
inline TrimSide side_of_all(const TrimRegion& region, const Domain& box, int halvings = 3) {
  const TrimRegion::Impl& impl = impl_of(region);
  const TrimSide side = impl.cells.locate_all(box);
  if (side != TrimSide::border || halvings == 0) return side;
  Domain lower = box, upper = box;
  const bool halves_u =
      (box.u1 - box.u0) * (impl.domain.v1 - impl.domain.v0) >= (box.v1 - box.v0) * (impl.domain.u1 - impl.domain.u0);
  if (halves_u)
    lower.u1 = upper.u0 = 0.5 * box.u0 + 0.5 * box.u1;
  else
    lower.v1 = upper.v0 = 0.5 * box.v0 + 0.5 * box.v1;
  const TrimSide first = side_of_all(region, lower, halvings - 1);
  if (first == TrimSide::border) return first;
  return side_of_all(region, upper, halvings - 1) == first ? first : TrimSide::border;
}

}}  // namespace tessera::abi_0_1
