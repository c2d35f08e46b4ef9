#pragma once
// The facts of a result: words for people, one object of JSON for programs.

#include <string>
#include <utility>

#include "console/timings.h"
#include "line/common_options.h"

namespace tessera::cli {

/// A list of facts. Text and object have them in the order in which they are added.
class Report {
 public:
  /// Adds a fact: a member of the object, and the words that stand for it.
  void add(const std::string& name, Json value, const std::string& words = {}) {
    object_[name] = std::move(value);
    words_ += words;
  }
  /// Adds words that stand for no member.
  void say(const std::string& words) { words_ += words; }

  /// Prints the text and ends its line; with --json the object instead, with --timings the seconds in it. Prints on
  /// standard output, or on standard error if `output`, the command's own, is standard output. Errors: io_error,
  /// cancelled.
  Status print(const std::string& output, const CommonOptions& options, const Timings& timings);

 private:
  Json object_ = Json::object();
  std::string words_;
};

}  // namespace tessera::cli
