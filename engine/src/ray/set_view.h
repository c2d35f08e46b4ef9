#pragma once
// The state of a patch set as a ray scene keeps it: valid while the set lives, wherever the set itself is moved.

#include "tessera/patch_set.h"

namespace tessera {

class SetView {
 public:
  explicit SetView(const PatchSet& set) : set_(&set) {}

  std::size_t patch_count() const { return set_->patch_count(); }
  const BezierPatch& patch(std::size_t index) const { return set_->patch(index); }
  const PatchSource& source(std::size_t index) const { return set_->source(index); }
  Vec3 origin() const { return set_->origin(); }
  const Box3& box() const { return set_->box(); }
  std::uint64_t revision() const { return set_->revision(); }
  const PatchSet& set() const { return *set_; }

 private:
  const PatchSet* set_;
};

}  // namespace tessera
