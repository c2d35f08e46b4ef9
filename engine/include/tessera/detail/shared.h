#pragma once
// Values that are often equal to their default, or equal in many objects: stored once, one pointer per object.

#include <concepts>
#include <memory>
#include <utility>

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// A constant T that copies share. The default value T{} takes no memory of its own. Converts to T; its members are
/// reached by -> and *.
template <class T>
class Shared {
 public:
  Shared() = default;
  template <class U>
  // NOLINTNEXTLINE(bugprone-forwarding-reference-overload): the constraint lets copies be copies
  requires(std::convertible_to<U&&, T> && !std::same_as<std::remove_cvref_t<U>, Shared>) Shared(U&& value) {
    T own(std::forward<U>(value));
    if (!is_default(own)) value_ = std::make_shared<const T>(std::move(own));
  }

  const T& operator*() const { return value_ ? *value_ : default_value(); }
  const T* operator->() const { return &**this; }
  operator const T&() const { return **this; }

  friend bool operator==(const Shared& a, const Shared& b) { return a.value_ == b.value_ || *a == *b; }
  template <class U>
  requires(!std::same_as<U, Shared> && requires(const T& a, const U& b) { a == b; }) friend bool operator==(
      const Shared& a, const U& b) {
    return *a == b;
  }

 private:
  static const T& default_value() {
    static const T value{};
    return value;
  }
  static bool is_default(const T& value) {
    if constexpr (requires { value.empty(); })
      return value.empty();
    else
      return value == T{};
  }

  std::shared_ptr<const T> value_;
};

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
