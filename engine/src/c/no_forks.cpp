// Stands for forks.cpp on platforms without processes.

#include "c/forks.h"

namespace tessera { inline namespace abi_0_1 {

bool is_forked() { return false; }

}}  // namespace tessera::abi_0_1
