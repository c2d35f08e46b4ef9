#pragma once
// Access from a public object to its implementation, for the library's own files.

#include <type_traits>

namespace tessera { inline namespace abi_0_1 {

/// A friend of every public class that keeps its implementation in `impl_`.
struct ImplAccess {
  template <class T>
  static auto& of(T& object) {
    return *object.impl_;
  }
};

/// The implementation of a public object; const if the object is.
template <class T>
std::conditional_t<std::is_const_v<T>, const typename T::Impl, typename T::Impl>& impl_of(T& object) {
  return ImplAccess::of(object);
}

}}  // namespace tessera::abi_0_1
