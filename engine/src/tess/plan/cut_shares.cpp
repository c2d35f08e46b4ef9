#include "tess/plan/cut_shares.h"

#include <algorithm>

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double least_gain = 0.95;        // of the excess
constexpr double least_since_best = 0.25;  // cells grow as the inverse of the share
constexpr double aim = 0.85;               // of the limit, since rates are whole numbers
constexpr double least_step = 1.0 / 64;

}  // namespace

CutShares::CutShares(std::size_t count, double share) : patches_(count, Patch{.share = share, .best_share = share}) {}

void CutShares::restart(std::size_t patch, double factor) {
  const double share = factor * patches_[patch].share;
  patches_[patch] = {.share = share, .best_share = share};
}

bool CutShares::is_any_due() const { return std::ranges::any_of(patches_, &Patch::is_due); }

void CutShares::take(std::size_t patch, double excess) {
  Patch& of = patches_[patch];
  of.excess = excess;
  of.is_due = false;
  if (excess <= 1 || of.is_settled) return;
  of.is_due = true;
  if (excess < least_gain * of.best_excess) {
    of.best_excess = excess;
    of.best_share = of.share;
    of.since_best = 1;
  } else if (of.since_best < least_since_best) {
    of.is_settled = true;
    of.share = of.best_share;
    return;
  }
  const double step = excess < aim / least_step ? aim / excess : least_step;  // also of NaN
  of.share *= step;
  of.since_best *= step;
}

}}  // namespace tessera::abi_0_1
