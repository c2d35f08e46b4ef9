#pragma once
// Faces with their loops, and curves, as bytes.

#include <optional>

#include "io/cad/byte_stream.h"
#include "tessera/model.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

// Each take_ returns false if the bytes end too early or hold no such thing.

void put_curve(ByteWriter& out, const std::optional<Curve>& curve);
bool take_curve(ByteReader& in, std::optional<Curve>& curve);

void put_colour(ByteWriter& out, const std::optional<Colour>& colour);
bool take_colour(ByteReader& in, std::optional<Colour>& colour);

/// Errors: internal (a surface that is no B-spline).
Status put_surfaces(ByteWriter& out, std::span<const ModelSurface> surfaces);
bool take_surfaces(ByteReader& in, std::vector<ModelSurface>& surfaces);

/// Errors: as put_surfaces().
Status put_faces(ByteWriter& out, std::span<const ShapeFace> faces);
bool take_faces(ByteReader& in, std::vector<ShapeFace>& faces);

}}  // namespace tessera::abi_0_1
