#pragma once
// Models of STEP files, read by Tessera itself.

#include <string>
#include <string_view>

#include "tessera/execution.h"
#include "tessera/model.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Reads the text of a STEP file. Messages begin with `name`.
Result<Model> read_step(std::string_view text, const std::string& name, const Execution& execution = {});

}}  // namespace tessera::abi_0_1
