#include "plane/sweep_points.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t few_keys = 256;  // std::sort is faster up to here
constexpr int digit_bits = 11;
constexpr std::uint32_t digit_count = 1u << digit_bits;

}  // namespace

// Two passes of a counting sort, by the lower and the upper digit of the place along u. What is not in order then lies
// within runs of equal digits.
void SweepPoints::sort_by_digits() {
  double least = keys_[0].at.u, most = least;
  for (const Key& key : keys_) least = std::min(least, key.at.u), most = std::max(most, key.at.u);
  const double scale = (digit_count * double(digit_count) - 1) / (most - least);
  if (!(scale > 0) || std::isinf(scale)) return;
  starts_.assign(2 * digit_count, 0);
  for (Key& key : keys_) {
    key.digits = static_cast<std::uint32_t>((key.at.u - least) * scale);
    ++starts_[key.digits % digit_count];
    ++starts_[digit_count + key.digits / digit_count];
  }
  const auto middle = starts_.begin() + digit_count;
  std::exclusive_scan(starts_.begin(), middle, starts_.begin(), 0u);
  std::exclusive_scan(middle, starts_.end(), middle, 0u);
  spare_.resize(keys_.size());
  for (const Key& key : keys_) spare_[starts_[key.digits % digit_count]++] = key;
  for (const Key& key : spare_) keys_[starts_[digit_count + key.digits / digit_count]++] = key;
}

void SweepPoints::sort(std::span<const ParameterPoint> points) {
  const std::size_t count = points.size();
  keys_.resize(count);
  for (std::size_t k = 0; k < count; ++k) keys_[k] = {points[k], static_cast<std::uint32_t>(k), 0};
  if (count > few_keys) sort_by_digits();
  const auto is_before = [](const Key& a, const Key& b) {
    if (a.at.u != b.at.u) return a.at.u < b.at.u;
    return a.at.v != b.at.v ? a.at.v < b.at.v : a.index < b.index;
  };
  for (auto run = keys_.begin(); run != keys_.end();) {
    const auto end = std::find_if(run + 1, keys_.end(), [&](const Key& key) { return key.digits != run->digits; });
    if (end - run > 1) std::sort(run, end, is_before);
    run = end;
  }
  ranks_.resize(count);
  at_.clear(), first_.clear();
  for (const Key& key : keys_) {
    if (at_.empty() || !(at_.back() == key.at)) at_.push_back(key.at), first_.push_back(key.index);
    ranks_[key.index] = static_cast<std::uint32_t>(at_.size() - 1);
  }
}

}}  // namespace tessera::abi_0_1
