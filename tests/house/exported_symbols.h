#pragma once
// Checks that the shared libraries export the declarations of the public headers, and nothing else: an accidental
// export may be used by others, or be taken for another library's function of the same name.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::house {

/// Whether this text of a public header declares a demangled symbol: a function or data of the namespace, or a member
/// of a class of it, compared only by their names.
bool is_declared(std::string_view symbol, const std::string& header);

/// Whether an argument of a function has a type that no public header names, so that callers cannot name it either.
bool takes_inner_types(std::string_view symbol, const std::vector<std::string>& headers);

/// The functions inside the core that the libraries above it call (engine/src/base/internal_export.h).
bool is_internal_export(std::string_view symbol);

struct Symbol {
  char type = '?';  ///< as nm prints it: capitals are exported
  std::string name;
};

/// Functions and data of what `nm -C --defined-only` prints.
std::vector<Symbol> symbols_of(std::string_view listing);

}  // namespace tessera::house
