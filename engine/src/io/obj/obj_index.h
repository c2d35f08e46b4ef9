#pragma once
// How OBJ files refer to earlier records: from 1 onwards, or from -1 backwards.

#include <cstdint>
#include <string>
#include <string_view>

#include "io/file/text_cursor.h"

namespace tessera { inline namespace abi_0_1 {

/// The error for a number that is not an index into the `count` records (`kind`: "vertices") before it.
inline Status obj_index_failure(const TextCursor& before, std::string_view kind, std::size_t count) {
  const std::string last = std::to_string(count), above = std::string(kind) + " above";
  if (count == 0) return before.expected("no index, as there are no " + above);
  return before.expected("an index into the " + above + ", 1 to " + last + " or -" + last + " to -1");
}

/// Reads an index into `count` records, at most 2^32, and makes it count from 0. `what` names it in messages: "an index
/// of a corner".
inline Status read_obj_index(TextCursor& cursor, std::string_view what, std::string_view kind, std::size_t count,
                             std::uint32_t& index) {
  const TextCursor before = cursor;
  std::int64_t number = 0;
  if (!cursor.take_number(number)) return before.expected(what);
  const auto size = static_cast<std::int64_t>(count);
  if (number == 0 || number > size || number < -size) return obj_index_failure(before, kind, count);
  index = static_cast<std::uint32_t>(number > 0 ? number - 1 : size + number);
  return {};
}

}}  // namespace tessera::abi_0_1
