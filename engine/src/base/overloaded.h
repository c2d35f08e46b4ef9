#pragma once
// One callable of several lambdas, to visit variants with.

namespace tessera {

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};

}  // namespace tessera
