#pragma once
// The suite of benchmarks: every hot path by the name operation/surface/degree/size/isa/threads, in two sets.

#include <benchmark/benchmark.h>

#include <functional>
#include <string>

#include "tessera/execution.h"

namespace tessera::bench {

/// What a case does, on what. No part is empty or holds a slash.
struct CaseName {
  std::string operation;  ///< what is done and how, words joined by dots: "evaluate.positions+normals.blocks"
  std::string surface;    ///< "teapot", "bicubic20000", see sets.h; or the kind of surface
  std::string degree;     ///< "3", "3r" if rational, "-" where it means nothing
  std::string size;       ///< "9x9" parameters, "65536" rays
  std::string isa = "-";  ///< name(Isa), "-" where the operation has no kernels
  int threads = 1;

  std::string text() const;
  /// The text without ISA and threads, as counting.h has it.
  std::string work() const;
};

/// "9x9".
inline std::string square(std::size_t side) { return std::to_string(side) + "x" + std::to_string(side); }

/// The sets: `quick` is what a change is judged by, in two minutes; `full` holds every case.
enum class Part { quick, full };

/// Quick where the instruction set is the fastest of this machine, so that the others are timed in the full set alone.
inline Part quick_on_fastest(Isa isa) { return isa == available_isas().back() ? Part::quick : Part::full; }

/// Registers a case, when the program starts. `run` takes its own time of each call (state.SetIterationTime; timing.h
/// does) and ends with state.SkipWithError where the result that it timed is wrong.
void add_case(const CaseName& name, Part part, std::function<void(benchmark::State&)> run);

/// Runs a set by Google Benchmark's options, which have been taken in; `to_file`: --benchmark_out is among them, for a
/// file of JSON. False where a case failed.
bool run_suite(Part part, bool to_file);

/// Runs the counted set (counting.h), each case once: on one thread, and, where a case has an ISA, of default_isa().
/// False where a case failed or a name of that set is no case.
bool run_counted();

}  // namespace tessera::bench
