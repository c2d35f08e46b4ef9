#pragma once
// The families of results of the project's own models.

#include <vector>

#include "same_bytes/families.h"

/// A grid, a certified mesh and ray hits of each model of tools/models. Models whose patches depend on sines, powers
/// and the like are left out: these functions differ between C libraries, and between processors with one C library.
std::vector<Family> model_families();
