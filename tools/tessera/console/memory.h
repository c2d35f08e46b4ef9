#pragma once
// Sizes of memory: what is free, and how sizes are written.

#include <cstdint>
#include <string>

namespace tessera::cli {

/// Bytes that this process can still take without swapping: the system's estimate (MemAvailable of Linux), or less if a
/// control group limits it. The largest number if neither is known.
std::uint64_t available_memory();

/// "12.3 MB", with units of powers of 1000.
std::string readable_bytes(std::uintmax_t bytes);

/// Parses "800M", "12G" or a number of bytes; K, M, G and T are powers of 1024. Throws UsageError.
std::uint64_t parse_bytes(const std::string& option, const std::string& text);

}  // namespace tessera::cli
