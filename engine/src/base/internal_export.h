#pragma once
// Marks the few functions of a library that the libraries above it (rays, files, parts) also call. A shared library
// exports them beside the public ones; tests/house/exported_symbols.cpp lists them. No one else may call them.

#define TESSERA_INTERNAL_EXPORT [[gnu::visibility("default")]]

/// For explicit instantiations of public function templates: gcc forgets that the header exports them. In GNU's form,
/// which clang takes there too.
#define TESSERA_EXPORT __attribute__((visibility("default")))
