// tessera_bench: the suite, and the machine's own limits.

#include <benchmark/benchmark.h>

#include <cstdio>
#include <cstring>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "counting.h"
#include "facts.h"
#include "roofline/roofline.h"
#include "suite.h"

namespace tessera::bench { namespace {

constexpr const char* usage =
    R"(tessera_bench [--set=quick|full] [options of Google Benchmark]
tessera_bench --roofline[=FILE.json]
tessera_bench --count [--benchmark_filter=REGEX]
tessera_bench --facts

Times every hot path: operation/surface/degree/size/isa/threads. Each case checks the result that it timed and reports
items and bytes a second by the best time of a call, and limit_fraction, the time at the limits of this machine over that
time (include/tessera/limits.h). The set quick takes two minutes; full, the default, holds all. --benchmark_filter=REGEX
chooses among a set's names, --benchmark_list_tests=true prints them.
--roofline prints the limits of this machine and how near the kernels come to them, and writes the numbers to
FILE.json, which tools/perf roofline draws.
--count does the work of the counted cases once each, for callgrind to count its instructions: tools/perf count starts it
under valgrind and reads the counts. TESSERA_ISA chooses the instruction set.
--facts prints what the figures of this program depend on, as JSON: compiler, flags, libraries, instruction sets.
)";

struct Arguments {
  Part part = Part::full;
  std::string limits_file;    ///< path of the roofline's numbers; empty: they are only printed
  std::vector<char*> others;  ///< Google Benchmark's
  bool to_file = false, help = false, wrong = false, count = false, facts = false, roofline = false;
};

Arguments parse(int count, char** words) {
  static char quick_time[] = "--benchmark_min_time=0.1";
  Arguments out;
  out.others.push_back(words[0]);
  for (int k = 1; k < count; ++k) {
    const std::string_view word = words[k];
    if (word == "--help" || word == "-h") {
      out.help = true;
    } else if (word == "--set=quick") {
      out.part = Part::quick;
      out.others.insert(out.others.begin() + 1, quick_time);  // the caller's own time comes later and has priority
    } else if (word == "--set=full") {
      out.part = Part::full;
    } else if (word == "--count") {
      out.count = true;
    } else if (word == "--facts") {
      out.facts = true;
    } else if (word == "--roofline") {
      out.roofline = true;
    } else if (word.starts_with("--roofline=") && word.ends_with(".json")) {
      out.roofline = true;
      out.limits_file = word.substr(std::strlen("--roofline="));
    } else if (word.starts_with("--roofline=")) {
      std::fprintf(stderr, "tessera_bench: %s: the name must end in .json; tools/perf roofline draws that file\n",
                   words[k]);
      out.wrong = true;
    } else if (word.starts_with("--benchmark_")) {
      out.to_file = out.to_file || word.starts_with("--benchmark_out=");
      out.others.push_back(words[k]);
    } else {
      std::fprintf(stderr, "tessera_bench: unknown argument '%s' (see --help)\n", words[k]);
      out.wrong = true;
    }
  }
  return out;
}

int run(int count, char** words) {
  Arguments arguments = parse(count, words);
  if (arguments.wrong) return 2;
  if (arguments.help) return std::fputs(usage, stdout), 0;
  if (arguments.facts) return std::fputs(build_facts().c_str(), stdout), 0;
  if (arguments.roofline) {
    const Status status = print_roofline(arguments.limits_file);
    if (!status.ok()) return std::fprintf(stderr, "tessera_bench: %s\n", status.message().c_str()), 1;
    return 0;
  }
  int left = static_cast<int>(arguments.others.size());
  benchmark::Initialize(&left, arguments.others.data());
  if (benchmark::ReportUnrecognizedArguments(left, arguments.others.data())) return 2;
  if (arguments.count && !under_valgrind())
    std::fputs(
        "tessera_bench: nothing is counted: valgrind does not run this program, or it was built without "
        "valgrind/callgrind.h\n",
        stderr);
  const bool good = arguments.count ? run_counted() : run_suite(arguments.part, arguments.to_file);
  benchmark::Shutdown();
  return good ? 0 : 1;
}

}}  // namespace tessera::bench

int main(int count, char** words) {
  try {
    return tessera::bench::run(count, words);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tessera_bench: %s\n", error.what());
    return 1;
  }
}
