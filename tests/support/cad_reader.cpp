// Names the CAD reader of this build to the program that it is linked into, unless its user names another.

#include <cstdlib>

namespace tessera::test { namespace {

[[maybe_unused]] const int named = ::setenv("TESSERA_CAD_READER", TESSERA_CAD_READER_FILE, 0);

}}  // namespace tessera::test
