#include "tess/plan/joins.h"

#include <cmath>

#include "base/union_find.h"
#include "tess/edges/numbered_borders.h"
#include "tess/plan/ring_vertices.h"

namespace tessera { inline namespace abi_0_1 {
namespace {
/// The largest distance between two float normals of one direction.
constexpr double normal_rounding = 1e-5;

class Joiner {
 public:
  Joiner(const PatchSet::Impl& set, const CertifiedPlan& plan, const SharedEdges& edges, const VertexCopies& weld,
         const View3<float>* normals, double angle, const ParameterMaps* maps)
      : set_(set),
        plan_(plan),
        edges_(edges),
        normals_(normals),
        maps_(maps),
        apart_(2 * std::sin(angle / 2) + normal_rounding),
        welded_(4 * plan.patch_count(), no_id),
        is_moved_(4 * plan.patch_count(), 0),
        corners_(4 * plan.patch_count()) {
    for (std::uint32_t k = 0; k < weld.borders.size(); ++k) welded_[weld.borders[k].to] = k;
    for (const VertexCopies::Corner& copy : weld.corners) is_moved_[copy.to] = 1;
    join_borders(weld);
    join_poles();
    list_corners();
  }
  VertexCopies take() { return std::move(joins_); }

 private:
  template <class Visit>
  void for_borders(Visit visit) const {
    for (std::uint32_t border = 0; border < welded_.size(); ++border)
      if (!plan_.division(border / 4).empty) visit(border, edges_.edge(border / 4, all_sides[border % 4]));
  }

  void join_borders(const VertexCopies& weld) {
    std::vector<std::uint32_t> leading(edges_.count(), no_id);           // the first border of each edge
    std::vector<std::uint32_t> next(maps_ ? welded_.size() : 0, no_id);  // the next one with other parameters
    for_borders([&](std::uint32_t border, std::uint32_t edge) {
      if (edge == no_id || welded_[border] != no_id) return;
      std::uint32_t* lead = &leading[edge];
      while (*lead != no_id && maps_ && !has_same_parameters(border, *lead, runs_against(set_, border, *lead)))
        lead = &next[*lead];
      if (*lead == no_id) *lead = border;
    });
    for_borders([&](std::uint32_t border, std::uint32_t edge) {
      if (edge == no_id) return;
      const std::uint32_t weld_at = welded_[border];
      std::uint32_t lead = weld_at == no_id ? leading[edge] : weld.borders[weld_at].from;
      const auto is_reversed = [&] {
        return weld_at == no_id ? runs_against(set_, border, lead) : weld.borders[weld_at].reversed;
      };
      while (maps_ && lead != border && !has_same_parameters(border, lead, is_reversed())) {
        if (weld_at != no_id || next[lead] == no_id) return;
        lead = next[lead];
      }
      if (lead == border || !is_smooth(border, lead, is_reversed())) return;
      const bool reversed = is_reversed();
      joins_.borders.push_back({border, lead, reversed});
      const auto ends = ends_of(border), met = ends_of(lead);
      corners_.unite(ends[0], met[reversed ? 1 : 0]);
      corners_.unite(ends[1], met[reversed ? 0 : 1]);
    });
  }

  void join_poles() {
    for_borders([&](std::uint32_t border, std::uint32_t) {
      if (!plan_.division(border / 4).collapsed.has(all_sides[border % 4])) return;
      const auto ends = ends_of(border);
      if (!has_same_parameters(ends[0], ends[1])) return;
      const RingVertices ring(plan_, border);
      for (int k = 1; k <= ring.rate(); ++k)
        if (!agree(ring(k), ring(0))) return;
      corners_.unite(ends[0], ends[1]);
      joins_.poles.push_back({border, border});
    });
  }

  /// Lists corners that are one. The vertex is that of the first one whose point welding does not move, else the first.
  void list_corners() {
    std::vector<std::uint32_t> owners(is_moved_.size(), no_id);  // `[member that stands for a set]`
    for (const bool moved : {false, true})
      for_borders([&](std::uint32_t corner, std::uint32_t) {
        std::uint32_t& owner = owners[corners_.find(corner).member];
        if (owner == no_id && (is_moved_[corner] != 0) == moved) owner = corner;
      });
    const auto owner_of = [&](std::uint32_t corner) { return owners[corners_.find(corner).member]; };
    for_borders([&](std::uint32_t corner, std::uint32_t) {
      if (owner_of(corner) != corner) joins_.corners.push_back({corner, owner_of(corner)});
    });
    for (VertexCopies::Corner& pole : joins_.poles) pole.from = owner_of(pole.to);
  }

  bool has_same_parameters(std::uint32_t border, std::uint32_t lead, bool reversed) const {
    const auto ends = ends_of(border), met = ends_of(lead);
    return has_same_parameters(ends[0], met[reversed ? 1 : 0]) && has_same_parameters(ends[1], met[reversed ? 0 : 1]);
  }
  bool has_same_parameters(std::uint32_t corner, std::uint32_t other) const {
    const auto at = [](std::uint32_t k) {
      constexpr ParameterPoint corners[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
      return corners[k % 4];
    };
    return !maps_ || maps_->agree(corner / 4, at(corner), other / 4, at(other));
  }
  bool is_smooth(std::uint32_t border, std::uint32_t lead, bool reversed) const {
    if (!normals_) return true;
    const RingVertices to(plan_, border), from(plan_, lead);
    const bool opposite = (is_backward(border) != is_backward(lead)) != reversed;
    for (int k = 0; k <= to.rate(); ++k)
      if (!agree(to(k), from(opposite ? to.rate() - k : k))) return false;
    return true;
  }
  /// Whether two vertices may share a normal. A normal of zero agrees with none.
  bool agree(std::size_t a, std::size_t b) const {
    if (!normals_) return true;
    const auto at = [&](std::size_t k) {
      return Vec3{double(normals_->at(k, 0)), double(normals_->at(k, 1)), double(normals_->at(k, 2))};
    };
    const Vec3 x = at(a), y = at(b), zero{};
    return !(x == zero) && !(y == zero) && length(x - y) <= apart_;
  }

  const PatchSet::Impl& set_;
  const CertifiedPlan& plan_;
  const SharedEdges& edges_;
  const View3<float>* normals_;
  const ParameterMaps* maps_;           ///< null if vertices may have different parameters
  double apart_;                        ///< how far the tips of two normals may lie apart
  std::vector<std::uint32_t> welded_;   ///< `[border]`: its place in the weld's list, or none
  std::vector<std::uint8_t> is_moved_;  ///< `[corner]`: whether it takes the point of another by welding
  UnionFind corners_;
  VertexCopies joins_;
};

}  // namespace

VertexCopies find_joins(const PatchSet::Impl& set, const CertifiedPlan& plan, const SharedEdges& edges,
                        const VertexCopies& weld, const View3<float>* normals, double angle,
                        const ParameterMaps* maps) {
  return Joiner(set, plan, edges, weld, normals, angle, maps).take();
}

}}  // namespace tessera::abi_0_1
