#include "section/prepared_set.h"

#include <algorithm>
#include <bit>
#include <ranges>
#include <unordered_map>
#include <utility>

#include "base/impl_access.h"
#include "block/patch_trims.h"
#include "parallel/parallel_for.h"
#include "tess/cells/patch_side.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The control points and weights of a side, in the direction in which equal ones are the same sequence.
struct SideNet {
  std::vector<std::array<double, 4>> points;
  bool reversed = false;

  SideNet(const BezierPatch& patch, Side side) {
    const int m = patch.degree_u(), n = patch.degree_v();
    const int count = runs_along_u(side) ? m : n;
    for (int k = 0; k <= count; ++k) {
      const int i = runs_along_u(side) ? k : is_far(side) ? m : 0, j = !runs_along_u(side) ? k : is_far(side) ? n : 0;
      const Vec3& p = patch.point(i, j);
      points.push_back({p.x + 0.0, p.y + 0.0, p.z + 0.0, patch.weight(i, j)});
    }
    reversed = std::ranges::lexicographical_compare(std::views::reverse(points), points);
    if (reversed) std::ranges::reverse(points);
  }
  std::size_t hash() const {
    std::uint64_t hash = points.size();
    for (const auto& p : points)
      for (const double x : p) hash = std::rotl((hash ^ std::bit_cast<std::uint64_t>(x)) * 0x9e3779b97f4a7c15u, 29);
    return static_cast<std::size_t>(hash);
  }
  Vec3 point(std::size_t k) const { return {points[k][0], points[k][1], points[k][2]}; }
  HeightLine line(const Levels& levels) const {
    const bool is_rational = std::ranges::any_of(points, [&](const auto& p) { return p[3] != points[0][3]; });
    std::vector<double> weighted, weights;
    for (std::size_t k = 0; k < points.size(); ++k) {
      weighted.push_back((is_rational ? points[k][3] : 1) * levels.height(point(k)));
      if (is_rational) weights.push_back(points[k][3]);
    }
    return {std::move(weighted), std::move(weights)};
  }
};

}  // namespace

void PreparedSet::find_patches(const PatchSet::Impl& set, const Levels& levels) {
  struct Known {
    SideNet net;
    std::uint32_t border;
  };
  std::unordered_multimap<std::size_t, Known> known;
  for (std::uint32_t k = 0; k < set.patches.size(); ++k) {
    const BezierPatch& patch = set.patches[k];
    double low = levels.height(patch.points()[0]), high = low;
    for (const Vec3& p : patch.points()) {
      const double height = levels.height(p);
      low = std::min(low, height), high = std::max(high, height);
    }
    if (levels.within(low, high).empty()) continue;
    Sides sides{.patch = k, .borders = {}, .reversed = {}};
    for (const Side side : all_sides) {
      SideNet net(patch, side);
      const std::size_t hash = net.hash();
      const auto [first, end] = known.equal_range(hash);
      const auto found = std::find_if(first, end, [&](const auto& of) { return of.second.net.points == net.points; });
      sides.reversed[static_cast<std::size_t>(side)] = net.reversed;
      auto& border = sides.borders[static_cast<std::size_t>(side)];
      border = found != end ? found->second.border : static_cast<std::uint32_t>(borders_.size());
      if (found != end) continue;
      borders_.push_back(net.line(levels));
      border_ends_.emplace_back(levels.height(net.point(0)), levels.height(net.point(net.points.size() - 1)));
      known.emplace(hash, Known{std::move(net), border});
    }
    sides_.push_back(sides);
  }
}

Status PreparedSet::find_regions(const PatchSet::Impl& set, const Execution& execution) {
  if (!set.trims) return {};
  std::vector<std::uint8_t> is_used(set.trims->regions.size(), 0);
  std::vector<std::uint8_t> is_met(set.patches.size(), 0);
  for (const Sides& of : sides_) is_met[of.patch] = 1;
  for (const PatchTrims::Cut& cut : set.trims->cuts)
    if (is_met[cut.patch]) is_used[cut.region] = 1;
  regions_ = set.trims->regions;
  return parallel_for(regions_.size(), 1, {.cancel = execution.cancel}, [&](std::size_t first, std::size_t end) {
    for (std::size_t k = first; k < end; ++k)
      if (is_used[k]) regions_[k] = TrimRegion::Impl::for_points(regions_[k]);
  });
}

/// Makes patches first to end of `sides_`, which are of as many faces as they are.
void PreparedSet::make(const PatchSet::Impl& set, const Levels& levels, std::size_t first, std::size_t end) {
  LoopVertices vertices;
  std::uint32_t region = no_id;
  for (std::size_t k = first; k < end; ++k) {
    const Sides& sides = sides_[k];
    const BezierPatch& patch = set.patches[sides.patch];
    std::array<PatchBorder, 4> borders;
    for (std::size_t side = 0; side < 4; ++side) borders[side] = {&borders_[sides.borders[side]], sides.reversed[side]};
    patches_[k] = std::make_unique<PreparedPatch>(PreparedPatch{.patch = sides.patch,
                                                                .domain = set.sources[sides.patch].domain,
                                                                .borders = sides.borders,
                                                                .points = HeightPatch(patch, levels),
                                                                .cells = PatchCells(patch, levels, borders)});
    PreparedPatch& made = *patches_[k];
    made.low = made.cells.nodes().front().low, made.high = made.cells.nodes().front().high;
    if (!set.trims || !set.trims->is_cut[sides.patch]) continue;
    const auto cut = std::ranges::lower_bound(set.trims->cuts, sides.patch, {}, &PatchTrims::Cut::patch);
    if (cut->region != region) vertices = {};
    region = cut->region;
    made.loops.emplace(patch, made.domain, regions_[region],
                       impl_of(std::as_const(regions_[region])).pieces_of(cut->place), levels, vertices);
  }
}

void PreparedSet::list_by_level(const Levels& levels) {
  first_.assign(levels.heights.size() + 1, 0);
  const auto for_levels = [&](const PreparedPatch& patch, auto visit) {
    const std::span<const double> within = levels.within(patch.low, patch.high);
    const auto from = static_cast<std::size_t>(within.data() - levels.heights.data());
    for (std::size_t level = from; level < from + within.size(); ++level) visit(level);
  };
  for (const auto& patch : patches_) for_levels(*patch, [&](std::size_t level) { ++first_[level + 1]; });
  for (std::size_t k = 1; k < first_.size(); ++k) first_[k] += first_[k - 1];
  by_level_.resize(first_.back());
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (std::uint32_t k = 0; k < patches_.size(); ++k)
    for_levels(*patches_[k], [&](std::size_t level) { by_level_[next[level]++] = k; });
}

Status PreparedSet::prepare(const PatchSet::Impl& set, const Levels& levels, const Execution& execution) {
  set_ = &set;
  find_patches(set, levels);
  if (Status status = find_regions(set, execution); !status.ok()) return status;
  const Execution quiet{.cancel = execution.cancel};
  Status status = parallel_for(borders_.size(), 64, quiet, [&](std::size_t first, std::size_t end) {
    for (std::size_t k = first; k < end; ++k) {
      borders_[k].divide(levels);
      borders_[k].set_ends(border_ends_[k].first, border_ends_[k].second);
    }
  });
  if (!status.ok()) return status;
  patches_.resize(sides_.size());
  // The patches of one surface agree on the heights of loops' vertices, so one task makes them all.
  constexpr std::size_t per_task = 256;
  std::vector<std::size_t> starts;
  for (std::size_t k = 0; k < sides_.size(); ++k)
    if (k == 0 || set.sources[sides_[k].patch].surface != set.sources[sides_[k - 1].patch].surface ||
        (!set.trims && k - starts.back() >= per_task))
      starts.push_back(k);
  starts.push_back(sides_.size());
  status = parallel_for(starts.size() - 1, 4, quiet, [&](std::size_t first, std::size_t end) {
    for (std::size_t k = first; k < end; ++k) make(set, levels, starts[k], starts[k + 1]);
  });
  if (status.ok()) list_by_level(levels);
  return status;
}

Vec3 PreparedSet::normal(const PreparedPatch& patch, const ParameterPoint& at) const {
  const UnitNormal normal = unit_normal(set_->patches[patch.patch], at.u, at.v);
  return normal.kind == NormalKind::regular ? normal.direction : Vec3{};
}

std::vector<std::uint32_t> PreparedSet::unproven() const {
  std::vector<std::uint32_t> found;
  for (const auto& patch : patches_)
    if (!patch->cells.is_proven() || (patch->loops && !patch->loops->is_proven())) found.push_back(patch->patch);
  return found;
}

}}  // namespace tessera::abi_0_1
