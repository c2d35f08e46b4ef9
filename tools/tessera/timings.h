#pragma once
// How long each phase of a command's work took: read, convert, pack, and what the command itself does.

#include <chrono>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "console.h"

namespace tessera::cli {

class Timings {
 public:
  /// Measures until it goes out of scope.
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

  /// `name`: of static storage. What is measured twice is summed.
  Phase phase(std::string_view name) { return {*this, name}; }
  void add(std::string_view name, double seconds);

  /// "read 0.0123 s, pack 0.001 s; 0.0150 s in all", in the order of the phases.
  std::string as_text() const;
  /// {"read": ..., "total": ...} in seconds; the total is the time since this object was made.
  Json as_json() const;

 private:
  std::vector<std::pair<std::string_view, double>> phases_;
  Stopwatch all_;
};

}  // namespace tessera::cli
