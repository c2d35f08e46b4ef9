#pragma once
// The frame of an IGES file: lines of 80 characters, whose 73rd is the letter of their section.

#include <string>

#include "tessera/status.h"

namespace tessera::inline abi_0_1 {

/// That the file begins with section S and has section T, its last: OpenCASCADE takes what there is of a file that is cut
/// short for the whole. Errors: parse_error, io_error, unsupported (the compressed and the binary form).
Status check_iges_sections(const std::string& path);

}  // namespace tessera::inline abi_0_1
