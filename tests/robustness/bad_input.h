#pragma once
// The table of bad input: for each entry point and each input, the answer. The tests fill it, and
// engine/docs/bad-input.md is the result.

#include <cstdint>
#include <functional>
#include <limits>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "base/infinity.h"
#include "tessera/status.h"

namespace tessera::test {

inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// The rows of one header, or of one command.
class Table {
 public:
  /// Begins the rows of this call.
  void of(const std::string& call);

  /// The call must have failed with this code.
  void row(const std::string& input, StatusCode code, const Status& status);
  template <class T>
  void row(const std::string& input, StatusCode code, const Result<T>& result) {
    row(input, code, result.ok() ? Status() : result.status());
  }
  /// The call must have failed with this code, and no byte of its outputs may have changed: `untouched` is asked after
  /// the call.
  void row(const std::string& input, StatusCode code, const Status& status, const std::function<bool()>& untouched);
  /// Unusual input that is not an error: the result, and whether it is right.
  void gives(const std::string& input, const std::string& what, bool holds);
  /// The answer of a program.
  void says(const std::string& input, const std::string& answer);

  /// The table as Markdown.
  const std::string& text() const { return text_; }

 private:
  void line(const std::string& input, const std::string& answer);
  std::string text_, call_;
};

/// A part of the table.
struct Section {
  std::string_view title;
  void (*fill)(Table& table) = nullptr;  ///< null if this build lacks the part
};

inline void PrintTo(const Section& section, std::ostream* out) { *out << section.title; }

void fill_curves(Table& table);
void fill_callables(Table& table);
void fill_patches(Table& table);
void fill_splines(Table& table);
void fill_hermite(Table& table);
void fill_quadrics(Table& table);
void fill_borders(Table& table);
void fill_trims(Table& table);
void fill_operations(Table& table);
void fill_sets(Table& table);
void fill_shapes(Table& table);
void fill_measures(Table& table);
void fill_grids(Table& table);
void fill_points(Table& table);
void fill_functions(Table& table);
void fill_updates(Table& table);
void fill_tessellations(Table& table);
void fill_meshes(Table& table);
void fill_rays(Table& table);
void fill_batches(Table& table);
void fill_queries(Table& table);
void fill_readers(Table& table);
void fill_files(Table& table);
void fill_machine(Table& table);
void fill_commands(Table& table);
void fill_model_commands(Table& table);

}  // namespace tessera::test
