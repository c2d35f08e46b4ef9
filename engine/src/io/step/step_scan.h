#pragma once
// Scans the text of a STEP file, instance by instance.

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "io/step/step_index.h"

namespace tessera { inline namespace abi_0_1 {

inline bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The distinct names of kinds, in the order in which they are met.
class KindNames {
 public:
  std::uint32_t index_of(std::string_view name);
  const std::vector<std::string_view>& names() const { return names_; }

 private:
  std::unordered_map<std::string_view, std::uint32_t> known_;
  std::vector<std::string_view> names_;
};

/// Returns the place of the next character that is neither blank nor in a comment, at most the text's size.
std::size_t skip_blanks(std::string_view text, std::size_t at);
/// Returns the place of the ";" that ends a statement, outside of strings and comments, or the text's size.
std::size_t end_of_statement(std::string_view text, std::size_t at);

/// Instances that follow each other.
struct StepRun {
  std::size_t begin = 0, end = 0;  ///< places of the first instance, and of the statement after the last
  std::vector<StepInstance> instances;
  KindNames kinds;
};
/// Reads instances from one on, until one begins at `limit` or later or until something else follows: another
/// statement, the end of the text, or an instance that is not well formed.
StepRun scan_instances(std::string_view text, std::size_t begin, std::size_t limit);
/// Returns where an instance seems to begin a line, at `from` or later and before `limit`; `limit` if there is none. It
/// may lie in a string or in a comment.
std::size_t likely_instance(std::string_view text, std::size_t from, std::size_t limit);

}}  // namespace tessera::abi_0_1
