#pragma once
// A set prepared for all planes of a call: the patches that any of them meets, and their borders.

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "block/patch_set_impl.h"
#include "section/strands.h"
#include "tessera/execution.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

class PreparedSet {
 public:
  /// The set and the levels must outlive this object. Errors: cancelled, out_of_memory.
  Status prepare(const PatchSet::Impl& set, const Levels& levels, const Execution& execution);

  const PreparedPatch& patch(std::size_t k) const { return *patches_[k]; }
  /// The unit normal of a patch; zero where it has none.
  Vec3 normal(const PreparedPatch& patch, const ParameterPoint& at) const;
  /// The prepared patches that a level may meet, growing. `level`: index into Levels::heights.
  std::span<const std::uint32_t> of_level(std::size_t level) const {
    return std::span(by_level_).subspan(first_[level], first_[level + 1] - first_[level]);
  }
  /// The patches whose division was ended before it was proven, growing.
  std::vector<std::uint32_t> unproven() const;

 private:
  /// The sides of a patch, as numbers of borders, and whether they run backwards.
  struct Sides {
    std::uint32_t patch;
    std::array<std::uint32_t, 4> borders;
    std::array<bool, 4> reversed;
  };
  void find_patches(const PatchSet::Impl& set, const Levels& levels);
  Status find_regions(const PatchSet::Impl& set, const Execution& execution);
  void make(const PatchSet::Impl& set, const Levels& levels, std::size_t first, std::size_t end);
  void list_by_level(const Levels& levels);

  const PatchSet::Impl* set_ = nullptr;
  std::vector<Sides> sides_;
  std::deque<HeightLine> borders_;
  std::vector<std::pair<double, double>> border_ends_;  ///< heights
  std::vector<TrimRegion> regions_;                     ///< as those of the set's trims, and they locate points
  std::vector<std::unique_ptr<PreparedPatch>> patches_;
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> by_level_;
};

}}  // namespace tessera::abi_0_1
