#pragma once
// A list whose first values need no memory of their own.

#include <array>
#include <cstddef>
#include <initializer_list>
#include <vector>

namespace tessera { inline namespace abi_0_1 {

/// A list of numbers or points: up to `room` of them in place, more on the heap. A list that was moved from may only be
/// assigned or destroyed.
template <class T, std::size_t room>
class ShortList {
 public:
  ShortList() = default;
  ShortList(std::initializer_list<T> values) {
    for (const T& value : values) push_back(value);
  }

  void push_back(const T& value) {
    if (size_ < room) {
      few_[size_++] = value;
      return;
    }
    if (size_ == room) many_.assign(few_.begin(), few_.end());
    many_.push_back(value);
    ++size_;
  }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T* begin() { return size_ <= room ? few_.data() : many_.data(); }
  T* end() { return begin() + size_; }
  const T* begin() const { return size_ <= room ? few_.data() : many_.data(); }
  const T* end() const { return begin() + size_; }
  T& operator[](std::size_t k) { return begin()[k]; }
  const T& operator[](std::size_t k) const { return begin()[k]; }
  T& front() { return *begin(); }
  const T& front() const { return *begin(); }
  T& back() { return end()[-1]; }
  const T& back() const { return end()[-1]; }

 private:
  std::array<T, room> few_{};
  std::vector<T> many_;  ///< all of them, if they are more than `room`
  std::size_t size_ = 0;
};

}}  // namespace tessera::abi_0_1
