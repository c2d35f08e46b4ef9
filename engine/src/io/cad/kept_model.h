#pragma once
// A model that was read before, in place of its CAD file: the bytes that tessera-cad-reader prints.

#include <string>
#include <string_view>

#include "tessera/model.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Whether bytes begin as such a model does, of any version.
bool begins_as_kept_model(std::string_view bytes);
/// Restores the model. `name` stands for the file in messages. Errors: parse_error (damaged, or of another size than
/// stated), unsupported (of another version), those of model_from_bytes().
Result<Model> read_kept_model(std::string_view bytes, const std::string& name);

}}  // namespace tessera::abi_0_1
