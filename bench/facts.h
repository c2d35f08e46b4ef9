#pragma once

#include <string>

namespace tessera::bench {

/// What the figures of this program depend on, as an object of JSON: version, compiler, flags, libraries, instruction
/// sets, and the slow-down that was planted (0 but in tests of tools/perf).
std::string build_facts();

}  // namespace tessera::bench
