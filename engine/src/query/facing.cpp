#include "query/facing.h"

#include <algorithm>
#include <cmath>

namespace tessera { inline namespace abi_0_1 {

Status HitParity::count(const Ray& ray, bool& is_odd, bool& is_sure) const {
  HitLists lists;
  if (Status status = scene_->all({&ray, 1}, lists, {}); !status.ok()) return status;
  if (!counted_.empty()) std::erase_if(lists.hits, [&](const Hit& hit) { return counted_[hit.patch] == 0; });
  is_odd = lists.hits.size() % 2 != 0;
  is_sure = std::ranges::all_of(lists.hits, [](const Hit& hit) { return is_clear(hit.flags); });
  return {};
}

Facing HitParity::facing_at(std::uint32_t patch, double u, double v) const {
  const Result<Hit> at = scene_->resolve(patch, u, v);
  if (!at || at->flags.degenerate_normal) return unsure;
  Ray along{.origin = at->position, .direction = at->normal};
  along.spawn_offset = 2 * scene_->spawn_offset();
  bool is_odd_along = false, is_odd_against = false, is_sure = false, is_sure_against = false;
  if (!count(along, is_odd_along, is_sure).ok()) return unsure;
  along.direction = -along.direction;
  if (!count(along, is_odd_against, is_sure_against).ok()) return unsure;
  if (!is_sure || !is_sure_against || is_odd_along == is_odd_against) return unsure;
  return is_odd_along ? inwards : outwards;
}

Facing HitParity::facing_of(std::span<const std::uint32_t> patches, std::span<const std::int8_t> signs) const {
  constexpr std::array<ParameterPoint, 5> places{
      {{0.47, 0.53}, {0.21, 0.29}, {0.77, 0.23}, {0.31, 0.83}, {0.87, 0.67}}};
  constexpr std::size_t max_tries = 24;
  const LeafTrims* const trims = scene_->exact_source()->tracer().trims;
  int votes = 0, count = 0;
  for (std::size_t k = 0; k < max_tries && count < 3; ++k) {
    const std::size_t round = k / places.size();
    const std::uint32_t patch = patches[(k * patches.size() / max_tries + round) % patches.size()];
    ParameterPoint at = places[k % places.size()];
    const double shift = 0.01 * static_cast<double>(k);
    at = {std::fmod(at.u + shift, 1.0), std::fmod(at.v + 0.7 * shift, 1.0)};
    if (trims != nullptr && !trims->keeps_point(patch, at.u, at.v)) continue;
    const Facing facing = facing_at(patch, at.u, at.v);
    votes += signs.empty() ? facing : facing * signs[patch];
    count += facing != unsure;
  }
  return count > 0 && std::abs(votes) == count ? static_cast<Facing>(votes / count) : unsure;
}

}}  // namespace tessera::abi_0_1
