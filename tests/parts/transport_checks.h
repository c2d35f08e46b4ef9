#pragma once
// Checks that every transport must pass, whatever carries the messages. Each part runs them; a failure is an error.

#include <cstdint>
#include <string>
#include <vector>

#include "tessera/transport.h"

namespace tessera::test {

/// An error that names a wrong result.
Status wrong(const std::string& what);

struct TransportCheck {
  const char* name;
  Status (*run)(Transport&);
};
extern const std::vector<TransportCheck> transport_checks;

}  // namespace tessera::test
