#pragma once
// The origins of rays in the contexts of the user's Embree queries.

#include "ray/embree/embree_api.h"

namespace tessera { inline namespace abi_0_1 {

/// Returns whether the context is an EmbreeOriginContext. Embree 3 tells by a mark in the context; in Embree 4 the
/// geometry's options have promised it or not.
bool has_origins(const EmbreeContext& context, bool promised);

/// Returns the origin of the ray with this id, or null. The context must be an EmbreeOriginContext.
const EmbreeOrigin* origin_of(const EmbreeContext& context, unsigned ray);

/// Returns whether the origin lies in a geometry, in the instance that Embree has entered.
bool names(const EmbreeOrigin& origin, unsigned geometry, const EmbreeContext& context);

}}  // namespace tessera::abi_0_1
