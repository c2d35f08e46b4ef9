#pragma once
// A ray scene's view of a patch set: valid while the set lives, even if the PatchSet object is moved.

#include <cstdint>
#include <vector>

#include "base/impl_access.h"
#include "block/patch_set_impl.h"
#include "tessera/patch_set.h"

namespace tessera { inline namespace abi_0_1 {

class SetView {
 public:
  explicit SetView(const PatchSet& set) : set_(&impl_of(set)) {}

  std::size_t patch_count() const { return set_->patches.size(); }
  const BezierPatch& patch(std::size_t index) const { return set_->patches[index]; }
  const PatchSource& source(std::size_t index) const { return set_->sources[index]; }
  SideMask collapsed_sides(std::size_t index) const { return set_->collapsed[index]; }
  Vec3 origin() const { return set_->origin; }
  Box3 box() const { return set_->box(); }  ///< visits every control point
  std::uint64_t revision() const { return set_->revision; }
  /// Returns the patches that were edited after that revision, in order.
  std::vector<std::uint32_t> edited_since(std::uint64_t revision) const {
    std::vector<std::uint32_t> out;
    for (std::uint32_t k = 0; k < set_->edited.size(); ++k) {
      if (set_->edited[k] > revision) out.push_back(k);
    }
    return out;
  }
  const PatchSet::Impl& impl() const { return *set_; }

 private:
  const PatchSet::Impl* set_;
};

}}  // namespace tessera::abi_0_1
