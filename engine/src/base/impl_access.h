#pragma once
// The way from a public object to what is inside it, for the library's own files.

#include <type_traits>

namespace tessera::inline abi_0_1 {

/// A friend of every public class that keeps its inside in `impl_`.
struct ImplAccess {
  template <class T>
  static auto& of(T& object) {
    return *object.impl_;
  }
};

/// The inside of a public object; const where the object is.
template <class T>
std::conditional_t<std::is_const_v<T>, const typename T::Impl, typename T::Impl>& impl_of(T& object) {
  return ImplAccess::of(object);
}

}  // namespace tessera::inline abi_0_1
