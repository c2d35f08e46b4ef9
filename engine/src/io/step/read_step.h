#pragma once
// Models of STEP files, read by Tessera itself.

#include <string>
#include <string_view>

#include "tessera/execution.h"
#include "tessera/model.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Reads the text of a STEP file. Messages begin with `name`.
///
/// Errors: parse_error (no DATA section), those of the first face that cannot be read (if none can), parse_error (no
/// surfaces; the message says what the file holds), unsupported (more than 2^24 faces; parts that are far larger than
/// the file, since they share faces, loops or surfaces), cancelled, out_of_memory.
/// Threads: any number of calls at once.
Result<Model> read_step(std::string_view text, const std::string& name, const Execution& execution = {});

}}  // namespace tessera::abi_0_1
