#include "suite.h"

#include <stdexcept>
#include <utility>
#include <vector>

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

/// Google Benchmark puts "/manual_time" behind each name. Our names are whole without it. Keeps what went wrong.
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

}  // namespace

std::string CaseName::text() const {
  std::string text;
  for (const std::string* part : {&operation, &surface, &degree, &size, &isa}) {
    if (part->empty() || part->find('/') != std::string::npos)
      throw std::invalid_argument("a benchmark's name has the part \"" + *part + "\"");
    text += *part + '/';
  }
  return text + std::to_string(threads);
}

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

}  // namespace tessera::bench
