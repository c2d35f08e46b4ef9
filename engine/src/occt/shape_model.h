#pragma once
// The faces of a shape as a model.

#include <string>

#include "occt/described_shape.h"
#include "tessera/model.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Makes the model that tessera/cad.h describes, face by face in the order of the shape. Messages begin with `path`, if
/// it is not empty. Errors: parse_error; if no face remains, the error of the first one.
Result<Model> model_of(const DescribedShape& file, const std::string& path);

}}  // namespace tessera::abi_0_1
