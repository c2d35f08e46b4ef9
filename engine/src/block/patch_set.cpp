#include "tessera/patch_set.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <numeric>
#include <string>

#include "base/text.h"
#include "block/pack.h"
#include "block/patch_set_impl.h"
#include "block/patch_trims.h"
#include "kernel/table/kernel_table.h"
#include "parallel/least_index.h"
#include "parallel/parallel_for.h"
#include "surface/net/patch_pieces.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Patches of equal key share blocks; blocks lie in the order of the keys.
int block_key(const BezierPatch& patch) {
  return (patch.degree_u() * (max_degree + 1) + patch.degree_v()) * 2 + (patch.is_rational() ? 1 : 0);
}

/// Returns the box of all control points, found by several threads.
Result<Box3> box_of(std::span<const BezierPatch> patches) {
  constexpr std::size_t patches_in_piece = 2048;
  Box3 box;
  std::mutex mutex;
  const Status status = parallel_for(patches.size(), patches_in_piece, {}, [&](std::size_t begin, std::size_t end) {
    Box3 part;
    for (std::size_t k = begin; k < end; ++k) part.extend(patches[k].hull_box());
    const std::lock_guard lock(mutex);
    box.extend(part);
  });
  if (!status.ok()) return status;
  return box;
}

/// Values in memory that the groups so far take.
struct NextValues {
  std::size_t block = 0, point = 0;
};

/// Adds the group of some patches of equal degrees and rationality: assigns them to blocks and lanes in their order.
void add_group(PatchSet::Impl& set, std::span<const std::uint32_t> patches, NextValues& next) {
  constexpr std::size_t lanes = PatchSet::lanes;
  const BezierPatch& first = set.patches[patches.front()];
  const BlockGroup group{first.degree_u(),
                         first.degree_v(),
                         first.is_rational(),
                         set.lane_counts.size(),
                         (patches.size() + lanes - 1) / lanes,
                         next.block,
                         block_values(first.degree_u(), first.degree_v(), first.is_rational()),
                         next.point,
                         point_values(first.degree_u(), first.degree_v(), first.is_rational())};
  next.block += group.block_count * group.block_values;
  next.point += patches.size() * group.point_values;
  const std::size_t first_lane = group.first_block * lanes;
  set.lane_patches.resize(first_lane + group.block_count * lanes);
  set.lane_counts.resize(group.first_block + group.block_count, static_cast<std::uint8_t>(lanes));
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const std::size_t lane = first_lane + k;
    set.lane_patches[lane] = patches[k];
    set.slots[patches[k]] = {static_cast<std::uint32_t>(lane / lanes), static_cast<std::uint32_t>(lane % lanes)};
  }
  if (const std::size_t used = patches.size() % lanes; used > 0) {  // unused lanes repeat the block's first patch
    set.lane_counts.back() = static_cast<std::uint8_t>(used);
    for (std::size_t lane = set.lane_patches.size() - lanes + used; lane < set.lane_patches.size(); ++lane)
      set.lane_patches[lane] = set.lane_patches[set.lane_patches.size() - lanes];
  }
  set.groups.push_back(group);
}

/// Allocates coefficients and thresholds for scattered points.
template <class T>
void make_room_for_points(const PatchSet::Impl& set, Coefficients<T>& of) {
  constexpr std::size_t lanes = PatchSet::lanes;
  const BlockGroup& last = set.groups.back();
  const std::size_t of_last = (last.block_count - 1) * lanes + set.lane_counts.back();
  of.points.resize(last.first_point_value + of_last * last.point_values + lanes);
  std::fill_n(of.points.end() - lanes, lanes, T(0));
  of.point_threshold.resize(lanes * set.lane_counts.size());
}

/// Allocates coefficients and thresholds of the kinds that the set holds.
void make_room(PatchSet::Impl& set, const NextValues& values) {
  constexpr std::size_t lanes = PatchSet::lanes;
  const auto make_blocks = [&](auto& coefficients, auto& threshold) {
    coefficients.resize(values.block);
    threshold.resize(2 * lanes * set.lane_counts.size());
  };
  if (set.kinds.float_bernstein) make_blocks(set.f32.bernstein, set.f32.bernstein_threshold);
  if (set.kinds.float_power) make_blocks(set.f32.power, set.f32.power_threshold);
  if (set.kinds.double_bernstein) make_blocks(set.f64.bernstein, set.f64.bernstein_threshold);
  if (set.kinds.double_power) make_blocks(set.f64.power, set.f64.power_threshold);
  if (set.kinds.float_points) make_room_for_points(set, set.f32);
  if (set.kinds.double_points) make_room_for_points(set, set.f64);
}

/// Assigns patches to groups, blocks and lanes, in the patches' order within a group.
void lay_out(PatchSet::Impl& set) {
  std::vector<int> keys(set.patches.size());
  std::ranges::transform(set.patches, keys.begin(), block_key);
  std::vector<std::uint32_t> order(set.patches.size());
  std::iota(order.begin(), order.end(), 0u);
  if (!std::ranges::is_sorted(keys)) {
    std::ranges::stable_sort(order, {}, [&](auto k) { return keys[k]; });
    std::ranges::sort(keys);
  }
  set.slots.resize(order.size());
  NextValues next;
  for (std::size_t begin = 0; begin < order.size();) {
    const auto end = static_cast<std::size_t>(std::ranges::upper_bound(keys, keys[begin]) - keys.begin());
    add_group(set, std::span(order).subspan(begin, end - begin), next);
    begin = end;
  }
  make_room(set, next);
}

template <class T>
void find_largest_threshold(Coefficients<T>& of) {
  for (const auto& threshold : of.point_threshold) of.largest_threshold = std::max(of.largest_threshold, threshold[0]);
}

Status too_large(std::size_t patch) {
  return Status(StatusCode::non_finite,
                "patch " + std::to_string(patch) +
                    ": a coefficient relative to the set's origin, or a weight relative to the largest, is outside the "
                    "range of its blocks' numbers",
                static_cast<std::ptrdiff_t>(patch));
}

/// Checks the box of the model that a set with a box of its own is part of.
Status check_box(const std::optional<Box3>& model, const Box3& own) {
  if (!model) return {};
  if (!is_finite(model->lower) || !is_finite(model->upper))
    return Status(StatusCode::non_finite, "the box of a patch set must be finite, not " + text(*model));
  if (model->contains(own)) return {};
  return Status(StatusCode::invalid_argument,
                "the box that a patch set is given, " + text(*model) + ", must contain its own, " + text(own));
}

Status check_sources(std::span<const BezierPatch> patches, std::span<const PatchSource> sources) {
  if (sources.size() != patches.size())
    return Status(StatusCode::count_mismatch, "found " + counted(sources.size(), "source") + " for " +
                                                  counted(patches.size(), "patch", "patches") +
                                                  ", each patch needs one");
  for (std::size_t k = 0; k < sources.size(); ++k) {
    const Domain& d = sources[k].domain;
    if (!(d.u0 < d.u1 && d.v0 < d.v1) || !std::isfinite(d.u1 - d.u0) || !std::isfinite(d.v1 - d.v0))
      return Status(StatusCode::invalid_argument,
                    "the domain of patch " + std::to_string(k) + " is not a finite rectangle",
                    static_cast<std::ptrdiff_t>(k));
  }
  return {};
}

}  // namespace

const BlockGroup& PatchSet::Impl::group_of_block(std::size_t block) const {
  if (groups.size() == 1) return groups.front();
  return *std::prev(std::upper_bound(groups.begin(), groups.end(), block,
                                     [](std::size_t b, const BlockGroup& group) { return b < group.first_block; }));
}

PatchSet::Impl::~Impl() { PatchPieces::release(patches); }

Box3 PatchSet::Impl::box() const {
  if (const Result<Box3> found = box_of(patches)) return *found;
  Box3 box;  // without memory for threads
  for (const BezierPatch& patch : patches) box.extend(patch.hull_box());
  return box;
}

Status PatchSet::Impl::pack_all(const Execution& execution) {
  constexpr std::size_t blocks_in_piece = 32;
  const kernel::KernelTable& kernels = kernel::default_kernels();
  std::atomic<std::size_t> failed{lane_patches.size()};  // the first lane that doesn't fit
  const auto pack_blocks = [&](std::size_t begin, std::size_t end) {
    for (std::size_t block = begin; block < end; ++block) {
      const std::size_t fitting = pack_block(block, kernels);
      if (fitting == lanes) continue;
      std::size_t first = failed;
      while (block * lanes + fitting < first && !failed.compare_exchange_weak(first, block * lanes + fitting)) continue;
      return;
    }
  };
  Status status = parallel_for(lane_counts.size(), blocks_in_piece, execution, pack_blocks);
  return status.ok() && failed < lane_patches.size() ? too_large(lane_patches[failed]) : status;
}

template <class T>
Result<std::shared_ptr<const Coefficients<T>>> PatchSet::Impl::points(const std::atomic<bool>* cancel) const {
  using Shared = std::shared_ptr<const Coefficients<T>>;
  constexpr bool is_f64 = sizeof(T) == sizeof(double);
  if (is_f64 ? kinds.double_points : kinds.float_points) return Shared(std::shared_ptr<void>(), &coefficients<T>());
  auto& slot = [this]() -> auto& {
    if constexpr (is_f64)
      return f64_points;
    else
      return f32_points;
  }
  ();
  std::shared_ptr<const PointsOnDemand<T>> kept = slot.load();
  if (!kept || kept->revision != revision) {
    const auto made = std::make_shared<PointsOnDemand<T>>();
    made->revision = revision;
    make_room_for_points(*this, made->coefficients);
    LeastIndex failed;
    constexpr std::size_t patches_in_piece = 256;
    const auto pack_one = [&](std::size_t k, Coefficients<float>* to_f32, Coefficients<double>* to_f64) {
      return pack_points(k, group_of_block(slots[k].block), patches[k].hull_box(), to_f32, to_f64);
    };
    const auto pack_some = [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        bool fits = false;
        if constexpr (is_f64)
          fits = pack_one(k, nullptr, &made->coefficients);
        else
          fits = pack_one(k, &made->coefficients, nullptr);
        if (!fits) failed.add(k);
      }
    };
    Status status = parallel_for(patches.size(), patches_in_piece, {.cancel = cancel}, pack_some);
    if (!status.ok()) return status;
    if (failed.found()) return too_large(failed.index());
    find_largest_threshold(made->coefficients);
    kept = made;
    slot.store(kept);
  }
  return Shared(kept, &kept->coefficients);
}
template Result<std::shared_ptr<const Coefficients<float>>> PatchSet::Impl::points(const std::atomic<bool>*) const;
template Result<std::shared_ptr<const Coefficients<double>>> PatchSet::Impl::points(const std::atomic<bool>*) const;

Result<PatchSet> PatchSet::Impl::make(std::vector<BezierPatch> patches, std::vector<PatchSource> sources,
                                      std::size_t surface_count, const std::optional<Box3>& box,
                                      const PatchSetOptions& options) {
  if (patches.empty()) return Status(StatusCode::invalid_argument, "a patch set needs at least one patch");
  if (patches.size() > std::numeric_limits<std::uint32_t>::max())
    return Status(StatusCode::invalid_argument,
                  "a patch set holds at most 2^32 - 1 patches, not " + std::to_string(patches.size()));
  if (options.origin && !is_finite(*options.origin))
    return Status(StatusCode::non_finite, "the origin of a patch set must be finite");
  auto set = std::make_unique<Impl>();
  set->patches = std::move(patches);
  set->sources = std::move(sources);
  set->kinds = options.blocks;
  set->fit_error = options.fit_error;
  set->surface_count = surface_count;
  set->given_box = options.box;
  if (options.origin && !options.box) {
    set->origin = *options.origin;
  } else {
    const Result<Box3> known = box ? *box : box_of(set->patches);
    if (!known) return known.status();
    if (Status status = check_box(options.box, *known); !status.ok()) return status;
    // A zero's sign would depend on the order of the patches.
    set->origin = options.origin ? *options.origin : (options.box ? *options.box : *known).centre() + Vec3{};
  }
  set->collapsed.resize(set->patches.size());
  set->edited.resize(set->patches.size());
  lay_out(*set);
  if (Status status = set->pack_all(options.execution); !status.ok()) return status;
  find_largest_threshold(set->f32);
  find_largest_threshold(set->f64);
  return PatchSet(std::move(set));
}

Result<PatchSet> PatchSet::make(std::span<const BezierPatch> patches, const PatchSetOptions& options) {
  return guarded([&]() -> Result<PatchSet> {
    std::vector<PatchSource> sources(options.sources.begin(), options.sources.end());
    if (sources.empty()) {
      sources.resize(patches.size());
      for (std::size_t k = 0; k < sources.size(); ++k) sources[k].surface = static_cast<std::uint32_t>(k);
    }
    if (Status status = check_sources(patches, sources); !status.ok()) return status;
    std::size_t surface_count = 0;
    for (const PatchSource& source : sources) surface_count = std::max(surface_count, std::size_t{source.surface} + 1);
    return Impl::make({patches.begin(), patches.end()}, std::move(sources), surface_count, {}, options);
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
Box3 PatchSet::model_box() const { return impl_->model_box(); }
const FitError& PatchSet::fit_error() const { return impl_->fit_error; }
const BlockKinds& PatchSet::blocks() const { return impl_->kinds; }
std::size_t PatchSet::block_count() const { return impl_->lane_counts.size(); }
PatchSet::Slot PatchSet::slot(std::size_t index) const { return impl_->slots[index]; }
std::size_t PatchSet::cut_count() const { return impl_->trims ? impl_->trims->cuts.size() : 0; }
bool PatchSet::is_cut(std::size_t index) const { return impl_->trims && impl_->trims->is_cut[index]; }
std::span<const Status> PatchSet::trim_faults() const { return impl_->trim_faults; }
std::uint64_t PatchSet::revision() const { return impl_->revision; }

std::size_t PatchSet::memory_bytes() const {
  const auto bytes = [](const auto& vector) { return vector.capacity() * sizeof(vector[0]); };
  const auto all_bytes = [&](const auto& of) {
    return bytes(of.bernstein) + bytes(of.power) + bytes(of.bernstein_threshold) + bytes(of.power_threshold) +
           bytes(of.points) + bytes(of.point_threshold);
  };
  std::size_t total = sizeof(Impl) + bytes(impl_->patches) + bytes(impl_->sources) + bytes(impl_->domains) +
                      bytes(impl_->slots) + bytes(impl_->collapsed) + bytes(impl_->groups) + bytes(impl_->edited) +
                      bytes(impl_->lane_patches) + bytes(impl_->lane_counts) + all_bytes(impl_->f32) +
                      all_bytes(impl_->f64);
  if (const auto f32 = impl_->f32_points.load()) total += all_bytes(f32->coefficients);
  if (const auto f64 = impl_->f64_points.load()) total += all_bytes(f64->coefficients);
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
      (void)impl_->pack(index);  // cannot fail: it fitted before
      return too_large(index);
    }
    const auto patch = static_cast<std::uint32_t>(index);
    impl_->note_edits({&patch, 1});
    return {};
  });
}

}}  // namespace tessera::abi_0_1
