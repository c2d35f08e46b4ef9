#include "tess/plan/certified_plan.h"

#include <algorithm>
#include <new>
#include <numeric>

#include "base/saturated.h"
#include "parallel/parallel_for.h"

namespace tessera { inline namespace abi_0_1 {

void CertifiedPlan::lay_out() {
  constexpr std::size_t patches_in_piece = 4096;
  const std::size_t patches = patches_.divisions.size();
  for (auto* first : {&first_vertex_, &first_triangle_, &first_quad_}) first->assign(patches + 1, 0);
  // The counts of a patch, where the next one begins.
  const bool shares = shares_vertices();
  const auto count = [&](std::size_t begin, std::size_t end) {
    for (std::size_t patch = begin; patch < end; ++patch) {
      const Division& division = patches_.divisions[patch];
      if (!division.empty)
        first_vertex_[patch + 1] = division.inner_count() + (shares ? owned_ring_count(patch) : division.ring_count());
      first_triangle_[patch + 1] = division.triangle_count();
      first_quad_[patch + 1] = division.cell_count();
    }
  };
  if (!parallel_for(patches, patches_in_piece, {}, count).ok()) throw std::bad_alloc();  // the only error
  const auto add = [](std::size_t& sum, std::size_t more) { sum = saturated_sum(sum, more); };
  for (const CutPatch& cut : cuts()) {
    add(first_vertex_[cut.patch + 1], cut.vertices.size());
    add(first_triangle_[cut.patch + 1], cut.triangles.size());
    add(first_quad_[cut.patch + 1], cut.quad_count());
  }
  for (const PatchEdit& edit : closed() ? std::span<const PatchEdit>(closed()->edits) : std::span<const PatchEdit>()) {
    add(first_vertex_[edit.patch + 1], edit.vertices.size());
    add(first_triangle_[edit.patch + 1], edit.added.size());
  }
  for (auto* first : {&first_vertex_, &first_triangle_, &first_quad_})
    std::partial_sum(first->begin(), first->end(), first->begin(), saturated_sum);
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
