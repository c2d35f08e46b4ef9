#include "tess/plan/certified_plan.h"

#include <algorithm>

#include "base/saturated.h"

namespace tessera { inline namespace abi_0_1 {

void CertifiedPlan::lay_out() {
  const std::size_t patches = patches_.divisions.size();
  for (auto* first : {&first_vertex_, &first_triangle_, &first_quad_}) first->resize(patches + 1);
  std::size_t vertices = 0, triangles = 0, quads = 0;
  const auto add = [](std::size_t& sum, std::size_t count) { sum = saturated_sum(sum, count); };
  const std::span<const CutPatch> cuts = this->cuts();
  auto cut = cuts.begin();
  std::size_t next_cut = cuts.empty() ? patches : cut->patch;
  const bool shares = shares_vertices();
  const std::span<const PatchEdit> edits =
      closed() ? std::span<const PatchEdit>(closed()->edits) : std::span<const PatchEdit>();
  auto edit = edits.begin();
  for (std::size_t patch = 0; patch < patches; ++patch) {
    const Division& division = patches_.divisions[patch];
    first_vertex_[patch] = vertices;
    first_triangle_[patch] = triangles;
    first_quad_[patch] = quads;
    if (!division.empty)
      add(vertices, division.inner_count() + (shares ? owned_ring_count(patch) : division.ring_count()));
    add(triangles, division.triangle_count());
    add(quads, division.cell_count());
    if (edit != edits.end() && edit->patch == patch) {
      add(vertices, edit->vertices.size());
      add(triangles, edit->added.size());
      ++edit;
    }
    if (patch != next_cut) continue;
    add(vertices, cut->vertices.size());
    add(triangles, cut->triangles.size());
    add(quads, cut->quad_count());
    next_cut = ++cut == cuts.end() ? patches : cut->patch;
  }
  first_vertex_[patches] = vertices;
  first_triangle_[patches] = triangles;
  first_quad_[patches] = quads;
}

bool CertifiedPlan::has_triangles_of(const CertifiedPlan& other) const {
  const auto is_same_cut = [](const CutPatch& a, const CutPatch& b) {
    return a.triangles == b.triangles && a.vertices.size() == b.vertices.size();
  };
  const auto is_same_edit = [](const PatchEdit& a, const PatchEdit& b) {
    return a.patch == b.patch && a.vertices.size() == b.vertices.size() && a.changed == b.changed && a.added == b.added;
  };
  if (!std::ranges::equal(patches_.divisions, other.patches_.divisions) ||
      !std::ranges::equal(cuts(), other.cuts(), is_same_cut))
    return false;
  if (!closed() || !other.closed()) return closed() == other.closed();
  return std::ranges::equal(closed()->edits, other.closed()->edits, is_same_edit);
}

void CertifiedPlan::set_bounds(std::size_t patch, float bound, float angle, float pixels) {
  patches_.bounds[patch] = bound;
  if (!patches_.angles.empty()) patches_.angles[patch] = angle;
  if (!patches_.pixels.empty()) patches_.pixels[patch] = pixels;
}

void CertifiedPlan::share(const VertexCopies& copies) {
  const auto borders = static_cast<std::uint32_t>(4 * patches_.divisions.size());
  ring_sources_.resize(borders);
  for (std::uint32_t border = 0; border < borders; ++border) ring_sources_[border] = {border, border};
  for (const VertexCopies::Corner& copy : copies.corners) ring_sources_[copy.to].corner = copy.from;
  for (const VertexCopies::Border& copy : copies.borders) {
    ring_sources_[copy.to].from = copy.from;
    ring_sources_[copy.to].reversed = copy.reversed;
  }
  for (const VertexCopies::Corner& pole : copies.poles) {
    ring_sources_[pole.to].from = pole.from;
    ring_sources_[pole.to].is_point = true;
  }
  lay_out();
}

std::size_t CertifiedPlan::owned_ring_count(std::size_t patch, std::uint32_t sides) const {
  std::size_t count = 0;
  for (std::uint32_t side = 0; side < sides; ++side) {
    const std::size_t border = 4 * patch + side;
    if (owns_corner(border)) ++count;
    if (owns_border(border)) count += static_cast<std::size_t>(patches_.divisions[patch].border[side].rate() - 1);
  }
  return count;
}

std::size_t CertifiedPlan::ring_vertex(std::uint32_t border, int k) const {
  const std::uint32_t patch = border / 4, side = border % 4;
  const int rate = patches_.divisions[patch].border[side].rate();
  if (k == rate) return ring_vertex(4 * patch + (side + 1) % 4, 0);
  const auto start = [this](std::uint32_t of) {
    return first_vertex_[of / 4] + patches_.divisions[of / 4].inner_count() + owned_ring_count(of / 4, of % 4);
  };
  const RingSource source = shares_vertices() ? ring_sources_[border] : RingSource{border, border};
  if (k == 0) return start(source.corner);
  if (source.is_point) return start(source.from);
  const bool opposite = (is_backward(border) != is_backward(source.from)) != source.reversed;
  const std::size_t before = owns_corner(source.from) ? 1 : 0;
  return start(source.from) + before + static_cast<std::size_t>((opposite ? rate - k : k) - 1);
}

}}  // namespace tessera::abi_0_1
