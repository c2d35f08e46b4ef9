#pragma once
// A model that was read before, in place of its CAD file: the bytes that tessera-cad-reader prints.

#include <cstddef>
#include <string>
#include <string_view>

#include "tessera/model.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

constexpr std::string_view greeting_begin = "tessera-cad-reader ";  ///< of every version
constexpr std::size_t greeting_size = 64;
/// The first bytes that a reader prints: its version and that of model_bytes.h, padded with blanks.
std::string cad_reader_greeting();
/// Words in quotation marks, without blanks at their end, without what terminals obey, and not too long.
std::string quoted_words(std::string_view words);

/// Whether bytes begin as such a model does, of any version.
bool begins_as_kept_model(std::string_view bytes);
/// Restores the model. `name` stands for the file in messages. Errors: parse_error (damaged, or of another size than
/// stated), unsupported (of another version), those of model_from_bytes().
Result<Model> read_kept_model(std::string_view bytes, const std::string& name);

}}  // namespace tessera::abi_0_1
