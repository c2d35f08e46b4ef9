#include "io/file/base64.h"

#include <array>
#include <cstdint>

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// The value of each character, 64 for those beyond the alphabet.
constexpr std::array<std::uint8_t, 256> values = [] {
  std::array<std::uint8_t, 256> out{};
  out.fill(64);
  for (std::size_t k = 0; k < alphabet.size(); ++k) out[static_cast<unsigned char>(alphabet[k])] = std::uint8_t(k);
  return out;
}();

void append_group(std::string& text, const unsigned char* group) {
  const std::uint32_t bits = std::uint32_t{group[0]} << 16 | std::uint32_t{group[1]} << 8 | group[2];
  for (const int shift : {18, 12, 6, 0}) text += alphabet[bits >> shift & 63];
}

}  // namespace

std::string Base64Encoder::encode(std::string_view bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (const char byte : bytes) {
    rest_[rest_size_++] = static_cast<unsigned char>(byte);
    if (rest_size_ < 3) continue;
    append_group(text, rest_);
    rest_size_ = 0;
  }
  return text;
}

std::string Base64Encoder::finish() {
  std::string text;
  if (rest_size_ == 0) return text;
  for (std::size_t k = rest_size_; k < 3; ++k) rest_[k] = 0;
  append_group(text, rest_);
  text.replace(1 + rest_size_, std::string::npos, 3 - rest_size_, '=');
  rest_size_ = 0;
  return text;
}

std::optional<std::string> base64_decoded(std::string_view text) {
  if (text.size() % 4 == 0)
    for (int k = 0; k < 2 && text.ends_with('='); ++k) text.remove_suffix(1);
  if (text.size() % 4 == 1) return std::nullopt;
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const std::uint8_t value = values[static_cast<unsigned char>(c)];
    if (value == 64) return std::nullopt;
    bits = bits << 6 | value, count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xFF);
  }
  return bytes;
}

}}  // namespace tessera::abi_0_1
