#include "tess/plan/certified_plan.h"

#include <algorithm>

#include "base/saturated.h"

namespace tessera { inline namespace abi_0_1 {

namespace {

/// Sums of the vertices, triangles and quads of patches.
struct Sums {
  std::size_t vertices = 0, triangles = 0, quads = 0;

  void add(std::size_t more_vertices, std::size_t more_triangles, std::size_t more_quads) {
    vertices = saturated_sum(vertices, more_vertices);
    triangles = saturated_sum(triangles, more_triangles);
    quads = saturated_sum(quads, more_quads);
  }
};

/// The counts that loops cut out of patches and that edges add to them, patch by patch.
class ExtraCounts {
 public:
  ExtraCounts(std::span<const CutPatch> cuts, const ClosedEdges* closed) : cuts_(cuts) {
    if (closed) edits_ = closed->edits;
  }
  /// The first patch that add() has something for, or none.
  std::size_t next() const {
    constexpr auto none = static_cast<std::size_t>(-1);
    return std::min<std::size_t>(cuts_.empty() ? none : cuts_.front().patch,
                                 edits_.empty() ? none : edits_.front().patch);
  }
  /// Adds what the next patch has. Returns the one after it.
  [[gnu::noinline]] std::size_t add(Sums& sums) {
    const std::size_t patch = next();
    if (!edits_.empty() && edits_.front().patch == patch) {
      sums.add(edits_.front().vertices.size(), edits_.front().added.size(), 0);
      edits_ = edits_.subspan(1);
    }
    if (!cuts_.empty() && cuts_.front().patch == patch) {
      sums.add(cuts_.front().vertices.size(), cuts_.front().triangles.size(), cuts_.front().quad_count());
      cuts_ = cuts_.subspan(1);
    }
    return next();
  }

 private:
  std::span<const CutPatch> cuts_;
  std::span<const PatchEdit> edits_;
};

}  // namespace

void CertifiedPlan::lay_out() {
  const std::size_t patches = patches_.divisions.size();
  for (auto* first : {&first_vertex_, &first_triangle_, &first_quad_}) first->resize(patches + 1);
  std::size_t *const first_vertex = first_vertex_.data(), *const first_triangle = first_triangle_.data(),
                     *const first_quad = first_quad_.data();
  const Division* const divisions = patches_.divisions.data();
  const bool shares = shares_vertices();
  ExtraCounts extra(cuts(), closed());
  std::size_t next_extra = extra.next();
  Sums sums;
  // Most patches have inner points and vertices of their own; the loop has no calls for these.
  const auto add_special = [&](std::size_t patch) __attribute__((noinline)) {
    const Division& division = divisions[patch];
    if (division.empty) return;
    sums.add(division.inner_count() + (shares ? owned_ring_count(patch) : division.ring_count()),
             division.triangle_count(), division.cell_count());
  };
  for (std::size_t patch = 0; patch < patches; ++patch) {
    const Division& division = divisions[patch];
    first_vertex[patch] = sums.vertices;
    first_triangle[patch] = sums.triangles;
    first_quad[patch] = sums.quads;
    if (shares || division.empty || division.collapsed.any() || !division.has_inner_points()) {
      add_special(patch);
    } else {
      const std::size_t inner = division.inner_count(), ring = division.ring_count();
      sums.add(inner + ring, ring + 2 * (inner - 1), division.cell_count());
    }
    if (patch == next_extra) next_extra = extra.add(sums);
  }
  first_vertex[patches] = sums.vertices;
  first_triangle[patches] = sums.triangles;
  first_quad[patches] = sums.quads;
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
