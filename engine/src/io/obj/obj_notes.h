#pragma once
// Collects what a reader of OBJ files skips, for one warning at the end.

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/file/text_cursor.h"

namespace tessera { inline namespace abi_0_1 {

/// Statements by name: how often each occurred, and where the first stood.
class ObjNotes {
 public:
  void add(std::string_view statement, const TextCursor& place) {
    if (!first_) first_ = place;
    ++total_;
    for (auto& [name, count] : counts_) {
      if (name == statement) return void(++count);
    }
    if (counts_.size() < max_names) counts_.emplace_back(statement, 1);
  }
  bool empty() const { return total_ == 0; }
  /// "m.obj:3: 7 statements are not kept, the first of them here: 5 f, 2 usemtl".
  std::string sentence() const {
    std::string text = first_->place() + ": " + std::to_string(total_) +
                       (total_ == 1 ? " statement is" : " statements are") + " not kept, the first here: ";
    std::size_t named = 0;
    for (const auto& [name, count] : counts_) {
      text += (named > 0 ? ", " : "") + std::to_string(count) + " " + std::string(name.substr(0, 20));
      named += count;
    }
    return named < total_ ? text + ", " + std::to_string(total_ - named) + " others" : text;
  }

 private:
  static constexpr std::size_t max_names = 16;
  std::optional<TextCursor> first_;
  std::vector<std::pair<std::string_view, std::size_t>> counts_;
  std::size_t total_ = 0;
};

}}  // namespace tessera::abi_0_1
