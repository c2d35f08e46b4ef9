#pragma once
// A hash of bytes against damage and mistakes, not against forgers.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace tessera { inline namespace abi_0_1 {

inline std::uint64_t mixed(std::uint64_t h, std::uint64_t word) {
  return std::rotl((h ^ word) * 0x9E3779B97F4A7C15u, 29) * 0xBF58476D1CE4E5B9u;
}

/// Returns the hash of the bytes and their number, by multiplication and rotation, eight bytes at a time.
inline std::uint64_t checksum(std::span<const std::byte> bytes) {
  std::uint64_t h = bytes.size(), word = 0;
  std::size_t k = 0;
  for (; k + sizeof(word) <= bytes.size(); k += sizeof(word)) {
    std::memcpy(&word, bytes.data() + k, sizeof(word));
    h = mixed(h, word);
  }
  word = 0;
  if (k < bytes.size()) std::memcpy(&word, bytes.data() + k, bytes.size() - k);
  return mixed(mixed(h, word), 0);
}

}}  // namespace tessera::abi_0_1
