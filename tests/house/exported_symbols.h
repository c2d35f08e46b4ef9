#pragma once
// The shared libraries export what the public headers declare, and nothing else: what is exported by chance is used by
// chance, and can be taken for another library's function of the same name.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tessera::house {

/// Whether a demangled symbol is one that this text of a public header declares: a function or data of the namespace, or a
/// member of a class of it, by their names alone.
bool is_declared(std::string_view symbol, const std::string& header);

/// Whether an argument of a function is of a type that none of these public headers names, nor can its callers.
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
