#pragma once
// Faults of a view that a call writes to.

#include <limits>
#include <string>
#include <type_traits>

#include "robustness/bad_input.h"
#include "tessera/strided_view.h"

namespace tessera::test {

template <class T, int N>
void misalign(VectorView<T, N>& view) {
  using Byte = std::conditional_t<std::is_const_v<T>, const char, char>;
  for (T*& component : view.component) component = reinterpret_cast<T*>(reinterpret_cast<Byte*>(component) + 1);
}

/// `view_of(views)` is one view of `views`, which must hold `records`; `refused(input, code, views)` makes the call.
template <class Views, class ViewOf, class Refused>
void bad_view(const std::string& name, const Views& sound, std::size_t records, ViewOf view_of, Refused refused) {
  const auto with = [&](const std::string& what, StatusCode code, auto change) {
    Views views = sound;
    change(view_of(views));
    refused(name + " " + what, code, views);
  };
  using enum StatusCode;
  with("short by one record", buffer_too_small, [&](auto& view) { view.size = records - 1; });
  with("with a component that is null", invalid_argument, [](auto& view) { view.component.back() = nullptr; });
  with("with stride 0", invalid_argument, [](auto& view) { view.stride = 0; });
  with("with stride -3", invalid_argument, [](auto& view) { view.stride = -3; });
  with("with the largest stride", invalid_argument,
       [](auto& view) { view.stride = std::numeric_limits<std::ptrdiff_t>::max(); });
  with("misaligned", invalid_argument, [](auto& view) { misalign(view); });
  with("whose components overlap", invalid_argument, [](auto& view) { view.component[1] = view.component[0]; });
}

}  // namespace tessera::test
