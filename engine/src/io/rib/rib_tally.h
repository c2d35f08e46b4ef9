#pragma once
// Counts of requests, for warnings.

#include <cstddef>
#include <map>
#include <string>
#include <string_view>

#include "io/file/passed_over.h"
#include "io/file/text_cursor.h"

namespace tessera { inline namespace abi_0_1 {

/// Counts occurrences by name, and keeps the place of the first. The names must outlive it.
class Tally {
 public:
  void add(std::string_view name, const TextCursor& at) {
    if (counts_.empty()) place_ = at.place();
    ++counts_[name];
    ++total_;
  }
  bool empty() const { return counts_.empty(); }
  std::size_t total() const { return total_; }
  /// "file:line" of the first.
  const std::string& place() const { return place_; }
  /// "Color 6, Display 4".
  std::string words() const {
    constexpr std::size_t limit = 40;
    std::string words;
    std::size_t listed = 0;
    for (const auto& [name, count] : counts_) {
      if (listed++ == limit) return words + " and " + std::to_string(counts_.size() - limit) + " more";
      words += (words.empty() ? "" : ", ") + surface_name(name) + ' ' + std::to_string(count);
    }
    return words;
  }

 private:
  std::map<std::string_view, std::size_t> counts_;
  std::size_t total_ = 0;
  std::string place_;
};

}}  // namespace tessera::abi_0_1
