#pragma once
// The suite of benchmarks: every hot path by the name operation/surface/degree/size/isa/threads, in two sets.

#include <benchmark/benchmark.h>

#include <functional>
#include <string>

#include "tessera/execution.h"

namespace tessera::bench {

/// The operation of a case, and its data. No part is empty or holds a slash.
struct CaseName {
  std::string operation;  ///< the operation and its variant, words joined by dots: "evaluate.positions+normals.blocks"
  std::string surface;    ///< "teapot", "bicubic20000", see sets.h; or the kind of surface
  std::string degree;     ///< "3", "3r" if rational, "-" if it has no meaning
  std::string size;       ///< "9x9" parameters, "65536" rays
  std::string isa = "-";  ///< name(Isa), "-" if the operation has no kernels
  int threads = 1;

  std::string text() const;
  /// The name without ISA and threads, as counting.h uses it.
  std::string work() const;
};

/// "9x9".
inline std::string square(std::size_t side) { return std::to_string(side) + "x" + std::to_string(side); }

/// The sets: `quick` takes two minutes and decides whether a change is slower; `full` holds every case.
enum class Part { quick, full };

/// Quick for the fastest instruction set of this machine; only the full set times the others.
inline Part quick_on_fastest(Isa isa) { return isa == available_isas().back() ? Part::quick : Part::full; }

/// Registers a case at the program's start. `run` measures the time of each call itself (state.SetIterationTime;
/// timing.h does), and ends with state.SkipWithError if the timed result is wrong.
void add_case(const CaseName& name, Part part, std::function<void(benchmark::State&)> run);

/// Runs a set with the options of Google Benchmark, which has parsed them. `to_file`: they include --benchmark_out, for
/// a file of JSON. False if a case failed.
bool run_suite(Part part, bool to_file);

/// Runs the counted set (counting.h), each case once: on one thread, and, if a case has an ISA, only that of
/// default_isa(). False if a case failed or a name of that set is not a case.
bool run_counted();

}  // namespace tessera::bench
