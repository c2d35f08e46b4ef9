// Parts of a model that take turns, with only the public header of tessera::parts.

#include <cstdio>

#include "tessera/transport.h"

int main() {
  const tessera::Status status = tessera::run_parts(3, [](tessera::Transport& transport) -> tessera::Status {
    double largest[] = {static_cast<double>(transport.part())};
    if (tessera::Status met = transport.reduce_max(largest); !met.ok()) return met;
    return largest[0] == 2 ? tessera::Status() : tessera::Status(tessera::StatusCode::internal, "a wrong maximum");
  });
  if (!status.ok()) std::fprintf(stderr, "%s\n", status.message().c_str());
  return status.ok() ? 0 : 1;
}
