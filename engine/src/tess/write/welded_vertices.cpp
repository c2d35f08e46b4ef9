#include "tess/write/welded_vertices.h"

#include <array>

#include "parallel/parallel_for.h"
#include "tess/edges/side_curve.h"
#include "tess/plan/ring_vertices.h"
#include "tess/write/vertex_views.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t copies_per_piece = 64;

/// Calls visit(vertex, vertex that it is copied from) for the points inside a border.
template <class Visit>
void for_copies(const VertexCopies::Border& border, const CertifiedPlan& plan, Visit visit) {
  const RingVertices to(plan, border.to), from(plan, border.from);
  const bool opposite = (is_backward(border.to) != is_backward(border.from)) != border.reversed;
  for (int k = 1; k < to.rate(); ++k) visit(to(k), from(opposite ? to.rate() - k : k));
}

/// `has_own_normals`: whether the patch has been written, so that its normals there are those of the short border.
Status write_pole(const VertexCopies::Corner& pole, const CertifiedPlan& plan, const PatchSet::Impl& set,
                  const MeshViews& out, bool has_own_normals) {
  const RingVertices to(plan, pole.to), from(plan, pole.from);
  for (int k = 1; k < to.rate(); ++k) copy_positions(out, from(0), to(k));
  if (out.normal.empty() || !has_own_normals) return {};
  const Side side = all_sides[pole.to % 4];
  const bool is_point = set.collapsed[pole.to / 4].has(side);
  const Result<BezierPatch> patch =
      is_point ? Result<BezierPatch>(set.patches[pole.to / 4]) : with_pole(set.patches[pole.to / 4], side);
  if (!patch) return patch.status();
  const auto owns = [&](int k) {
    if (k == 0) return plan.owns_corner(pole.to);
    return k == to.rate() ? plan.owns_corner(pole.to - pole.to % 4 + (pole.to + 1) % 4) : plan.owns_border(pole.to);
  };
  for (int k = 0; k <= to.rate(); ++k) {
    if (!owns(k)) continue;
    const Segments::Fraction at = plan.division(pole.to / 4).along_ring(side).at(k);
    const double t = is_backward(side) ? at.rest() : at.value();
    const ParameterPoint on_side = point_beside(side, t, is_far(side));
    const Vec3 n = unit_normal(*patch, on_side.u, on_side.v).direction;
    const std::array<double, 3> normal{n.x, n.y, n.z};
    for (int c = 0; c < 3; ++c) out.normal.at(to(k), c) = static_cast<float>(normal[static_cast<std::size_t>(c)]);
  }
  return {};
}

}  // namespace

Status write_welded(const VertexCopies& weld, const CertifiedPlan& plan, const PatchSet::Impl& set,
                    const MeshViews& out, const Execution& execution, FunctionRef<bool(std::size_t patch)> is_written) {
  const auto is_due = [&](const auto& copy) { return is_written(copy.to / 4) || is_written(copy.from / 4); };
  const auto borders = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      if (is_due(weld.borders[k]))
        for_copies(weld.borders[k], plan, [&](std::size_t to, std::size_t from) { copy_positions(out, from, to); });
  };
  const Execution quiet{.cancel = execution.cancel};
  if (Status status = parallel_for(weld.borders.size(), copies_per_piece, quiet, borders); !status.ok()) return status;
  for (const VertexCopies::Corner& corner : weld.corners)
    if (is_due(corner)) copy_positions(out, plan.ring_vertex(corner.from, 0), plan.ring_vertex(corner.to, 0));
  for (const VertexCopies::Corner& pole : weld.poles)
    if (is_due(pole))
      if (Status status = write_pole(pole, plan, set, out, is_written(pole.to / 4)); !status.ok()) return status;
  return {};
}

Status write_joined_normals(const VertexCopies& joins, const CertifiedPlan& plan, const View3<float>& normals,
                            const Execution& execution, FunctionRef<bool(std::size_t patch)> is_written) {
  const auto is_due = [&](const auto& join) { return is_written(join.to / 4) || is_written(join.from / 4); };
  const auto borders = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      if (is_due(joins.borders[k]))
        for_copies(joins.borders[k], plan, [&](std::size_t to, std::size_t from) { copy(normals, from, to); });
  };
  const Execution quiet{.cancel = execution.cancel};
  if (Status status = parallel_for(joins.borders.size(), copies_per_piece, quiet, borders); !status.ok()) return status;
  for (const VertexCopies::Corner& corner : joins.corners)
    if (is_due(corner)) copy(normals, plan.ring_vertex(corner.from, 0), plan.ring_vertex(corner.to, 0));
  for (const VertexCopies::Corner& pole : joins.poles) {
    const RingVertices to(plan, pole.to);
    for (int k = 1; k < to.rate() && is_due(pole); ++k) copy(normals, plan.ring_vertex(pole.from, 0), to(k));
  }
  return {};
}

}}  // namespace tessera::abi_0_1
