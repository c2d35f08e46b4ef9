// CMake passes the facts that the compiler does not know: TESSERA_VERSION, TESSERA_BUILD_TYPE, TESSERA_BUILD_FLAGS,
// TESSERA_EMBREE_VERSION, TESSERA_XSIMD_VERSION, TESSERA_PLANTED_SLOWDOWN.

#include "facts.h"

#include <gnu/libc-version.h>
#include <tbb/version.h>

#include "tessera/execution.h"

namespace tessera::bench {
namespace {

/// Quotes plain text: escapes only quotes and backslashes.
std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

std::string pair(std::string_view key, std::string_view value) { return quoted(key) + ": " + quoted(value); }

#ifdef __clang__
constexpr const char* compiler = "clang " __clang_version__;
#else
constexpr const char* compiler = "gcc " __VERSION__;
#endif

}  // namespace

std::string build_facts() {
  std::string isas;
  for (const Isa isa : available_isas()) isas += (isas.empty() ? "" : ", ") + quoted(name(isa));
  const Result<Isa> fastest = default_isa();
  return "{" + pair("version", TESSERA_VERSION) + ", " + pair("compiler", compiler) + ",\n " +
         pair("build_type", TESSERA_BUILD_TYPE) + ", " + pair("flags", TESSERA_BUILD_FLAGS) + ",\n \"isas\": [" + isas +
         "], " + pair("isa", fastest ? name(*fastest) : "none") +
         ", \"planted_slowdown\": " + std::to_string(TESSERA_PLANTED_SLOWDOWN) + ",\n \"libraries\": {" +
         pair("glibc", gnu_get_libc_version()) + ", " + pair("libstdc++", std::to_string(__GLIBCXX__)) + ", " +
         pair("oneTBB", TBB_runtime_version()) + ", " + pair("xsimd", TESSERA_XSIMD_VERSION) + ", " +
         pair("Embree", TESSERA_EMBREE_VERSION) + "}}\n";
}

}  // namespace tessera::bench
