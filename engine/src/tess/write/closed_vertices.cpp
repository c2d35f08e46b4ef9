#include "tess/write/closed_vertices.h"

#include <cmath>
#include <span>

#include "parallel/parallel_for.h"
#include "tess/trimmed/patch_points.h"
#include "tess/write/vertex_views.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t edited_patches_per_task = 16, places_per_task = 512;

class ClosedWriter {
 public:
  ClosedWriter(const PatchSet::Impl& set, const CertifiedPlan& plan, std::optional<double> crease_angle,
               const ParameterMaps& maps, const MeshViews& out)
      : set_(set),
        plan_(plan),
        closed_(*plan.closed()),
        maps_(maps),
        out_(out),
        apart_(crease_angle ? 2 * std::sin(*crease_angle / 2) : -1) {}

  void write_edit(const PatchEdit& edit) const {
    const Division& division = plan_.division(edit.patch);
    const std::size_t first = plan_.first_vertex(edit.patch), own = division.vertex_count();
    PatchPoints points(set_.patches[edit.patch], set_.origin);
    for (std::size_t k = 0; k < edit.vertices.size(); ++k) {
      const ParameterPoint& at = edit.vertices[k];
      const std::size_t vertex = first + own + k;
      put(vertex, points.at(at));
      if (!out_.normal.empty()) put_vector(out_.normal, vertex, points.normal(at));
      if (!out_.parameter.empty())
        maps_.of(edit.patch).put(out_.parameter, vertex, static_cast<float>(at.u), static_cast<float>(at.v));
    }
    const bool quads = !out_.quads.empty();
    const std::size_t begin = quads ? plan_.first_strip(edit.patch) : plan_.first_triangle(edit.patch);
    const std::size_t count = division.triangle_count() - (quads ? 2 * division.cell_count() : 0);
    const auto write = [&](std::size_t triangle, const PatchEdit::Triangle& corners) {
      for (std::size_t c = 0; c < 3; ++c)
        out_.indices[3 * (begin + triangle) + c] = static_cast<std::uint32_t>(first) + corners[c];
    };
    for (const auto& [triangle, corners] : edit.changed) write(triangle, corners);
    for (std::size_t k = 0; k < edit.added.size(); ++k) write(count + k, edit.added[k]);
  }

  /// Moves the vertices of a place to it. In another set than that of the plan, the place is the centre of their box.
  template <class T>
  void move(std::uint32_t place, const View3<T>& positions, const Vec3& origin) const {
    const std::span<const ClosedEdges::Member> of_place = members(place);
    Box3 box;
    for (const ClosedEdges::Member& member : of_place) {
      const std::size_t at = vertex(member);
      box.extend(Vec3{double(positions.at(at, 0)), double(positions.at(at, 1)), double(positions.at(at, 2))});
    }
    Vec3 to = closed_.places[place] + origin;
    const double far = 0x1p-20 * (max_abs(box.lower) + max_abs(box.upper));  // above all rounding
    if (!(max_abs(to - box.centre()) <= max_abs(box.upper - box.lower) / 2 + far)) to = box.centre();
    for (const ClosedEdges::Member& member : of_place) put_vector(positions, vertex(member), to);
  }

  /// Gives the vertices of a place the normal of the first of them that is at most `apart_` away.
  void join_normals(std::uint32_t place) const {
    const std::span<const ClosedEdges::Member> of_place = members(place);
    const auto normal = [&](std::size_t k) {
      const std::size_t at = vertex(of_place[k]);
      return Vec3{double(out_.normal.at(at, 0)), double(out_.normal.at(at, 1)), double(out_.normal.at(at, 2))};
    };
    for (std::size_t k = 1; k < of_place.size(); ++k)
      for (std::size_t before = 0; before < k; ++before)
        if (length(normal(k) - normal(before)) <= apart_) {
          copy(out_.normal, vertex(of_place[before]), vertex(of_place[k]));
          break;
        }
  }

 private:
  std::span<const ClosedEdges::Member> members(std::uint32_t place) const {
    const std::uint32_t first = closed_.first_members[place];
    return std::span(closed_.members).subspan(first, closed_.first_members[place + 1] - first);
  }
  std::size_t vertex(const ClosedEdges::Member& member) const {
    return plan_.first_vertex(member.patch) + member.vertex;
  }
  void put(std::size_t vertex, const Vec3& p) const {
    if (!out_.position.empty()) put_vector(out_.position, vertex, p);
    if (!out_.model_position.empty()) put_vector(out_.model_position, vertex, set_.origin + p);
  }

  const PatchSet::Impl& set_;
  const CertifiedPlan& plan_;
  const ClosedEdges& closed_;
  const ParameterMaps& maps_;
  const MeshViews& out_;
  double apart_;  ///< how far the tips of joined normals may lie apart
};

}  // namespace

Status write_closed(const PatchSet::Impl& set, const CertifiedPlan& plan, std::optional<double> crease_angle,
                    const ParameterMaps& maps, const MeshViews& out, const Execution& execution) {
  const ClosedWriter writer(set, plan, crease_angle, maps, out);
  const ClosedEdges& closed = *plan.closed();
  const Execution quiet{.cancel = execution.cancel};
  const auto write = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) writer.write_edit(closed.edits[k]);
  };
  if (Status status = parallel_for(closed.edits.size(), edited_patches_per_task, quiet, write); !status.ok())
    return status;
  const auto move = [&](std::size_t begin, std::size_t end) {
    for (auto place = static_cast<std::uint32_t>(begin); place < end; ++place) {
      if (!out.position.empty()) writer.move(place, out.position, {});
      if (!out.model_position.empty()) writer.move(place, out.model_position, set.origin);
      if (!out.normal.empty() && crease_angle) writer.join_normals(place);
    }
  };
  return parallel_for(closed.first_members.size() - 1, places_per_task, quiet, move);
}

}}  // namespace tessera::abi_0_1
