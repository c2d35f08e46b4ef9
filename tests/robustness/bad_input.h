#pragma once
// The table of bad input: entry point by entry point, input by input, what comes back. The tests fill it, and
// engine/docs/bad-input.md is what they filled it with.

#include <cstdint>
#include <functional>
#include <limits>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/status.h"

namespace tessera::test {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// The rows of one header, or of one command.
class Table {
 public:
  /// The rows that follow are of this call.
  void of(const std::string& call);

  /// The call must have failed with this code.
  void row(const std::string& input, StatusCode code, const Status& status);
  template <class T>
  void row(const std::string& input, StatusCode code, const Result<T>& result) {
    row(input, code, result.ok() ? Status() : result.status());
  }
  /// The same, and no byte of its outputs may have changed, as `untouched` says, which is asked after the call.
  void row(const std::string& input, StatusCode code, const Status& status, const std::function<bool()>& untouched);
  /// Unusual input that is no error: what it gives, and whether it did.
  void gives(const std::string& input, const std::string& what, bool holds);
  /// What a program answered.
  void says(const std::string& input, const std::string& answer);

  /// As Markdown.
  const std::string& text() const { return text_; }

 private:
  void line(const std::string& input, const std::string& answer);
  std::string text_, call_;
};

/// A part of the table.
struct Section {
  std::string_view title;
  void (*fill)(Table& table) = nullptr;  ///< null where this build lacks what it is about
};

/// For googletest.
inline void PrintTo(const Section& section, std::ostream* out) { *out << section.title; }

void fill_curves(Table& table);
void fill_callables(Table& table);
void fill_patches(Table& table);
void fill_splines(Table& table);
void fill_hermite(Table& table);
void fill_quadrics(Table& table);
void fill_borders(Table& table);
void fill_operations(Table& table);
void fill_sets(Table& table);
void fill_grids(Table& table);
void fill_points(Table& table);
void fill_functions(Table& table);
void fill_updates(Table& table);
void fill_tessellations(Table& table);
void fill_certified(Table& table);
void fill_meshes(Table& table);
void fill_rays(Table& table);
void fill_batches(Table& table);
void fill_readers(Table& table);
void fill_files(Table& table);
void fill_machine(Table& table);
void fill_commands(Table& table);
void fill_model_commands(Table& table);

}  // namespace tessera::test
