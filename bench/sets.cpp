#include "sets.h"

#include <filesystem>

#include "support/synthetic_sets.h"
#include "tessera/io.h"

namespace tessera::bench {

const PatchSet& set_named(std::string_view name) {
  if (name == "teapot") {
    static const PatchSet teapot = test::value_of(make_patch_set(
        test::value_of(read_model(std::filesystem::path(TESSERA_SOURCE_DIR) / "tools" / "models" / "teapot.bpt"))));
    return teapot;
  }
  static const PatchSet field = test::value_of(PatchSet::from(test::wavy_field(200, 100)));
  return field;
}

}  // namespace tessera::bench
