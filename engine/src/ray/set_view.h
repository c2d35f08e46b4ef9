#pragma once
// The state of a patch set as a ray scene keeps it: valid while the set lives, wherever the set itself is moved.

#include "block/patch_set_impl.h"
#include "tessera/patch_set.h"

namespace tessera {

class SetView {
 public:
  explicit SetView(const PatchSet& set) : set_(&set.impl()) {}

  std::size_t patch_count() const { return set_->patches.size(); }
  const BezierPatch& patch(std::size_t index) const { return set_->patches[index]; }
  const PatchSource& source(std::size_t index) const { return set_->sources[index]; }
  EdgeMask collapsed_edges(std::size_t index) const { return set_->collapsed[index]; }
  Vec3 origin() const { return set_->origin; }
  Box3 box() const { return set_->box(); }  ///< looks at every control point
  std::uint64_t revision() const { return set_->revision; }
  const PatchSet::Impl& impl() const { return *set_; }

 private:
  const PatchSet::Impl* set_;
};

}  // namespace tessera
