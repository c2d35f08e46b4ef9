#pragma once
// Makes one callable of several lambdas, to visit variants with.

namespace tessera { inline namespace abi_0_1 {

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;  // clang 14 does not deduce an aggregate's arguments

}}  // namespace tessera::abi_0_1
