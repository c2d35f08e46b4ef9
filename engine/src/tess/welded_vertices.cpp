#include "tess/welded_vertices.h"

#include <array>

#include "parallel/parallel_for.h"
#include "tess/border_curve.h"

namespace tessera {
namespace {

constexpr std::size_t copies_a_piece = 64;

/// The vertices of a border in the order of the ring, the corner at its end, which is the next side's, included.
struct RingVertices {
  std::size_t ring, start, count;
  int rate;

  RingVertices(const CertifiedPlan& plan, std::uint32_t border) {
    const Division& division = plan.division(border / 4);
    ring = plan.first_vertex(border / 4) + division.inner_count();
    count = division.ring_count();
    start = 0;
    for (std::size_t side = 0; side < border % 4; ++side) start += static_cast<std::size_t>(division.border[side]);
    rate = division.border[border % 4];
  }
  std::size_t operator()(int k) const { return ring + (start + static_cast<std::size_t>(k)) % count; }
};

void copy(const View3<float>& positions, std::size_t from, std::size_t to) {
  for (int c = 0; c < 3; ++c) positions.at(to, c) = positions.at(from, c);
}

/// Whether the ring runs against the parameter along a border.
bool is_backward(std::uint32_t border) { return border % 4 >= 2; }

void write_border(const Weld::Border& border, const CertifiedPlan& plan, const MeshViews& out) {
  const RingVertices to(plan, border.to), from(plan, border.from);
  const bool opposite = (is_backward(border.to) != is_backward(border.from)) != border.reversed;
  for (int k = 1; k < to.rate; ++k) copy(out.position, from(opposite ? to.rate - k : k), to(k));
}

Status write_pole(const Weld::Corner& pole, const CertifiedPlan& plan, const PatchSet::Impl& set,
                  const MeshViews& out) {
  const RingVertices to(plan, pole.to), from(plan, pole.from);
  for (int k = 1; k < to.rate; ++k) copy(out.position, from(0), to(k));
  if (out.normal.empty()) return {};
  const Side side = all_sides[pole.to % 4];
  const Result<BezierPatch> patch = with_pole(set.patches[pole.to / 4], side);
  if (!patch) return patch.status();
  for (int k = 0; k <= to.rate; ++k) {
    const double t = static_cast<double>(is_backward(pole.to) ? to.rate - k : k) / to.rate;
    const double across = side == Side::u1 || side == Side::v1 ? 1 : 0;
    const Vec3 n =
        runs_along_u(side) ? unit_normal(*patch, t, across).direction : unit_normal(*patch, across, t).direction;
    const std::array<double, 3> normal{n.x, n.y, n.z};
    for (int c = 0; c < 3; ++c) out.normal.at(to(k), c) = static_cast<float>(normal[static_cast<std::size_t>(c)]);
  }
  return {};
}

}  // namespace

Status write_welded(const Weld& weld, const CertifiedPlan& plan, const PatchSet::Impl& set, const MeshViews& out,
                    const Execution& execution, FunctionRef<bool(std::size_t patch)> is_written) {
  const auto is_due = [&](const auto& copy) { return is_written(copy.to / 4) || is_written(copy.from / 4); };
  const auto borders = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      if (is_due(weld.borders[k])) write_border(weld.borders[k], plan, out);
  };
  const Execution quiet{.cancel = execution.cancel};
  if (Status status = parallel_for(weld.borders.size(), copies_a_piece, quiet, borders); !status.ok()) return status;
  for (const Weld::Corner& corner : weld.corners)
    if (is_due(corner)) copy(out.position, RingVertices(plan, corner.from)(0), RingVertices(plan, corner.to)(0));
  for (const Weld::Corner& pole : weld.poles)
    if (is_due(pole))
      if (Status status = write_pole(pole, plan, set, out); !status.ok()) return status;
  return {};
}

}  // namespace tessera
