#pragma once
// The parts of the tolerance that the cells of cut patches may take, from attempt to attempt.

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace tessera { inline namespace abi_0_1 {

/// Finds for each cut patch the share of its room that its cells may take, so that the patch as it is cut keeps its
/// limits.
///
/// A patch above its limits gets a smaller share, and so more cells, in the next attempt. That may not help: a loop's
/// own error does not shrink with the cells. So a patch whose cells have become four times as many without a gain of a
/// twentieth is settled: it returns to the share of its least excess, and keeps the bound that it has there. Each
/// patch is settled or within its limits after a bounded number of attempts, because its excess is at least 1 before
/// and each gain divides it.
class CutShares {
 public:
  /// `share`: the first of each patch.
  CutShares(std::size_t count, double share);

  double share(std::size_t patch) const { return patches_[patch].share; }
  /// Whether the patch must be cut anew in the next attempt.
  bool is_due(std::size_t patch) const { return patches_[patch].is_due; }
  bool is_any_due() const;
  /// Whether the patch stays above its limits.
  bool is_beyond(std::size_t patch) const { return !(patches_[patch].excess <= 1); }
  /// Begins anew with a share smaller by `factor`.
  void restart(std::size_t patch, double factor);
  /// Takes the result of an attempt: the largest bound of the patch over its limit.
  void take(std::size_t patch, double excess);
  /// Keeps the cells that the patch has: no others can be chosen for its share.
  void settle(std::size_t patch) { patches_[patch].is_settled = true; }

 private:
  struct Patch {
    double share = 1, excess = std::numeric_limits<double>::infinity();
    double best_share = 1, best_excess = std::numeric_limits<double>::infinity();
    double since_best = 1;  ///< the share over that of the least excess
    bool is_due = true, is_settled = false;
  };
  std::vector<Patch> patches_;
};

}}  // namespace tessera::abi_0_1
