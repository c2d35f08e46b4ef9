#pragma once
// Bytes as text, by the alphabet of RFC 4648, section 4.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace tessera { inline namespace abi_0_1 {

/// Encodes bytes that come piece by piece.
class Base64Encoder {
 public:
  /// Returns the text of all whole groups of three bytes so far that were not returned yet.
  std::string encode(std::string_view bytes);
  /// Returns the text of the last bytes, padded with '='. The encoder can begin anew.
  std::string finish();

 private:
  unsigned char rest_[3] = {};
  std::size_t rest_size_ = 0;  ///< 0 to 2
};

/// Decodes a text, with or without its padding. Returns nothing if it is malformed.
std::optional<std::string> base64_decoded(std::string_view text);

}}  // namespace tessera::abi_0_1
