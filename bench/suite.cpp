#include "suite.h"

#include <cstdio>
#include <stdexcept>
#include <utility>
#include <vector>

#include "counting.h"

namespace tessera::bench {
namespace {

struct Case {
  CaseName name;
  Part part;
  std::function<void(benchmark::State&)> run;
};

std::vector<Case>& cases() {
  static std::vector<Case> all;
  return all;
}

/// Removes "/manual_time", which Google Benchmark appends to each name. Remembers whether a case failed.
template <class Base>
class PlainNames : public Base {
 public:
  using Base::Base;
  void ReportRuns(const std::vector<benchmark::BenchmarkReporter::Run>& runs) override {
    std::vector<benchmark::BenchmarkReporter::Run> plain = runs;
    for (auto& run : plain) {
      run.run_name.time_type.clear();
      failed = failed || run.error_occurred;
    }
    Base::ReportRuns(plain);
  }
  bool failed = false;
};

/// Names each case before it runs, and prints failures: there are no times.
class CountReporter : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.error_occurred)
        std::printf("failed: %s: %s\n", run.run_name.function_name.c_str(), run.error_message.c_str());
      failed = failed || run.error_occurred;
    }
  }
  bool failed = false;
};

/// Whether counting runs this variant of a case: on one thread, and with this ISA if it has one.
bool is_counted(const Case& c, std::string_view isa) {
  return c.name.threads == 1 && (c.name.isa == "-" || c.name.isa == isa);
}

void register_counted(const Case& c) {
  const auto run = [&c](benchmark::State& state) {
    std::printf("counting %s\n", c.name.work().c_str());
    std::fflush(stdout);
    name_count(c.name.work());
    c.run(state);
  };
  benchmark::RegisterBenchmark(c.name.work().c_str(), run)->UseManualTime()->Iterations(1);
}

std::string joined(std::initializer_list<const std::string*> parts) {
  std::string text;
  for (const std::string* part : parts) {
    if (part->empty() || part->find('/') != std::string::npos)
      throw std::invalid_argument("a benchmark's name has the part \"" + *part + "\"");
    text += (text.empty() ? "" : "/") + *part;
  }
  return text;
}

}  // namespace

std::string CaseName::work() const { return joined({&operation, &surface, &degree, &size}); }
std::string CaseName::text() const { return work() + '/' + joined({&isa}) + '/' + std::to_string(threads); }

void add_case(const CaseName& name, Part part, std::function<void(benchmark::State&)> run) {
  cases().push_back({name, part, std::move(run)});
}

bool run_suite(Part part, bool to_file) {
  for (const Case& c : cases())
    if (part == Part::full || c.part == Part::quick)
      benchmark::RegisterBenchmark(c.name.text().c_str(), c.run)->UseManualTime()->Unit(benchmark::kMillisecond);
  PlainNames<benchmark::ConsoleReporter> console(benchmark::ConsoleReporter::OO_Tabular);
  PlainNames<benchmark::JSONReporter> file;
  if (to_file) {
    benchmark::RunSpecifiedBenchmarks(&console, &file);
  } else {
    benchmark::RunSpecifiedBenchmarks(&console);
  }
  return !console.failed;
}

bool run_counted() {
  const Result<Isa> isa = default_isa();
  if (!isa) return std::printf("failed: %s\n", isa.status().message().c_str()), false;
  start_counting();
  bool complete = true;
  for (const std::string_view work : counted_cases()) {
    bool exists = false;
    for (const Case& c : cases()) {
      if (c.name.work() != work) continue;
      exists = true;
      if (is_counted(c, name(*isa))) register_counted(c);
    }
    if (!exists) std::printf("failed: no case has the name %s\n", std::string(work).c_str());
    complete = complete && exists;
  }
  CountReporter reporter;
  benchmark::RunSpecifiedBenchmarks(&reporter);
  return complete && !reporter.failed;
}

}  // namespace tessera::bench
