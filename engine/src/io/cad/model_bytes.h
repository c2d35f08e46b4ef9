#pragma once
// A model of splines, or the error in its place, as bytes for another process on this machine.

#include <string>
#include <string_view>

#include "tessera/model.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Version of the bytes. Raise it with each change of what they mean, which includes the numbers of StatusCode.
inline constexpr int model_bytes_version = 2;
/// Begin of the message of model_from_bytes() for other bytes; ": " and the reason may follow.
inline constexpr std::string_view damaged_model = "a damaged model";

/// Converts a model to bytes. Its surfaces must be B-splines; any other kind gives an internal error. With instances,
/// the bytes hold the shapes instead of the model's surfaces.
std::string to_bytes(const Result<Model>& model);
/// Restores the model, bit for bit but for surfaces of instances, which are placed anew. Checks all ids. Errors: the
/// one that was written; internal (these are not bytes of to_bytes; the message begins with damaged_model); unsupported
/// (instances of more than four million faces).
Result<Model> model_from_bytes(std::string_view bytes);

}}  // namespace tessera::abi_0_1
