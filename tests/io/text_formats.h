#pragma once
// The formats that are read, as one: what a reader makes of a text, in a form that can be compared and must be sound.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/status.h"

namespace tessera::test {

/// What a reader made of a text.
struct Reading {
  Status status = {};
  std::string content = {};  ///< equal for equal models and meshes, to the last bit; lines of warnings do not count
  std::size_t parts = 0;     ///< surfaces, or triangles
  std::string unsound = {};  ///< what is wrong with what was read: a position that is not finite, an index out of range

  bool ok() const { return status.ok(); }
};

struct TextFormat {
  std::string name;       ///< its folder of tests/corpus
  std::string extension;  ///< with the dot
  Reading (*parse)(std::string_view text, std::string_view name);
  Reading (*open)(const std::filesystem::path& path);

  /// The small files of tests/corpus.
  std::vector<std::string> samples() const;
};

/// Every reader of surfaces and of meshes.
const std::vector<TextFormat>& text_formats();

/// Peculiar to some formats: whether a text is no text; characters between which blanks are a part of a string.
bool is_binary(const std::string& sample);
/// The text with each blank outside of strings replaced by `blank`.
std::string with_blanks(const TextFormat& format, const std::string& text, std::string_view blank);

}  // namespace tessera::test
