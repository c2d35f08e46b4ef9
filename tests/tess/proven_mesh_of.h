#pragma once
// The inside of plans.

#include "base/impl_access.h"
#include "tess/mesh/proven_mesh.h"

namespace tessera::test {

/// The inside of a plan from tolerances.
inline const ProvenMesh& proven_mesh_of(const Tessellation& plan) {
  return dynamic_cast<const ProvenMesh&>(impl_of(plan));
}

}  // namespace tessera::test
