// Prints a line for each family of results and each instruction set of the machine: family, instruction set, hash.
// Results that do not depend on the instruction set are printed once.

#include <cinttypes>
#include <cstdio>

#include "families.h"

namespace {

void print(const Family& family, tessera::Isa isa, const std::string& label) {
  std::printf("%s %s %016" PRIx64 "\n", family.name.c_str(), label.c_str(), family.hash(isa));
}

}  // namespace

int main() {
  for (const Family& family : surface_families()) print(family, tessera::available_isas().front(), "any");
  std::vector<Family> families = set_families();
#ifdef SAME_BYTES_RAYS
  for (const Family& family : ray_families()) families.push_back(family);
#endif
  for (const Family& family : families)
    for (const tessera::Isa isa : tessera::available_isas()) print(family, isa, std::string(name(isa)));
}
