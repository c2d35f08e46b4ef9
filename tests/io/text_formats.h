#pragma once
// The formats that are read, behind one interface: the result of a reader in a form that can be compared and checked.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/status.h"

namespace tessera::test {

/// The result of a reader.
struct Reading {
  Status status = {};
  std::string content = {};  ///< equal for models and meshes equal to the last bit; lines in warnings do not count
  std::size_t parts = 0;     ///< surfaces, or triangles
  std::string unsound = {};  ///< the fault of the result, if any: a position that is not finite, an index out of range

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

/// Special to some formats: whether the text is binary; characters between which blanks belong to a string.
bool is_binary(const std::string& sample);
/// The text with each blank outside of strings replaced by `blank`.
std::string with_blanks(const TextFormat& format, const std::string& text, std::string_view blank);

}  // namespace tessera::test
