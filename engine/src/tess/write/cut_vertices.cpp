#include "tess/write/cut_vertices.h"

#include <algorithm>
#include <cmath>

#include "parallel/parallel_for.h"
#include "tess/plan/ring_vertices.h"
#include "tess/trimmed/patch_points.h"
#include "tess/write/vertex_views.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t cut_patches_per_task = 1;

class CutWriter {
 public:
  CutWriter(const PatchSet::Impl& set, const CertifiedPlan& plan, std::optional<double> crease_angle,
            const ParameterMaps& maps, const MeshViews& out)
      : set_(set), plan_(plan), maps_(maps), out_(out) {
    if (crease_angle) apart_ = 2 * std::sin(*crease_angle / 2);
  }

  void write(const CutPatch& cut) const {
    write_vertices(cut);
    for (const Side side : all_sides) take_border(cut, side);
    out_.quads.empty() ? write_triangles(cut) : write_faces(cut);
  }

 private:
  void write_triangles(const CutPatch& cut) const {
    const auto first = static_cast<std::uint32_t>(plan_.first_vertex(cut.patch));
    const std::size_t place = plan_.first_triangle(cut.patch);
    std::uint32_t* index = out_.indices.data() + 3 * place;
    for (const CutPatch::Triangle& triangle : cut.triangles)
      for (const std::uint32_t vertex : triangle) *index++ = first + vertex;
    if (!out_.patch.empty())
      std::fill_n(out_.patch.begin() + static_cast<std::ptrdiff_t>(place), cut.triangles.size(), cut.patch);
  }
  /// Writes quads and the other triangles.
  void write_faces(const CutPatch& cut) const {
    const auto first = static_cast<std::uint32_t>(plan_.first_vertex(cut.patch));
    std::size_t quad = plan_.first_quad(cut.patch), triangle = plan_.first_strip(cut.patch);
    const auto put = [&](const auto& corners, std::span<std::uint32_t> indices, std::span<std::uint32_t> patches,
                         std::size_t& place) {
      for (std::size_t c = 0; c < corners.size(); ++c) indices[corners.size() * place + c] = first + corners[c];
      if (!patches.empty()) patches[place] = cut.patch;
      ++place;
    };
    cut.for_faces([&](const auto& corners) { put(corners, out_.quads, out_.quad_patch, quad); },
                  [&](const auto& corners) { put(corners, out_.indices, out_.patch, triangle); });
  }
  void write_vertices(const CutPatch& cut) const {
    const BezierPatch& patch = set_.patches[cut.patch];
    PatchPoints points(patch, set_.origin);
    std::size_t vertex = plan_.first_vertex(cut.patch);
    for (const ParameterPoint& at : cut.vertices) {
      const Vec3 p = points.at(at);
      if (!out_.position.empty()) put_vector(out_.position, vertex, p);
      if (!out_.model_position.empty()) put_vector(out_.model_position, vertex, set_.origin + p);
      if (!out_.normal.empty()) put_vector(out_.normal, vertex, points.normal(at));
      if (!out_.parameter.empty())
        maps_.of(cut.patch).put(out_.parameter, vertex, static_cast<float>(at.u), static_cast<float>(at.v));
      ++vertex;
    }
  }

  /// Takes the vertices of the whole patch along a side.
  void take_border(const CutPatch& cut, Side side) const {
    const CutPatch::SameBorder same = cut.same[static_cast<std::size_t>(side)];
    if (same.border == no_id) return;
    const RingVertices ring(plan_, same.border);
    const bool opposite = same.reversed != is_backward(same.border);
    const auto for_vertices = [&](const auto& visit) {
      for (const CutPatch::BorderVertex& on : cut.on_borders)
        if (on.side == side)
          visit(plan_.first_vertex(cut.patch) + on.vertex, ring(opposite ? ring.rate() - on.at : on.at));
    };
    bool is_smooth = !out_.normal.empty() && apart_ > 0;
    for_vertices([&](std::size_t to, std::size_t from) {
      copy_positions(out_, from, to);
      is_smooth = is_smooth && length(normal(to) - normal(from)) <= apart_;
    });
    if (is_smooth) for_vertices([&](std::size_t to, std::size_t from) { copy(out_.normal, from, to); });
  }
  Vec3 normal(std::size_t vertex) const {
    return {double(out_.normal.at(vertex, 0)), double(out_.normal.at(vertex, 1)), double(out_.normal.at(vertex, 2))};
  }

  const PatchSet::Impl& set_;
  const CertifiedPlan& plan_;
  const ParameterMaps& maps_;
  const MeshViews& out_;
  double apart_ = 0;  ///< how far the tips of joined normals may lie apart
};

}  // namespace

Status write_cut(const PatchSet::Impl& set, const CertifiedPlan& plan, std::optional<double> crease_angle,
                 const ParameterMaps& maps, const MeshViews& out, const Execution& execution) {
  const CutWriter writer(set, plan, crease_angle, maps, out);
  const auto write = [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = begin; c < end; ++c) writer.write(plan.cuts()[c]);
  };
  return parallel_for(plan.cuts().size(), cut_patches_per_task, {.cancel = execution.cancel}, write);
}

}}  // namespace tessera::abi_0_1
