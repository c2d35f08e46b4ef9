// Unpacks by zlib.

#define ZLIB_CONST  // next_in points to const
#include <zlib.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "base/text.h"
#include "io/file/gzip.h"
#include "io/file/text_cursor.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

struct Wrapping {
  int window_bits;   ///< as inflateInit2() takes them, for windows of any size
  const char* what;  ///< in messages
  bool has_members;  ///< further ones may follow
};
constexpr Wrapping gzip_members{15 + 16, "the gzip data", true}, bare_stream{-15, "the deflated data", false};

/// Runs zlib over all members of a file. Either counts the bytes, through a small window, or writes them.
class Unpacker {
 public:
  Unpacker(std::string_view bytes, std::string_view name, const Wrapping& wrapping)
      : bytes_(bytes), name_(name), wrapping_(wrapping) {}

  /// Returns the number of unpacked bytes, `limit` at the most.
  Result<std::size_t> count(std::size_t limit) {
    constexpr std::size_t window_bytes = std::size_t{1} << 16;
    const auto window = std::make_unique<char[]>(window_bytes);
    return run([&](std::size_t) { return Room{window.get(), window_bytes}; }, limit);
  }
  Result<std::size_t> write(std::string& to) {
    return run([&](std::size_t done) { return Room{to.data() + done, to.size() - done}; }, to.size());
  }

 private:
  struct Room {
    char* at;
    std::size_t bytes;
  };
  /// Ends zlib's stream.
  struct Stream : z_stream {
    Stream() : z_stream{} {}
    Stream(const Stream&) = delete;
    Stream& operator=(const Stream&) = delete;
    ~Stream() { inflateEnd(this); }
  };

  Status error(const std::string& sentence, StatusCode code = StatusCode::parse_error) const {
    return Status(code, std::string(name_) + ": " + sentence);
  }

  template <class RoomAt>
  Result<std::size_t> run(const RoomAt& room_at, std::size_t limit) {
    Stream stream;
    if (inflateInit2(&stream, wrapping_.window_bits) != Z_OK)
      return Status(StatusCode::out_of_memory, std::string(name_) + ": no memory for zlib");
    std::size_t taken = 0, done = 0;
    for (bool ended = false; !ended || taken < bytes_.size();) {
      if (ended && !(wrapping_.has_members && begins_as_gzip(bytes_.substr(taken))))
        return error(counted(bytes_.size() - taken, "byte") + " follow the end of " + wrapping_.what);
      if (ended) inflateReset(&stream);
      const Room room = room_at(done);
      const std::size_t in = taken;
      const std::size_t out = done;
      const int result = step(stream, room, taken, done);
      if (done > limit) return too_large(limit);
      ended = result == Z_STREAM_END;
      if (result == Z_MEM_ERROR) return Status(StatusCode::out_of_memory, std::string(name_) + ": no memory for zlib");
      if (result != Z_OK && result != Z_BUF_ERROR && !ended)
        return error(std::string(wrapping_.what) + " is damaged near byte " + std::to_string(taken) + " of " +
                     std::to_string(bytes_.size()) + (stream.msg ? ": " + std::string(stream.msg) : ""));
      if (!ended && taken == bytes_.size() && (in == taken && out == done))
        return error("the file ends within " + std::string(wrapping_.what) + ", after " +
                     counted(bytes_.size(), "byte"));
    }
    return done;
  }

  /// One call of zlib, which counts in 32 bits.
  int step(Stream& stream, const Room& room, std::size_t& taken, std::size_t& done) const {
    constexpr std::size_t most = std::numeric_limits<uInt>::max();
    unsigned char spare = 0;  // zlib wants room even to see the end
    const std::size_t in = std::min(bytes_.size() - taken, most);
    const std::size_t out = std::max<std::size_t>(1, std::min(room.bytes, most));
    stream.next_in = reinterpret_cast<const Bytef*>(bytes_.data() + taken);
    stream.avail_in = static_cast<uInt>(in);
    stream.next_out = room.bytes == 0 ? &spare : reinterpret_cast<Bytef*>(room.at);
    stream.avail_out = static_cast<uInt>(out);
    const int result = inflate(&stream, Z_NO_FLUSH);
    taken += in - stream.avail_in;
    done += out - stream.avail_out;
    return result;
  }

  Status too_large(std::size_t limit) const {
    return error("unpacks to more than " + std::to_string(limit) + " bytes; the limit is " +
                     std::to_string(gzip_ratio) +
                     " times the packed file and 1 MiB, and 1 GiB at the most; unpack it "
                     "first (gunzip) if you trust it",
                 StatusCode::unsupported);
  }

  std::string_view bytes_, name_;
  Wrapping wrapping_;
};

Result<std::string> unpack(std::string_view bytes, std::string_view name, const Wrapping& wrapping) {
  const std::size_t limit = bytes.size() > gzip_limit / gzip_ratio
                                ? gzip_limit
                                : std::min(gzip_limit, gzip_ratio * bytes.size() + gzip_slack);
  const Result<std::size_t> size = Unpacker(bytes, name, wrapping).count(limit);
  if (!size) return size.status();
  if (*size == 0) return Status(StatusCode::parse_error, std::string(name) + ": the file is empty");
  std::string text(*size, '\0');
  const Result<std::size_t> written = Unpacker(bytes, name, wrapping).write(text);
  if (!written) return written.status();
  return text;
}

}  // namespace

Result<std::string> unpack_gzip(std::string_view bytes, std::string_view name) {
  if (!begins_as_gzip(bytes))
    return Status(StatusCode::parse_error, std::string(name) + ": expected gzip data, found " +
                                               quote(bytes.substr(0, 8)) +
                                               "; remove .gz from the name if the file is not packed");
  return unpack(bytes, name, gzip_members);
}

Result<std::string> unpack_deflated(std::string_view bytes, std::string_view name) {
  return unpack(bytes, name, bare_stream);
}

}}  // namespace tessera::abi_0_1
