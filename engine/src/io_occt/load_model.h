#pragma once
// A CAD file as a model, in this process.

#include <string>
#include <string_view>

#include "tessera/model.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Reads a file of the format "STEP", "IGES" or "BREP". Messages begin with `path`. Errors: as read_cad(), and
/// unsupported (the format).
Result<Model> load_model(std::string_view format, const std::string& path);

}}  // namespace tessera::abi_0_1
