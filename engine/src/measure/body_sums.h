#pragma once
// Measures from integrals: centroids, inertia, and their bounds.

#include "measure/strip.h"
#include "tessera/measures.h"

namespace tessera { inline namespace abi_0_1 {

/// Returns the centroid by the integrals of 1, x, y, z relative to a centre. `box`: contains all.
MeasuredPoint centroid_of(const Integrals& moments, const Vec3& centre, const Box3& box);

/// Returns the integrals of 1, x, y, z relative to another centre.
Integrals moved_area(const Integrals& area, const Vec3& from, const Vec3& to);

/// Returns the integrals over the volume of 1, x, y, ... from the flux of r, r x, r y, ..., whose divergence is 3, 4
/// and 5 times as much.
Integrals volume_moments(const Integrals& flux);

/// Returns the measures by the integrals of volume_moments(). `box`: contains the body. Volumes must not be negative.
BodyMeasures body_of(const Integrals& moments, const Vec3& centre, const Box3& box);

/// Returns the integrals that body_of() takes, relative to a centre.
Integrals moments_of(const BodyMeasures& body, const Vec3& centre);

/// Returns the measures of a body's image under an affine map. Principal axes are found anew.
BodyMeasures placed(const BodyMeasures& body, const Affine& map);

}}  // namespace tessera::abi_0_1
