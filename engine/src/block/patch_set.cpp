#include "tessera/patch_set.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "base/guard.h"
#include "block/pack.h"
#include "block/patch_set_impl.h"
#include "parallel/parallel_for.h"

namespace tessera {
namespace {

/// Patches of equal key share blocks, which lie in the keys' order.
int block_key(const BezierPatch& patch) {
  return (patch.degree_u() * (max_degree + 1) + patch.degree_v()) * 2 + (patch.is_rational() ? 1 : 0);
}

/// Assigns patches to groups, blocks and lanes, in the patches' order within a group.
void lay_out(PatchSet::Impl& set) {
  std::vector<int> keys(set.patches.size());
  std::ranges::transform(set.patches, keys.begin(), block_key);
  std::vector<std::uint32_t> order(set.patches.size());
  std::iota(order.begin(), order.end(), 0u);
  if (!std::ranges::is_sorted(keys)) std::ranges::stable_sort(order, {}, [&](auto k) { return keys[k]; });
  constexpr std::size_t lanes = PatchSet::lanes;
  set.slots.resize(order.size());
  set.lane_patches.reserve(order.size() + lanes);
  std::size_t next_value = 0, next_point_value = 0;
  for (std::size_t begin = 0; begin < order.size();) {
    const BezierPatch& first = set.patches[order[begin]];
    std::size_t end = begin;
    while (end < order.size() && keys[order[end]] == keys[order[begin]]) ++end;
    BlockGroup group{first.degree_u(), first.degree_v(), first.is_rational(), set.lane_counts.size(),
                     (end - begin + lanes - 1) / lanes, next_value,
                     block_values(first.degree_u(), first.degree_v(), first.is_rational()), next_point_value,
                     point_values(first.degree_u(), first.degree_v(), first.is_rational())};
    next_value += group.block_count * group.block_values;
    next_point_value += (end - begin) * group.point_values;
    for (std::size_t block = begin; block < end; block += lanes) {
      const std::size_t used = std::min(lanes, end - block);
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        set.lane_patches.push_back(order[block + (lane < used ? lane : 0)]);
        if (lane < used)
          set.slots[order[block + lane]] = {static_cast<std::uint32_t>(set.lane_counts.size()), static_cast<std::uint32_t>(lane)};
      }
      set.lane_counts.push_back(static_cast<std::uint8_t>(used));
    }
    set.groups.push_back(group);
    begin = end;
  }
  const std::size_t doubts = 2 * lanes * set.lane_counts.size();
  const auto make_room = [&](auto& coefficients, auto& doubt) {
    coefficients.resize(next_value);
    doubt.resize(doubts);
  };
  if (set.kinds.float_bernstein) make_room(set.single.bernstein, set.single.bernstein_doubt);
  if (set.kinds.float_power) make_room(set.single.power, set.single.power_doubt);
  if (set.kinds.double_bernstein) make_room(set.twice.bernstein, set.twice.bernstein_doubt);
  if (set.kinds.double_power) make_room(set.twice.power, set.twice.power_doubt);
  const auto make_points = [&](auto& of) {
    of.points.resize(next_point_value + lanes);
    std::fill_n(of.points.end() - lanes, lanes, 0);
    of.point_doubt.resize(lanes * set.lane_counts.size());
  };
  if (set.kinds.float_points) make_points(set.single);
  if (set.kinds.double_points) make_points(set.twice);
}

template <class T>
void find_largest_doubt(Coefficients<T>& of) {
  for (const auto& doubt : of.point_doubt) of.largest_doubt = std::max(of.largest_doubt, doubt[0]);
}

Status too_large(std::size_t patch) {
  return Status(StatusCode::non_finite,
                "patch " + std::to_string(patch) + ": a coefficient relative to the set's origin, or a weight relative to the largest, is outside the range of its blocks' numbers",
                static_cast<std::ptrdiff_t>(patch));
}

Status check_sources(std::span<const BezierPatch> patches, std::span<const PatchSource> sources) {
  if (patches.empty()) return Status(StatusCode::invalid_argument, "a patch set needs at least one patch");
  if (patches.size() > std::numeric_limits<std::uint32_t>::max())
    return Status(StatusCode::invalid_argument, "a patch set holds at most 2^32 - 1 patches, not " + std::to_string(patches.size()));
  if (sources.size() != patches.size())
    return Status(StatusCode::count_mismatch, std::to_string(patches.size()) + " patches need as many sources, not " +
                                                  std::to_string(sources.size()));
  for (std::size_t k = 0; k < sources.size(); ++k) {
    const Domain& d = sources[k].domain;
    if (!(d.u0 < d.u1 && d.v0 < d.v1) || !std::isfinite(d.u1 - d.u0) || !std::isfinite(d.v1 - d.v0))
      return Status(StatusCode::invalid_argument, "the domain of patch " + std::to_string(k) + " is not a finite rectangle",
                    static_cast<std::ptrdiff_t>(k));
  }
  return {};
}

}  // namespace

const BlockGroup& PatchSet::Impl::group_of_block(std::size_t block) const {
  return *std::prev(std::upper_bound(groups.begin(), groups.end(), block,
                                     [](std::size_t b, const BlockGroup& group) { return b < group.first_block; }));
}

Box3 PatchSet::Impl::box() const {
  Box3 box;
  for (const BezierPatch& patch : patches) box.extend(patch.hull_box());
  return box;
}

Status PatchSet::Impl::measure(std::vector<Box3>& hulls) {
  constexpr std::size_t patches_in_piece = 512;
  hulls.resize(patches.size());
  collapsed.resize(patches.size());
  return parallel_for(patches.size(), patches_in_piece, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      hulls[k] = patches[k].hull_box();
      collapsed[k] = patches[k].collapsed_edges();
    }
  });
}

Status PatchSet::Impl::pack_all(std::span<const Box3> hulls) {
  constexpr std::size_t blocks_in_piece = 32;
  std::atomic<std::size_t> refused{lane_patches.size()};  // the first lane
  const auto pack_blocks = [&](std::size_t begin, std::size_t end) {
    for (std::size_t block = begin; block < end; ++block) {
      const BlockGroup& group = group_of_block(block);
      for (std::size_t lane = block * lanes; lane < block * lanes + lane_counts[block]; ++lane) {
        if (pack(lane_patches[lane], group, hulls[lane_patches[lane]])) continue;
        std::size_t first = refused;
        while (lane < first && !refused.compare_exchange_weak(first, lane)) continue;
        return;
      }
    }
  };
  Status status = parallel_for(lane_counts.size(), blocks_in_piece, {}, pack_blocks);
  return status.ok() && refused < lane_patches.size() ? too_large(lane_patches[refused]) : status;
}

Result<PatchSet> PatchSet::Impl::make(std::vector<BezierPatch> patches, std::vector<PatchSource> sources,
                                      const PatchSetOptions& options) {
  if (Status status = check_sources(patches, sources); !status.ok()) return status;
  if (options.origin && !is_finite(*options.origin))
    return Status(StatusCode::non_finite, "the origin of a patch set must be finite");
  auto set = std::make_unique<Impl>();
  set->patches = std::move(patches);
  set->sources = std::move(sources);
  set->kinds = options.blocks;
  set->fit_error = options.fit_error;
  for (const PatchSource& source : set->sources)
    set->surface_count = std::max(set->surface_count, std::size_t{source.surface} + 1);
  std::vector<Box3> hulls;
  if (Status status = set->measure(hulls); !status.ok()) return status;
  Box3 box;
  for (const Box3& hull : hulls) box.extend(hull);
  set->origin = options.origin.value_or(box.centre());
  lay_out(*set);
  if (Status status = set->pack_all(hulls); !status.ok()) return status;
  find_largest_doubt(set->single);
  find_largest_doubt(set->twice);
  return PatchSet(std::move(set));
}

Result<PatchSet> PatchSet::from(std::span<const BezierPatch> patches, const PatchSetOptions& options) {
  return guarded([&]() -> Result<PatchSet> {
    std::vector<PatchSource> sources(patches.size());
    for (std::size_t k = 0; k < sources.size(); ++k) sources[k].surface = static_cast<std::uint32_t>(k);
    return from(patches, sources, options);
  });
}

Result<PatchSet> PatchSet::from(std::span<const BezierPatch> patches, std::span<const PatchSource> sources,
                                const PatchSetOptions& options) {
  return guarded([&]() -> Result<PatchSet> {
    return Impl::make({patches.begin(), patches.end()}, {sources.begin(), sources.end()}, options);
  });
}

PatchSet::PatchSet(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
PatchSet::PatchSet(PatchSet&&) noexcept = default;
PatchSet& PatchSet::operator=(PatchSet&&) noexcept = default;
PatchSet::~PatchSet() = default;

std::size_t PatchSet::patch_count() const { return impl_->patches.size(); }
std::size_t PatchSet::surface_count() const { return impl_->surface_count; }
const BezierPatch& PatchSet::patch(std::size_t index) const { return impl_->patches[index]; }
const PatchSource& PatchSet::source(std::size_t index) const { return impl_->sources[index]; }
Vec3 PatchSet::origin() const { return impl_->origin; }
Box3 PatchSet::box() const { return impl_->box(); }
const FitError& PatchSet::fit_error() const { return impl_->fit_error; }
const BlockKinds& PatchSet::blocks() const { return impl_->kinds; }
std::size_t PatchSet::block_count() const { return impl_->lane_counts.size(); }
PatchSet::Slot PatchSet::slot(std::size_t index) const { return impl_->slots[index]; }
std::uint64_t PatchSet::revision() const { return impl_->revision; }

std::size_t PatchSet::memory_bytes() const {
  const auto bytes = [](const auto& vector) { return vector.capacity() * sizeof(vector[0]); };
  const auto all_bytes = [&](const auto& of) {
    return bytes(of.bernstein) + bytes(of.power) + bytes(of.bernstein_doubt) + bytes(of.power_doubt) + bytes(of.points) +
           bytes(of.point_doubt);
  };
  std::size_t total = sizeof(Impl) + bytes(impl_->patches) + bytes(impl_->sources) + bytes(impl_->slots) + bytes(impl_->collapsed) +
                      bytes(impl_->groups) + bytes(impl_->lane_patches) + bytes(impl_->lane_counts) + all_bytes(impl_->single) +
                      all_bytes(impl_->twice);
  for (const BezierPatch& patch : impl_->patches) total += patch.points().size_bytes() + patch.weights().size_bytes();
  return total;
}

Status PatchSet::set_control_points(std::size_t index, std::span<const Vec3> points) {
  return guarded([&]() -> Status {
    if (index >= patch_count())
      return Status(StatusCode::invalid_argument,
                    "there is no patch " + std::to_string(index) + " in a set of " + std::to_string(patch_count()),
                    static_cast<std::ptrdiff_t>(index));
    Result<BezierPatch> edited = patch(index).with_points(points);
    if (!edited) return edited.status();
    std::swap(impl_->patches[index], *edited);
    if (!impl_->pack(index)) {
      std::swap(impl_->patches[index], *edited);
      (void)impl_->pack(index);  // it fitted before
      return too_large(index);
    }
    ++impl_->revision;
    return {};
  });
}

}  // namespace tessera
