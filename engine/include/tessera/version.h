#pragma once
// Version of the headers, and of the library at run time.

#include <string_view>

/// Version of these headers. While the major version is 0, each change of the interface raises the minor version.
#define TESSERA_VERSION_MAJOR 0
#define TESSERA_VERSION_MINOR 1  ///< grows with each change of the interface
#define TESSERA_VERSION_PATCH 0  ///< grows with each other change
#define TESSERA_VERSION "0.1.0"  ///< all three, as text
/// The version as one number for comparisons: 10000 * major + 100 * minor + patch.
#define TESSERA_VERSION_NUMBER (TESSERA_VERSION_MAJOR * 10000 + TESSERA_VERSION_MINOR * 100 + TESSERA_VERSION_PATCH)

// The public interface is in an inline namespace named after the binary interface, abi_MAJOR_MINOR, so that a program
// compiled with the headers of another interface does not link.

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// Returns the version of the library at run time, such as "0.1.0". Threads: any.
std::string_view version();

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
