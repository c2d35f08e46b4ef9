#pragma once
// Objects of OpenCASCADE as what they are.

#include <opencascade/Standard_Handle.hxx>
#include <opencascade/Standard_Type.hxx>

namespace tessera { inline namespace abi_0_1 {

/// Returns an object as a T, or null if it is none: handle<T>::DownCast() without the names of types that dynamic_cast
/// compares, which takes longer than most calls here.
template <class T, class Base>
T* kind_of(const opencascade::handle<Base>& object) {
  return !object.IsNull() && object->IsKind(STANDARD_TYPE(T)) ? static_cast<T*>(object.get()) : nullptr;
}

}}  // namespace tessera::abi_0_1
