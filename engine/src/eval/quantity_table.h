#pragma once
// The table of quantities: the name of each, its width, and the derivatives that it is made of.

#include <array>
#include <cstddef>
#include <type_traits>

#include "tessera/strided_view.h"

namespace tessera { inline namespace abi_0_1 {

/// How often each component is divided by the widths of its patch along u and v. It is then by the surface's
/// parameters.
struct ParameterPowers {
  std::array<int, 3> u{}, v{};
};

/// A row of the table. `Width` values per sample; made of derivatives up to `order`.
template <int Width, class Select>
struct Quantity {
  static constexpr int width = Width;
  const char* name;
  int order;
  ParameterPowers powers;
  Select select;

  /// Points to the quantity's member of a Quantities of any kind.
  template <class All>
  constexpr auto member() const {
    return select(std::type_identity<All>{});
  }
  /// The quantity's member of `all`.
  template <class All>
  constexpr auto& of(All& all) const {
    return all.*member<std::remove_const_t<All>>();
  }
};
template <int Width, class Select>
constexpr Quantity<Width, Select> quantity(const char* name, int order, const ParameterPowers& powers, Select select) {
  return {name, order, powers, select};
}

#define TESSERA_QUANTITY(member, width, order, ...) \
  f(quantity<width>(#member, order, {__VA_ARGS__}, []<class All>(std::type_identity<All>) { return &All::member; }))
/// Calls f(row) for each quantity of numbers, vectors first.
template <class F>
constexpr void for_each_value_quantity(F&& f) {
  TESSERA_QUANTITY(position, 3, 0);
  TESSERA_QUANTITY(du, 3, 1, {1, 1, 1}, {});
  TESSERA_QUANTITY(dv, 3, 1, {}, {1, 1, 1});
  TESSERA_QUANTITY(normal, 3, 1);
  TESSERA_QUANTITY(duu, 3, 2, {2, 2, 2}, {});
  TESSERA_QUANTITY(duv, 3, 2, {1, 1, 1}, {1, 1, 1});
  TESSERA_QUANTITY(dvv, 3, 2, {}, {2, 2, 2});
  TESSERA_QUANTITY(first_form, 3, 2, {2, 1, 0}, {0, 1, 2});
  TESSERA_QUANTITY(second_form, 3, 2, {2, 1, 0}, {0, 1, 2});
  TESSERA_QUANTITY(first_direction, 3, 2);
  TESSERA_QUANTITY(second_direction, 3, 2);
  TESSERA_QUANTITY(gaussian, 1, 2);
  TESSERA_QUANTITY(mean, 1, 2);
  TESSERA_QUANTITY(first_curvature, 1, 2);
  TESSERA_QUANTITY(second_curvature, 1, 2);
}
/// Calls f(row) for each quantity that is a kind.
template <class F>
constexpr void for_each_kind_quantity(F&& f) {
  TESSERA_QUANTITY(normal_kind, 1, 1);
  TESSERA_QUANTITY(curvature_kind, 1, 2);
}
#undef TESSERA_QUANTITY
/// Calls f(row) for all of them.
template <class F>
constexpr void for_each_quantity(F&& f) {
  for_each_value_quantity(f);
  for_each_kind_quantity(f);
}

/// Counts the rows of numbers with `width` values per sample.
constexpr std::size_t count_of_width(int width) {
  std::size_t count = 0;
  for_each_value_quantity([&](const auto& row) { count += row.width == width ? 1 : 0; });
  return count;
}
inline constexpr std::size_t vector_quantities = count_of_width(3), scalar_quantities = count_of_width(1);
inline constexpr std::size_t value_quantities = vector_quantities + scalar_quantities, kind_quantities = 2;
static_assert(sizeof(Quantities<char>) == value_quantities + kind_quantities, "a member has no row");

}}  // namespace tessera::abi_0_1
