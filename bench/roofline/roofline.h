#pragma once
// Reports the limits of the user's machine, and how near the kernels come to them.

#include <string>
#include <vector>

#include "tessera/limits.h"
#include "tessera/status.h"

namespace tessera::bench {

/// Operations per second over operations per byte, one thread.
struct RooflinePoint {
  std::string name;       ///< "positions"
  double per_byte = 0;    ///< operations of Work over the bytes it must write
  double operations = 0;  ///< per second, measured
  double points = 0;      ///< of surfaces, per second
  bool in_cache = false;  ///< the output stays in the second-level cache
};

struct Roofline {
  std::string machine;
  std::vector<Limits> isas;  ///< per instruction set, slowest first, with stores past the caches
  double cache_store = 0;    ///< bytes per second into the second-level cache, fastest instruction set
  std::vector<RooflinePoint> points;
};

/// Measures (some seconds), prints, and writes the numbers as JSON, unless `file` is empty. Errors: those of the
/// measurements, and io_error.
Status print_roofline(const std::string& file);

}  // namespace tessera::bench
