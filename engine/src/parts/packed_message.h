#pragma once
// Messages as lists of values, byte by byte.

#include <cstddef>
#include <cstring>
#include <vector>

#include "tessera/transport.h"

namespace tessera { inline namespace abi_0_1 {

template <class T>
void append(Message& message, const T& value) {
  const std::size_t at = message.size();
  message.resize(at + sizeof(T));
  std::memcpy(message.data() + at, &value, sizeof(T));
}

template <class T>
std::size_t count_in(const Message& message) {
  return message.size() / sizeof(T);
}

template <class T>
T element(const Message& message, std::size_t k) {
  T value;
  std::memcpy(&value, message.data() + k * sizeof(T), sizeof(T));
  return value;
}

template <class T>
std::vector<T> read_all(const Message& message) {
  std::vector<T> values(message.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), message.data(), values.size() * sizeof(T));
  return values;
}

}}  // namespace tessera::abi_0_1
