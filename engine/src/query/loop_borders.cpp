#include "query/loop_borders.h"

#include <algorithm>
#include <map>
#include <span>

#include "base/impl_access.h"
#include "block/patch_edges.h"
#include "block/patch_trims.h"
#include "measure/kept_strips.h"
#include "ray/line/first_order.h"
#include "ray/tube/edge_curves.h"
#include "trim/trim_region_impl.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Returns the patch, or no_id, on whose side a piece has the kept part; at a side of the domain, the patch there.
/// `places`: the patches of the region's grid.
std::uint32_t patch_beside(const TrimRegion::Impl& region, const TrimPiece& piece, int direction,
                           std::span<const std::uint32_t> places) {
  const ParameterPoint &from = piece.start(), &to = piece.end();
  const auto cell = [](const CutAxis& axis, double a, double b, bool is_kept_below) {
    const bool is_on_line = a == b && axis.is_line(a);
    const std::size_t above = interval_of(axis.lines, 0.5 * a + 0.5 * b);
    return is_on_line && is_kept_below && a > axis.from() && a < axis.to() ? above - 1 : above;
  };
  const std::size_t a = cell(region.lines.u, from.u, to.u, (to.v > from.v) == (direction > 0));
  const std::size_t b = cell(region.lines.v, from.v, to.v, (to.u > from.u) != (direction > 0));
  const std::size_t count_v = region.count_v();
  return places[a * count_v + b];
}

/// The length of three chords, which is not zero for a closed curve.
double rough_length(const SetView& set, const SetBorder& border) {
  Vec3 last = position_on(set, border, 0);
  double sum = 0;
  for (const double t : {0.3, 0.65, 1.0}) {
    const Vec3 next = position_on(set, border, t);
    sum += length(next - last);
    last = next;
  }
  return sum;
}

/// Collects the borders of one face after another.
class BorderList {
 public:
  explicit BorderList(const SetView& set) : set_(set) { found_.face_of.assign(set.patch_count(), no_id); }

  /// `face`: null if the region's face names no edges.
  void add(const TrimRegion::Impl& region, std::span<const std::uint32_t> places, const PatchEdges::Face* face) {
    const auto first = std::ranges::find_if(places, [](std::uint32_t patch) { return patch != no_id; });
    if (first == places.end()) return;
    for (const std::uint32_t patch : places)
      if (patch != no_id) found_.face_of[patch] = *first;
    if (face) add_uses(*face, *first);
    if (region.starts_inside) add_sides(region, places);
    const std::vector<std::int8_t> directions = piece_directions(region);
    for (std::size_t k = 0; k < directions.size(); ++k) {
      const TrimPiece& piece = region.pieces[k];
      // Lines that close the gaps of loops belong to the edges there.
      if (face && piece.curve_index == no_id && !region.starts_inside) continue;
      SetBorder border{.piece = &piece, .direction = directions[k]};
      if (directions[k] != 0) border.patch = patch_beside(region, piece, directions[k], places);
      if (border.patch == no_id) continue;
      if (face) note_use(*face, border);
      found_.borders.push_back(border);
    }
  }

  LoopBorders take() { return std::move(found_); }

 private:
  /// Where points that no piece encloses are kept, the border is that of the domain and, as a sum of directed curves,
  /// all pieces: those along its sides have the kept part outside.
  void add_sides(const TrimRegion::Impl& region, std::span<const std::uint32_t> places) {
    const std::size_t count_v = region.count_v(), count_u = places.size() / count_v;
    for (std::size_t a = 0; a < count_u; ++a)
      for (std::size_t b = 0; b < count_v; ++b) {
        const std::uint32_t patch = places[a * count_v + b];
        const auto add = [&](bool is_outer, Side side) {
          if (is_outer && patch != no_id && !set_.collapsed_sides(patch).has(side))
            found_.borders.push_back({.patch = patch, .side = side, .direction = direction_of(side)});
        };
        add(a == 0, Side::u0), add(a + 1 == count_u, Side::u1);
        add(b == 0, Side::v0), add(b + 1 == count_v, Side::v1);
      }
  }

  void add_uses(const PatchEdges::Face& face, std::uint32_t patch) {
    first_uses_.clear();
    for (const TrimLoop& loop : *face.loops) {
      first_uses_.push_back(static_cast<std::uint32_t>(found_.uses.size()));
      for (const Coedge& coedge : loop.coedges)
        found_.uses.push_back({coedge.edge == no_id ? no_id : face.first_edge + coedge.edge, patch, 0});
    }
  }

  void note_use(const PatchEdges::Face& face, SetBorder& border) {
    const TrimPiece& piece = *border.piece;
    if (piece.loop == no_id || piece.curve_index == no_id) return;
    const TrimLoop& loop = (*face.loops)[piece.loop];
    if (loop.coedges.empty() || loop.coedges[piece.curve_index].edge == no_id) return;
    border.use = first_uses_[piece.loop] + piece.curve_index;
    const int along = (loop.coedges[piece.curve_index].reversed ? -1 : 1) * border.direction;
    found_.uses[border.use].along += along * rough_length(set_, border);
  }

  const SetView& set_;
  LoopBorders found_;
  std::vector<std::uint32_t> first_uses_;  ///< `[loop]`, of a face
};

}  // namespace

Vec3 position_on(const SetView& set, const SetBorder& border, double t) {
  if (border.piece) return loop_point(set, SceneFrame{}, *border.piece, border.patch, t).position;
  const bool along_u = border.side == Side::v0 || border.side == Side::v1;
  const double other = border.side == Side::u1 || border.side == Side::v1 ? 1 : 0;
  return first_order(set.patch(border.patch), along_u ? t : other, along_u ? other : t).position;
}

LoopBorders find_loop_borders(const SetView& set) {
  BorderList list(set);
  const PatchSet::Impl& impl = set.impl();
  std::map<std::uint32_t, std::uint32_t> regions;  // of surfaces
  if (impl.trims)
    for (const PatchTrims::Cut& cut : impl.trims->cuts) regions[set.source(cut.patch).surface] = cut.region;
  if (impl.edges) {
    for (const PatchEdges::Face& face : impl.edges->faces) {
      list.add(impl_of(face.region), face.patches, &face);
      for (const std::uint32_t patch : face.patches)
        if (patch != no_id) regions.erase(set.source(patch).surface);
    }
  }
  std::map<std::uint32_t, std::vector<std::uint32_t>> places;
  for (std::uint32_t patch = 0; patch < set.patch_count() && !regions.empty(); ++patch) {
    const PatchSource& source = set.source(patch);
    const auto found = regions.find(source.surface);
    if (found == regions.end()) continue;
    const TrimRegion::Impl& region = impl_of(impl.trims->regions[found->second]);
    std::vector<std::uint32_t>& of = places[source.surface];
    of.resize(region.patches.size(), no_id);
    const Domain& domain = source.domain;
    const std::size_t a = interval_of(region.lines.u.lines, 0.5 * domain.u0 + 0.5 * domain.u1);
    of[a * region.count_v() + interval_of(region.lines.v.lines, 0.5 * domain.v0 + 0.5 * domain.v1)] = patch;
  }
  for (const auto& [surface, of] : places) list.add(impl_of(impl.trims->regions[regions[surface]]), of, nullptr);
  return list.take();
}

}}  // namespace tessera::abi_0_1
