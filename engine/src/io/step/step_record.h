#pragma once
// The values of one record of a STEP file.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

enum class StepKind : std::uint8_t {
  omitted,      ///< $
  derived,      ///< *
  integer,      ///< 12
  real,         ///< 1.5E-3
  text,         ///< 'name', as it is in the file: see step_text()
  binary,       ///< "0A3"
  enumeration,  ///< .MILLI., without the dots
  reference,    ///< #12
  list,         ///< (..)
  typed,        ///< LENGTH_MEASURE(..), and a record itself
};

/// A value. Those of a list, or in the parentheses of a typed one, follow it in their order, each with its own.
struct StepValue {
  StepKind kind = StepKind::omitted;
  std::uint32_t end = 0;        ///< index of the next value that is not within this one
  std::string_view text;        ///< of text, binary and enumerations; the name of a typed one
  double number = 0;            ///< of integers and reals
  std::uint64_t reference = 0;  ///< the instance's number
};

/// The values of a record, one after the other.
class StepRecord {
 public:
  /// Takes memory that records of this thread have given back, if there is any.
  StepRecord();
  ~StepRecord();
  StepRecord(const StepRecord&) = delete;
  StepRecord& operator=(const StepRecord&) = delete;

  /// Reads a record, "KIND(..)" or "(A(..)B(..))": the first value is typed, or there is one typed value for each kind.
  /// The text must outlive the values; memory is reused. Errors: parse_error (index = the place in the text).
  Status read(std::string_view text);

  std::size_t size() const { return values_.size(); }
  const StepValue& operator[](std::size_t k) const { return values_[k]; }
  /// Returns the index of the k-th value within the value `of`, or 0, which is within no other, if it has fewer.
  std::size_t within(std::size_t of, std::size_t k) const;
  /// Returns how many values a value has, those within them not counted.
  std::size_t count(std::size_t of) const;
  /// Returns the index of the typed value of a kind that stands for itself, or npos.
  std::size_t part(std::string_view kind) const;
  static constexpr std::size_t npos = static_cast<std::size_t>(-1);

 private:
  bool open_value(std::string_view text, std::size_t& at);

  std::vector<StepValue> values_;
  std::vector<std::uint32_t> open_;  ///< lists that are not closed yet, while reading
};

/// Returns a text of a file as UTF-8: doubled quotes and backslashes, \X\, \X2\, \X4\, \S\, \P_\, and bytes beyond
/// ASCII, which are Latin-1 where they are not UTF-8. What is malformed stays as it is.
std::string step_text(std::string_view raw);

}}  // namespace tessera::abi_0_1
