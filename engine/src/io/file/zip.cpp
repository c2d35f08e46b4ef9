#include "io/file/zip.h"

#include <cstddef>
#include <cstdint>

#include "base/text.h"
#include "io/file/gzip.h"

#define ZLIB_CONST  // its pointers point to const
#include <zlib.h>

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t end_size = 22, entry_size = 46, head_size = 30;  // of the records, without names and comments
constexpr std::uint32_t in_zip64 = 0xffffffff;                         // a number that stands elsewhere

/// An archive, whose numbers are little-endian and lie within it wherever number() is called.
class ZipArchive {
 public:
  ZipArchive(std::string_view bytes, std::string_view name) : bytes_(bytes), name_(name) {}

  Result<std::string> only_file() const {
    const std::size_t end = find_end();
    if (end == std::string_view::npos) return damaged("has no end; it may be cut");
    const std::size_t entries = number(end + 10, 2);
    std::size_t at = number(end + 16, 4), files = 0, only = 0;
    if (entries == 0xffff || at == in_zip64) return other("is of the kind Zip64");
    for (std::size_t k = 0; k < entries; ++k) {
      if (!holds(at, entry_size) || bytes_.substr(at, 4) != "PK\1\2") return damaged("has a damaged directory");
      const std::size_t size = number(at + 28, 2);
      if (!holds(at + entry_size, size)) return damaged("has a damaged directory");
      const bool is_folder = bytes_.substr(at + entry_size, size).ends_with('/');
      if (!is_folder && files++ == 0) only = at;
      at += entry_size + size + number(at + 30, 2) + number(at + 32, 2);
    }
    if (files == 0) return damaged("holds no file");
    if (files > 1) return other("holds " + std::to_string(files) + " files, it must hold one");
    return content(only);
  }

 private:
  bool holds(std::size_t at, std::size_t size) const { return at <= bytes_.size() && size <= bytes_.size() - at; }
  std::uint32_t number(std::size_t at, std::size_t size) const {
    std::uint32_t value = 0;
    for (std::size_t k = size; k-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes_[at + k]);
    return value;
  }

  /// Finds the record at the end, whose comment ends with the archive.
  std::size_t find_end() const {
    constexpr std::size_t max_comment = 0xffff;
    for (std::size_t comment = 0; comment <= max_comment && holds(0, end_size + comment); ++comment) {
      const std::size_t at = bytes_.size() - comment - end_size;
      if (bytes_.substr(at, 4) == "PK\5\6" && number(at + 20, 2) == comment) return at;
    }
    return std::string_view::npos;
  }

  /// Unpacks the file of an entry of the directory.
  Result<std::string> content(std::size_t entry) const {
    const std::uint32_t method = number(entry + 10, 2), packed = number(entry + 20, 4), size = number(entry + 24, 4);
    const std::size_t head = number(entry + 42, 4);
    if ((number(entry + 8, 2) & 1) != 0) return other("is encrypted");
    if (method != 0 && method != 8) return other("uses compression " + std::to_string(method));
    if (packed == in_zip64 || size == in_zip64 || head == in_zip64) return other("is of the kind Zip64");
    if (!holds(head, head_size) || bytes_.substr(head, 4) != "PK\3\4") return damaged("has a damaged header");
    const std::size_t begin = head + head_size + number(head + 26, 2) + number(head + 28, 2);
    if (!holds(begin, packed)) return damaged("ends within its file");
    const std::string_view data = bytes_.substr(begin, packed);
    Result<std::string> text = method == 8 ? unpack_deflated(data, name_) : Result<std::string>(std::string(data));
    if (!text) return text;
    if (text->empty()) return Status(StatusCode::parse_error, std::string(name_) + ": the file is empty");
    const uLong sum = crc32_z(0, reinterpret_cast<const Bytef*>(text->data()), text->size());
    if (text->size() != size || sum != number(entry + 16, 4)) return damaged("does not hold what its directory states");
    return text;
  }

  Status damaged(const std::string& what) const {
    return Status(StatusCode::parse_error, std::string(name_) + ": the zip archive " + what);
  }
  Status other(const std::string& what) const {
    return Status(StatusCode::unsupported,
                  std::string(name_) + ": the zip archive " + what + "; unpack it first (unzip)");
  }

  std::string_view bytes_, name_;
};

}  // namespace

Result<std::string> unpack_zip(std::string_view bytes, std::string_view name) {
  return ZipArchive(bytes, name).only_file();
}

}}  // namespace tessera::abi_0_1
