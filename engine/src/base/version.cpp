#include "tessera/version.h"

namespace tessera { inline namespace abi_0_1 {

std::string_view version() { return TESSERA_VERSION; }

}}  // namespace tessera::abi_0_1
