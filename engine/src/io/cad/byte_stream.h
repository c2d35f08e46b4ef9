#pragma once
// Numbers and lists as bytes for another process on this machine.

#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

namespace tessera { inline namespace abi_0_1 {

class ByteWriter {
 public:
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void put(const T& value) { bytes_.append(reinterpret_cast<const char*>(&value), sizeof value); }
  void put(bool value) { put(std::uint8_t{value}); }
  void put_count(std::size_t count) { put(std::uint64_t{count}); }
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void put_list(std::span<const T> list) {
    put_count(list.size());
    bytes_.append(reinterpret_cast<const char*>(list.data()), list.size_bytes());
  }
  void put_text(std::string_view text) { put_list(std::span<const char>(text)); }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// Each call returns false if the bytes end too early, and then leaves its output unspecified.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : rest_(bytes) {}

  template <class T>
  requires std::is_trivially_copyable_v<T>
  bool take(T& value) {
    if (rest_.size() < sizeof value) return false;
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_.remove_prefix(sizeof value);
    return true;
  }
  bool take(bool& value) {
    std::uint8_t byte = 0;
    if (!take(byte) || byte > 1) return false;
    value = byte == 1;
    return true;
  }
  /// Reads a count of things that take at least `least` bytes each.
  bool take_count(std::size_t& count, std::size_t least) {
    std::uint64_t stated = 0;
    if (!take(stated) || stated > rest_.size() / least) return false;
    count = static_cast<std::size_t>(stated);
    return true;
  }
  template <class List>
  bool take_list(List& list) {
    using T = typename List::value_type;
    std::size_t count = 0;
    if (!take_count(count, sizeof(T))) return false;
    list.resize(count);
    if (count > 0) std::memcpy(list.data(), rest_.data(), count * sizeof(T));
    rest_.remove_prefix(count * sizeof(T));
    return true;
  }
  /// Reads things that take at least one byte each; take_one(list) appends one.
  template <class List, class TakeOne>
  bool take_each(List& list, TakeOne take_one) {
    std::size_t count = 0;
    if (!take_count(count, 1)) return false;
    for (std::size_t k = 0; k < count; ++k)
      if (!take_one(list)) return false;
    return true;
  }

 private:
  std::string_view rest_;
};

}}  // namespace tessera::abi_0_1
