#pragma once
// The faces of a shape as a model.

#include <string>

#include "occt/described_shape.h"
#include "tessera/execution.h"
#include "tessera/occt.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Makes the model that tessera/cad.h describes, with faces in the order of the shape, which all threads convert.
/// Messages begin with `path`, if it is not empty. Errors: parse_error (no surfaces); if no face remains, the error of
/// the first one; cancelled, out_of_memory, internal (an exception of OpenCASCADE). May throw Standard_Failure.
Result<OcctModel> model_of(const DescribedShape& file, const std::string& path, const Execution& execution = {});

}}  // namespace tessera::abi_0_1
