#pragma once
// The version of these headers, and that of the library that runs.

#include <string_view>

/// Version of these headers. The minor version grows with each change of the interface while the major one is 0.
#define TESSERA_VERSION_MAJOR 0
#define TESSERA_VERSION_MINOR 1
#define TESSERA_VERSION_PATCH 0
#define TESSERA_VERSION "0.1.0"

// Everything public stands in an inline namespace named after the binary interface, abi_MAJOR_MINOR: a program that was
// compiled with other headers than its library's does not link.

#pragma GCC visibility push(default)
namespace tessera::inline abi_0_1 {

/// Version of the library that runs, such as "0.1.0". Threads: any.
std::string_view version();

}  // namespace tessera::inline abi_0_1
#pragma GCC visibility pop
