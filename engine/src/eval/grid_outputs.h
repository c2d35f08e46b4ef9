#pragma once
// The outputs of a grid by name: where each stands in the caller's views and blocks, and in a kernel's job.

#include <cstdint>
#include <span>

#include "kernel/isa/kernel_table.h"
#include "tessera/evaluate.h"

namespace tessera::inline abi_0_1 {

/// An output of `width` values a sample. `order` is that of the derivatives which it is made of.
template <class T, class View, class Value>
struct GridOutput {
  const char* name;
  int order;
  bool GridOutputs::*wanted;
  View GridViews<T>::*view;
  std::span<Value> GridBlocks<T>::*memory;
};

template <class T>
struct VectorOutput : GridOutput<T, View3<T>, T> {
  static constexpr int width = 3;
  T* kernel::GridJob<T>::*job;
};
template <class T>
struct ScalarOutput : GridOutput<T, View1<T>, T> {
  static constexpr int width = 1;
  T* kernel::GridJob<T>::*job;
};
template <class T, class Kind>
struct KindOutput : GridOutput<T, View1<Kind>, Kind> {
  static constexpr int width = 1;
  std::uint8_t* kernel::GridJob<T>::*job;
};

// The five structures name an output alike.
#define TESSERA_OUTPUT(name, order) \
  {#name, order, &GridOutputs::name, &GridViews<T>::name, &GridBlocks<T>::name}, &kernel::GridJob<T>::name
template <class T>
inline constexpr VectorOutput<T> vector_outputs[] = {{TESSERA_OUTPUT(position, 0)},
                                                     {TESSERA_OUTPUT(du, 1)},
                                                     {TESSERA_OUTPUT(dv, 1)},
                                                     {TESSERA_OUTPUT(normal, 1)},
                                                     {TESSERA_OUTPUT(duu, 2)},
                                                     {TESSERA_OUTPUT(duv, 2)},
                                                     {TESSERA_OUTPUT(dvv, 2)},
                                                     {TESSERA_OUTPUT(first_form, 2)},
                                                     {TESSERA_OUTPUT(second_form, 2)},
                                                     {TESSERA_OUTPUT(first_direction, 2)},
                                                     {TESSERA_OUTPUT(second_direction, 2)}};
template <class T>
inline constexpr ScalarOutput<T> scalar_outputs[] = {{TESSERA_OUTPUT(gaussian, 2)},
                                                     {TESSERA_OUTPUT(mean, 2)},
                                                     {TESSERA_OUTPUT(first_curvature, 2)},
                                                     {TESSERA_OUTPUT(second_curvature, 2)}};
template <class T>
inline constexpr KindOutput<T, NormalKind> normal_kind_output = {TESSERA_OUTPUT(normal_kind, 1)};
template <class T>
inline constexpr KindOutput<T, CurvatureKind> curvature_kind_output = {TESSERA_OUTPUT(curvature_kind, 2)};
#undef TESSERA_OUTPUT

/// Calls f(output) for each of them, floats and doubles first.
template <class T, class F>
void for_each_value_output(F&& f) {
  for (const auto& output : vector_outputs<T>) f(output);
  for (const auto& output : scalar_outputs<T>) f(output);
}
template <class T, class F>
void for_each_kind_output(F&& f) {
  f(normal_kind_output<T>);
  f(curvature_kind_output<T>);
}
template <class T, class F>
void for_each_output(F&& f) {
  for_each_value_output<T>(f);
  for_each_kind_output<T>(f);
}

}  // namespace tessera::inline abi_0_1
