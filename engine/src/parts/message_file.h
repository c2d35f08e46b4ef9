#pragma once
// The file of one part's messages in one call: a head, the list of the messages that are not empty, their bytes.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "tessera/status.h"
#include "tessera/transport.h"

namespace tessera { inline namespace abi_0_1 {

/// The messages that a file holds. All numbers are in the machine's byte order.
struct MessageFileKey {
  std::uint64_t run = 0;     ///< the checksum of the run's text
  std::uint64_t parts = 0;   ///< how many there are
  std::uint64_t call = 0;    ///< counted from 0
  std::uint64_t from = 0;    ///< the part that sends
  std::uint64_t shared = 0;  ///< 1: one message for all parts
  bool operator==(const MessageFileKey&) const = default;
};

/// Writes messages[k], for part k, or the one shared message. Leaves a file alone that says the same already. Errors:
/// io_error, parse_error (another file of this name), out_of_memory.
Status write_messages(const std::filesystem::path& file, const MessageFileKey& key, std::span<const Message> messages);

/// Reads the message for part `to`; no value if there is no such file yet. Errors: io_error, parse_error (a damaged
/// file, or one of other messages), out_of_memory.
Result<std::optional<Message>> read_message(const std::filesystem::path& file, const MessageFileKey& key,
                                            std::size_t to);

}}  // namespace tessera::abi_0_1
