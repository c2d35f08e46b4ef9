#pragma once
// The memory of the process during endless work.

#include <string>
#include <vector>

#include "tessera/status.h"

namespace tessera::bench {

struct SoakSample {
  double seconds = 0;      ///< since the start
  double resident = 0;     ///< MiB
  std::size_t rounds = 0;  ///< of work, since the start
};

/// The growth of the resident memory in MiB per hour: the slope of the line through the samples of the second half.
double growth_per_hour(const std::vector<SoakSample>& samples);

/// Draws a chart of the resident memory over time, as PNG. Errors: those of write_png.
Status draw_soak(const std::vector<SoakSample>& samples, const std::string& path);

}  // namespace tessera::bench
