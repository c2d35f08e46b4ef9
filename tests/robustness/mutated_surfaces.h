#pragma once
// A surface of any kind from a mutated description of a valid one.

#include "robustness/mutator.h"
#include "tessera/model.h"

namespace tessera::test {

Result<Surface> mutated_surface(Mutator& m);

}  // namespace tessera::test
