#pragma once
// Counts what a reader skips, by kind, for the model's warnings.

#include <string>
#include <string_view>
#include <vector>

#include "io/file/text_cursor.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Names of a kind of thing, for one and for many: "polyhedron", "polyhedra". They must outlive the counts.
struct PartName {
  std::string_view one, many;
};

/// Counts of a few kinds, and where the first of each stood.
class PassedOver {
 public:
  /// `file` stands for the file in the sentences.
  explicit PassedOver(std::string_view file) : file_(file) {}

  void add(const PartName& name, const TextCursor& at);
  bool empty() const { return kinds_.empty(); }
  /// The warnings, such as "m.bv:12: 3 polyhedra are not read": one sentence per kind, in the order of their lines.
  std::vector<std::string> warnings() const;
  /// The error of a file that holds nothing else: "m.bv: no surface that can be read, but 3 polyhedra". Code:
  /// unsupported.
  Status nothing_else() const;

 private:
  struct Kind {
    PartName name;
    std::size_t count, line;
    std::string words() const { return std::to_string(count) + ' ' + std::string(count == 1 ? name.one : name.many); }
  };

  std::string_view file_;
  std::vector<Kind> kinds_;
};

/// The name of a surface from a file: at most 200 bytes of `text`, cut between characters of UTF-8.
std::string surface_name(std::string_view text);

}}  // namespace tessera::abi_0_1
