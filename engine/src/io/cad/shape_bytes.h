#pragma once
// Shapes and instances as bytes.

#include <vector>

#include "io/cad/byte_stream.h"
#include "tessera/model.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Errors: internal (a surface that is no B-spline).
Status put_shapes(ByteWriter& out, const std::vector<Shape>& shapes);
/// Returns false if the bytes end too early or hold no shapes. Leaves ids unchecked.
bool take_shapes(ByteReader& in, std::vector<Shape>& shapes);

// The numbers of the first surfaces follow from the shapes, and are no part of the bytes.

void put_instances(ByteWriter& out, const std::vector<Instance>& instances);
bool take_instances(ByteReader& in, std::vector<Instance>& instances);

}}  // namespace tessera::abi_0_1
