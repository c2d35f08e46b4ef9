#pragma once
// The frame of an IGES file: lines of 80 characters; the 73rd is the letter of their section.

#include <string>

#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Checks that the file begins with section S and has section T, its last: OpenCASCADE takes a truncated file for a
/// whole one. Errors: parse_error, io_error, unsupported (the compressed and the binary form).
Status check_iges_sections(const std::string& path);

}}  // namespace tessera::abi_0_1
