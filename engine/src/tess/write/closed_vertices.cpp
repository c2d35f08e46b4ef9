#include "tess/write/closed_vertices.h"

#include <algorithm>
#include <optional>

#include "parallel/parallel_for.h"
#include "tess/trimmed/patch_points.h"
#include "tess/write/vertex_views.h"

namespace tessera::inline abi_0_1 {
namespace {

constexpr std::size_t patches_per_task = 16, members_per_task = 512;

class ClosedWriter {
 public:
  ClosedWriter(const PatchSet::Impl& set, const CertifiedPlan& plan, const MeshViews& out)
      : set_(set), plan_(plan), closed_(*plan.closed()), out_(out) {}

  void write_edit(const PatchEdit& edit) const {
    const Division& division = plan_.division(edit.patch);
    const std::size_t first = plan_.first_vertex(edit.patch), own = division.vertex_count();
    PatchPoints points(set_.patches[edit.patch], set_.origin);
    for (std::size_t k = 0; k < edit.vertices.size(); ++k) {
      const ParameterPoint& at = edit.vertices[k];
      const std::size_t vertex = first + own + k;
      put(vertex, points.at(at));
      if (!out_.normal.empty()) put_vector(out_.normal, vertex, points.normal(at));
      if (!out_.parameter.empty()) {
        out_.parameter.at(vertex, 0) = static_cast<float>(at.u);
        out_.parameter.at(vertex, 1) = static_cast<float>(at.v);
      }
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

  /// Finds the patches' own points of members [begin, end).
  void evaluate(std::size_t begin, std::size_t end, std::vector<Vec3>& own) const {
    std::optional<PatchPoints> points;
    std::uint32_t patch = CutPatch::none;
    for (std::size_t k = begin; k < end; ++k) {
      const ClosedEdges::Member& member = closed_.members[k];
      if (member.patch != patch) {
        patch = member.patch;
        points.emplace(set_.patches[patch], set_.origin);
      }
      own[k] = points->at(local(member));
    }
  }

  void put(std::size_t vertex, const Vec3& p) const {
    if (!out_.position.empty()) put_vector(out_.position, vertex, p);
    if (!out_.position_f64.empty()) put_vector(out_.position_f64, vertex, set_.origin + p);
  }

 private:
  ParameterPoint local(const ClosedEdges::Member& member) const {
    const auto cut = std::ranges::lower_bound(plan_.cuts(), member.patch, {}, &CutPatch::patch);
    if (cut != plan_.cuts().end() && cut->patch == member.patch) return cut->vertices[member.vertex];
    const Division& division = plan_.division(member.patch);
    const std::size_t own = division.vertex_count();
    if (member.vertex >= own) {
      const auto edit = std::ranges::lower_bound(closed_.edits, member.patch, {}, &PatchEdit::patch);
      return edit->vertices[member.vertex - own];
    }
    const Division::Parameters at = division.parameters(member.vertex);
    return {at.u, at.v};
  }

  const PatchSet::Impl& set_;
  const CertifiedPlan& plan_;
  const ClosedEdges& closed_;
  const MeshViews& out_;
};

}  // namespace

Status write_closed(const PatchSet::Impl& set, const CertifiedPlan& plan, const MeshViews& out,
                    const Execution& execution) {
  const ClosedWriter writer(set, plan, out);
  const ClosedEdges& closed = *plan.closed();
  const Execution quiet{.cancel = execution.cancel};
  const auto write = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) writer.write_edit(closed.edits[k]);
  };
  if (Status status = parallel_for(closed.edits.size(), patches_per_task, quiet, write); !status.ok()) return status;
  std::vector<Vec3> own(closed.members.size());
  const auto evaluate = [&](std::size_t begin, std::size_t end) { writer.evaluate(begin, end, own); };
  if (Status status = parallel_for(own.size(), members_per_task, quiet, evaluate); !status.ok()) return status;
  const std::vector<Vec3> at = middles(closed.members, own, closed.place_count);
  for (const ClosedEdges::Member& member : closed.members)
    writer.put(plan.first_vertex(member.patch) + member.vertex, at[member.place]);
  return {};
}

}  // namespace tessera::inline abi_0_1
