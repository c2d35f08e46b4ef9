#pragma once

#include <string>

namespace tessera::bench {

/// The facts that the figures of this program depend on, as a JSON object: version, compiler, flags, libraries,
/// instruction sets, and the planted slow-down (0 except in tests of tools/perf).
std::string build_facts();

}  // namespace tessera::bench
