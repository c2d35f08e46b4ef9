#pragma once
// The surfaces whose results are hashed: every kind, from one seed.

#include <vector>

#include <tessera/patch_set.h>
#include <tessera/surface.h>

/// Bezier patches of degrees 1 to 6, a third of them rational, one with a collapsed edge.
std::vector<tessera::BezierPatch> some_patches();
/// One surface of nearly every kind, including circles, fits and eigenvectors.
std::vector<tessera::Surface> some_surfaces();
/// some_patches() with every kind of block.
tessera::PatchSet some_set();
