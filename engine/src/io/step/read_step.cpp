#include "io/step/read_step.h"

namespace tessera { inline namespace abi_0_1 {

Result<Model> read_step(std::string_view, const std::string& name, const Execution&) {
  return Status(StatusCode::unsupported, name + ": this build of Tessera does not read STEP files by itself");
}

}}  // namespace tessera::abi_0_1
