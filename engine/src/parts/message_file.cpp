#include "parts/message_file.h"
#include "io/file/output_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string>
#include <string_view>

#include "base/text.h"
#include "io/file/descriptor.h"
#include "io/file/file.h"
#include "parts/checksum.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

namespace fs = std::filesystem;

constexpr std::array<char, 8> magic{'T', 'S', 'R', 'M', 'S', 'G', '1', '\n'};

struct MessageFileHead {
  std::array<char, 8> format = magic;
  MessageFileKey key;
  std::uint64_t listed = 0;     ///< entries that follow
  std::uint64_t list_hash = 0;  ///< of these
  bool operator==(const MessageFileHead&) const = default;
};

struct MessageEntry {
  std::uint64_t to = 0;
  std::uint64_t begin = 0, size = 0;  ///< bytes of the file
  std::uint64_t hash = 0;             ///< of the message
  bool operator==(const MessageEntry&) const = default;
};

struct MessageList {
  MessageFileHead head;
  std::vector<MessageEntry> entries;  ///< by `to`
  bool operator==(const MessageList&) const = default;

  std::uint64_t end() const {
    const std::size_t list_end = sizeof(MessageFileHead) + entries.size() * sizeof(MessageEntry);
    return entries.empty() ? list_end : entries.back().begin + entries.back().size;
  }
};

MessageList list_of(const MessageFileKey& key, std::span<const Message> messages) {
  MessageList list{{.key = key}, {}};
  for (std::size_t to = 0; to < messages.size(); ++to)
    if (!messages[to].empty()) list.entries.push_back({to, 0, messages[to].size(), checksum(messages[to])});
  std::uint64_t place = sizeof(MessageFileHead) + list.entries.size() * sizeof(MessageEntry);
  for (MessageEntry& entry : list.entries) entry.begin = std::exchange(place, place + entry.size);
  list.head.listed = list.entries.size();
  list.head.list_hash = checksum(std::as_bytes(std::span(list.entries)));
  return list;
}

/// A file that is read at places.
class PlacedReads {
 public:
  explicit PlacedReads(const fs::path& path) : path_(path), file_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    error_ = file_.is_open() ? 0 : errno;
    struct stat facts {};
    if (error_ == 0 && ::fstat(file_.number(), &facts) != 0) error_ = errno;
    size_ = static_cast<std::uint64_t>(facts.st_size);
  }

  int open_error() const { return error_; }
  std::uint64_t size() const { return size_; }
  Status damaged(std::string_view why) const {
    return Status(StatusCode::parse_error, path_.string() + ": is damaged: " + std::string(why));
  }

  /// Fills `bytes` from `place` on. Errors: io_error, parse_error (the file ends before).
  Status read(std::uint64_t place, std::span<std::byte> bytes) const {
    if (bytes.size() > size_ || place > size_ - bytes.size()) return damaged("it is cut off");
    while (!bytes.empty()) {
      const ssize_t got = ::pread(file_.number(), bytes.data(), bytes.size(), static_cast<off_t>(place));
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) return io_failure(path_, "cannot be read", errno);
      if (got == 0) return damaged("it is cut off");
      bytes = bytes.subspan(static_cast<std::size_t>(got));
      place += static_cast<std::uint64_t>(got);
    }
    return {};
  }

 private:
  const fs::path& path_;
  Descriptor file_;
  int error_ = 0;
  std::uint64_t size_ = 0;
};

Result<MessageList> read_list(const PlacedReads& file, const MessageFileKey& key, const fs::path& path) {
  MessageList list;
  if (Status status = file.read(0, std::as_writable_bytes(std::span(&list.head, 1))); !status.ok()) return status;
  if (list.head.format != magic) return file.damaged("it does not begin as messages of a part do");
  if (list.head.key != key)
    return Status(StatusCode::parse_error, path.string() +
                                               ": is not of this run, which calls something else here, has another "
                                               "input or other options. Empty the folder, or name another one");
  if (list.head.listed > key.parts) return file.damaged("it lists " + counted(list.head.listed, "message"));
  list.entries.resize(list.head.listed);
  if (Status status = file.read(sizeof(MessageFileHead), std::as_writable_bytes(std::span(list.entries))); !status.ok())
    return status;
  if (checksum(std::as_bytes(std::span(list.entries))) != list.head.list_hash)
    return file.damaged("its list of messages has another checksum");
  if (file.size() != list.end()) return file.damaged("it has " + counted(file.size(), "byte"));
  return list;
}

}  // namespace

Status write_messages(const fs::path& path, const MessageFileKey& key, std::span<const Message> messages) {
  const MessageList own = list_of(key, messages);
  if (const PlacedReads there(path); there.open_error() == 0) {
    const Result<MessageList> list = read_list(there, key, path);
    if (!list) return list.status();
    if (*list == own) return {};
    return Status(StatusCode::parse_error, path.string() +
                                               ": holds other messages than this part sends: the input or the program "
                                               "has changed. Empty the folder and start all parts again");
  }
  Result<OutputFile> file = OutputFile::make(path);
  if (!file) return file.status();
  const auto write = [&](std::span<const std::byte> bytes) {
    file->write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  };
  write(std::as_bytes(std::span(&own.head, 1)));
  write(std::as_bytes(std::span(own.entries)));
  for (const Message& message : messages) write(message);
  return file->commit();
}

Result<std::optional<Message>> read_message(const fs::path& path, const MessageFileKey& key, std::size_t to) {
  const PlacedReads file(path);
  if (file.open_error() == ENOENT) return std::optional<Message>();
  if (file.open_error() != 0) return io_failure(path, "cannot be opened", file.open_error());
  const Result<MessageList> list = read_list(file, key, path);
  if (!list) return list.status();
  const auto entry = std::ranges::find(list->entries, key.shared == 1 ? 0 : to, &MessageEntry::to);
  Message message;
  if (entry == list->entries.end()) return std::optional(std::move(message));
  if (entry->begin > file.size() || entry->size > file.size()) return file.damaged("it is cut off");
  message.resize(entry->size);
  if (Status status = file.read(entry->begin, message); !status.ok()) return status;
  if (checksum(message) != entry->hash)
    return file.damaged("the message for part " + std::to_string(to) + " has another checksum");
  return std::optional(std::move(message));
}

}}  // namespace tessera::abi_0_1
