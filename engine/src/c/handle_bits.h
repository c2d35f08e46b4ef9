#pragma once
// The bits of a handle: the place of its object in the table, and above it the count of the objects that were there
// before.

#include <cstdint>
#include <limits>

namespace tessera { inline namespace abi_0_1 {

/// `Word`: the unsigned integer of a pointer's size. Where it has 32 bits, the count of a place begins anew after 4096
/// objects. A stale handle is taken for a live one only if it is 4096 objects old, because places are reused in the
/// order of their release.
template <class Word>
struct HandleBits {
  static constexpr int place_bits = std::numeric_limits<Word>::digits == 64 ? 32 : 20;
  static constexpr int round_bits = std::numeric_limits<Word>::digits - place_bits;
  static constexpr std::uint32_t place_mask = static_cast<std::uint32_t>((std::uint64_t{1} << place_bits) - 1);
  static constexpr std::uint32_t round_mask = static_cast<std::uint32_t>((std::uint64_t{1} << round_bits) - 1);

  static constexpr Word packed(std::uint32_t place, std::uint32_t round) {
    return static_cast<Word>(static_cast<Word>(round & round_mask) << place_bits | place);
  }
  static constexpr std::uint32_t place(Word handle) { return static_cast<std::uint32_t>(handle) & place_mask; }
  /// Whether the handle is of an object with this count.
  static constexpr bool is_of_round(Word handle, std::uint32_t round) {
    return handle >> place_bits == (round & round_mask);
  }
};

}}  // namespace tessera::abi_0_1
