// Lays out the vertices and triangles of a certified plan.

#include <algorithm>
#include <cstdint>
#include <vector>

#include "tess/plan/certified_plan.h"

namespace tessera { inline namespace abi_0_1 {

void CertifiedPlan::set_f64_patches(std::span<const std::uint8_t> patches) {
  if (patches.empty()) return;
  if (!rare_) rare_ = std::make_unique<Rare>();
  rare_->f64_patches.assign(patches.begin(), patches.end());
}

void CertifiedPlan::set_beyond(std::span<const std::uint8_t> flags) {
  if (!rare_) rare_ = std::make_unique<Rare>();
  rare_->beyond.clear();
  for (std::uint32_t patch = 0; patch < flags.size(); ++patch)
    if (flags[patch]) rare_->beyond.push_back(patch);
}

void CertifiedPlan::lay_out() {
  const std::size_t patches = divisions_.size();
  for (auto* first : {&first_vertex_, &first_triangle_, &first_quad_}) first->resize(patches + 1);
  std::size_t vertices = 0, triangles = 0, quads = 0;
  const std::span<const CutPatch> cuts = this->cuts();
  auto cut = cuts.begin();
  std::size_t next_cut = cuts.empty() ? patches : cut->patch;
  const bool shares = shares_vertices();
  const std::span<const PatchEdit> edits =
      closed() ? std::span<const PatchEdit>(closed()->edits) : std::span<const PatchEdit>();
  auto edit = edits.begin();
  for (std::size_t patch = 0; patch < patches; ++patch) {
    const Division& division = divisions_[patch];
    first_vertex_[patch] = vertices;
    first_triangle_[patch] = triangles;
    first_quad_[patch] = quads;
    if (!division.empty)
      vertices += division.inner_count() + (shares ? owned_ring_count(patch) : division.ring_count());
    triangles += division.triangle_count();
    quads += division.cell_count();
    if (edit != edits.end() && edit->patch == patch) {
      vertices += edit->vertices.size();
      triangles += edit->added.size();
      ++edit;
    }
    if (patch != next_cut) continue;
    vertices += cut->vertices.size();
    triangles += cut->triangles.size();
    quads += cut->quad_count();
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
  if (!std::ranges::equal(divisions_, other.divisions_) || !std::ranges::equal(cuts(), other.cuts(), is_same_cut))
    return false;
  if (!closed() || !other.closed()) return closed() == other.closed();
  return std::ranges::equal(closed()->edits, other.closed()->edits, is_same_edit);
}

void CertifiedPlan::count_open_edges_beside_loops(const SharedEdges& edges) {
  std::vector<std::uint32_t> borders(edges.count(), 0);
  const auto visit_border = [&](std::size_t patch, Side side, const auto& visit) {
    if (const std::uint32_t edge = edges.edge(patch, side); edge != no_id)
      visit(edge, divisions_[patch].border[static_cast<std::size_t>(side)].rate());
  };
  const auto for_borders = [&](const auto& visit) {
    for (std::size_t patch = 0; patch < divisions_.size(); ++patch)
      for (const Side side : all_sides)
        if (!divisions_[patch].empty) visit_border(patch, side, visit);
    for (const CutPatch& cut : cuts())
      for (const Side side : all_sides)
        if (!cut.is_crossed && cut.is_full[static_cast<std::size_t>(side)]) visit_border(cut.patch, side, visit);
  };
  for_borders([&](std::uint32_t edge, int) { ++borders[edge]; });
  open_edges_ = 0;
  for_borders([&](std::uint32_t edge, int rate) {
    if (borders[edge] == 1) open_edges_ += static_cast<std::uint32_t>(rate);
  });
  for (const CutPatch& cut : cuts()) open_edges_ += cut.open_edges;
}

void CertifiedPlan::share(const VertexCopies& copies) {
  const auto borders = static_cast<std::uint32_t>(4 * divisions_.size());
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
    if (owns_border(border)) count += static_cast<std::size_t>(divisions_[patch].border[side].rate() - 1);
  }
  return count;
}

std::size_t CertifiedPlan::ring_vertex(std::uint32_t border, int k) const {
  const std::uint32_t patch = border / 4, side = border % 4;
  const int rate = divisions_[patch].border[side].rate();
  if (k == rate) return ring_vertex(4 * patch + (side + 1) % 4, 0);
  const auto start = [this](std::uint32_t of) {
    return first_vertex_[of / 4] + divisions_[of / 4].inner_count() + owned_ring_count(of / 4, of % 4);
  };
  const RingSource source = shares_vertices() ? ring_sources_[border] : RingSource{border, border};
  if (k == 0) return start(source.corner);
  if (source.is_point) return start(source.from);
  const bool opposite = (is_backward(border) != is_backward(source.from)) != source.reversed;
  const std::size_t before = owns_corner(source.from) ? 1 : 0;
  return start(source.from) + before + static_cast<std::size_t>((opposite ? rate - k : k) - 1);
}

}}  // namespace tessera::abi_0_1
