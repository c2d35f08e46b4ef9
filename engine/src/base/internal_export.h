#pragma once
// The few functions inside the core that the libraries above it, of rays and of files, call too: a shared core exports them
// beside what is public, and tests/house/exported_symbols.cpp lists
// them. They are nobody else's.

#define TESSERA_INTERNAL_EXPORT [[gnu::visibility("default")]]
