#include "tessera/version.h"

namespace tessera::inline abi_0_1 {

std::string_view version() { return TESSERA_VERSION; }

}  // namespace tessera::inline abi_0_1
