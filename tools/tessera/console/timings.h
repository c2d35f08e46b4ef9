#pragma once
// The time of each phase of a command: read, convert, pack, and the command's own.

#include <chrono>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "console/console.h"

namespace tessera::cli {

class Timings {
 public:
  /// Measures until its destruction.
  class Phase {
   public:
    Phase(Timings& timings, std::string_view name) : timings_(timings), name_(name) {}
    Phase(const Phase&) = delete;
    Phase& operator=(const Phase&) = delete;
    ~Phase() { timings_.add(name_, clock_.seconds()); }

   private:
    Timings& timings_;
    std::string_view name_;
    Stopwatch clock_;
  };

  /// Measures the phase `name`, which must have static storage. Times of the same name are summed.
  Phase phase(std::string_view name) { return {*this, name}; }
  /// Does `work` as the phase `name`, and returns its result.
  auto measure(std::string_view name, const auto& work) {
    const Phase measured = phase(name);
    return work();
  }
  void add(std::string_view name, double seconds);

  /// "read 0.0123 s, pack 0.001 s; 0.0150 s in all", in the order of the phases.
  std::string as_text() const;
  /// The seconds since this object was made.
  double total() const { return all_.seconds(); }
  /// {"read": ..., "total": ...} in seconds; the total is the time since this object was made.
  Json as_json() const;

 private:
  std::vector<std::pair<std::string_view, double>> phases_;
  Stopwatch all_;
};

}  // namespace tessera::cli
