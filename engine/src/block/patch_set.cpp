#include "tessera/patch_set.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <tuple>

#include "base/guard.h"
#include "block/pack.h"
#include "block/patch_set_impl.h"

namespace tessera {
namespace {

/// Patches of equal key share blocks.
auto block_key(const BezierPatch& patch) { return std::tuple(patch.degree_u(), patch.degree_v(), patch.is_rational()); }

/// Assigns patches to groups, blocks and lanes, in the patches' order within a group.
void lay_out(PatchSet::Impl& set) {
  std::vector<std::uint32_t> order(set.patches.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto before = [&](auto a, auto b) { return block_key(set.patches[a]) < block_key(set.patches[b]); };
  if (!std::is_sorted(order.begin(), order.end(), before)) std::stable_sort(order.begin(), order.end(), before);
  constexpr std::size_t lanes = PatchSet::lanes;
  set.slots.resize(order.size());
  set.lane_patches.reserve(order.size() + lanes);
  std::size_t next_value = 0;
  for (std::size_t begin = 0; begin < order.size();) {
    const BezierPatch& first = set.patches[order[begin]];
    std::size_t end = begin;
    while (end < order.size() && block_key(set.patches[order[end]]) == block_key(first)) ++end;
    BlockGroup group{first.degree_u(), first.degree_v(), first.is_rational(), set.lane_counts.size(),
                     (end - begin + lanes - 1) / lanes, next_value,
                     block_values(first.degree_u(), first.degree_v(), first.is_rational())};
    next_value += group.block_count * group.block_values;
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
}

/// Weights below these shares of the largest: derivatives grow with the inverse of that share, and normals with its square.
constexpr double least_weight_in_float = 1e-9, least_weight_in_double = 1e-70;

/// Control points no further than this from the origin give coefficients that fit float, whatever the basis: scaled
/// weights are below 2^24, and powers of degree 15 both ways below 3^30 < 2^48 times the largest coefficient.
constexpr double always_in_range = 0x1p50;

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

bool PatchSet::Impl::pack(std::size_t patch, const BlockGroup& group, bool surely_fits, std::vector<double>& scratch) {
  const Slot slot = slots[patch];
  const std::size_t first = group.first_value + (slot.block - group.first_block) * group.block_values;
  const auto write = [&](auto& coefficients, auto& doubts) {
    auto* block = coefficients.data() + first;
    auto* doubt = doubts.data() + std::size_t{2} * lanes * slot.block;
    const auto write_to = [&](std::uint32_t lane) {
      write_lane(scratch, block, lane);
      write_doubt(patches[patch], scratch, doubt, lane);
    };
    write_to(slot.lane);
    if (slot.lane == 0)
      for (std::uint32_t lane = lane_counts[slot.block]; lane < lanes; ++lane) write_to(lane);
  };
  const auto weights = patches[patch].weights();
  const double lightest = weights.empty() ? 1 : std::ranges::min(weights) / std::ranges::max(weights);
  for (const auto representation : {Representation::bernstein, Representation::power}) {
    const bool in_float = has(Precision::single_precision, representation);
    const bool in_double = has(Precision::double_precision, representation);
    if (!in_float && !in_double) continue;
    relative_coefficients(patches[patch], origin, representation, scratch);
    const double limit = in_float ? double{std::numeric_limits<float>::max()} : std::numeric_limits<double>::max();
    if (!surely_fits && !std::ranges::all_of(scratch, [&](double value) { return std::abs(value) <= limit; }))
      return false;
    if (lightest < (in_float ? least_weight_in_float : least_weight_in_double)) return false;
    const bool bernstein = representation == Representation::bernstein;
    if (in_float) bernstein ? write(single.bernstein, single.bernstein_doubt) : write(single.power, single.power_doubt);
    if (in_double) bernstein ? write(twice.bernstein, twice.bernstein_doubt) : write(twice.power, twice.power_doubt);
  }
  return true;
}

bool PatchSet::Impl::pack(std::size_t patch, std::vector<double>& scratch) {
  return pack(patch, group_of_block(slots[patch].block), false, scratch);
}

Status PatchSet::Impl::pack_all(bool surely_fits) {
  std::vector<double> scratch;
  for (const BlockGroup& group : groups)
    for (std::size_t block = group.first_block; block < group.first_block + group.block_count; ++block)
      for (std::size_t lane = 0; lane < lane_counts[block]; ++lane) {
        const std::size_t patch = lane_patches[block * lanes + lane];
        if (!pack(patch, group, surely_fits, scratch)) return too_large(patch);
      }
  return {};
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
  Box3 box;
  set->collapsed.reserve(set->patches.size());
  for (const BezierPatch& patch : set->patches) {  // one pass: the points may not fit the caches
    box.extend(patch.hull_box());
    set->collapsed.push_back(patch.collapsed_edges());
  }
  set->origin = options.origin.value_or(box.centre());
  lay_out(*set);
  const double reach = std::max(max_abs(box.lower - set->origin), max_abs(box.upper - set->origin));
  if (Status status = set->pack_all(reach < always_in_range); !status.ok()) return status;
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
    return bytes(of.bernstein) + bytes(of.power) + bytes(of.bernstein_doubt) + bytes(of.power_doubt);
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
    std::vector<double> scratch;
    scratch.reserve((max_degree + 1) * (max_degree + 1) * 4);  // what follows must not fail half-way
    std::swap(impl_->patches[index], *edited);
    if (!impl_->pack(index, scratch)) {
      std::swap(impl_->patches[index], *edited);
      (void)impl_->pack(index, scratch);  // it fitted before
      return too_large(index);
    }
    impl_->collapsed[index] = impl_->patches[index].collapsed_edges();
    ++impl_->revision;
    return {};
  });
}

}  // namespace tessera
