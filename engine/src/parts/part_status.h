#pragma once
// Errors of parts.

#include <cstddef>
#include <string>

#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Returns "part 3: ..." for an error of part 3, unless its message names a part already, as errors do that parts were
/// told of.
[[gnu::cold]] inline Status in_part(std::size_t part, const Status& status) {
  const std::string& text = status.message();
  const std::size_t digits = text.starts_with("part ") ? text.find_first_not_of("0123456789", 5) : 0;
  if (digits > 5 && digits != std::string::npos && text[digits] == ':') return status;
  return Status(status.code(), "part " + std::to_string(part) + ": " + text, status.index());
}

}}  // namespace tessera::abi_0_1
