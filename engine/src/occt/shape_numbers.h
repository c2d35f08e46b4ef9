#pragma once
// Shapes of OpenCASCADE in the order in which they are met.

#include <opencascade/TopoDS_Iterator.hxx>
#include <opencascade/TopoDS_Shape.hxx>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "tessera/brep.h"

namespace tessera { inline namespace abi_0_1 {

/// Calls visit(found) for each shape of a kind inside `shape`, at its place and with its orientation there, as
/// TopExp_Explorer finds them.
template <class Visit>
void for_shapes(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind, const Visit& visit) {
  if (shape.IsNull() || shape.ShapeType() > kind) return;
  if (shape.ShapeType() == kind) return visit(shape);
  for (TopoDS_Iterator child(shape); child.More(); child.Next()) for_shapes(child.Value(), kind, visit);
}

/// Shapes by number. A shape with two orientations is one.
class ShapeNumbers {
 public:
  enum class Places {
    differ,  ///< a shape at two places is two of them
    count_as_one,
  };
  explicit ShapeNumbers(Places places) : places_(places) {}

  /// Makes room for shapes to come.
  void reserve(std::size_t count) {
    shapes_.reserve(count);
    if (2 * count > table_.size()) grow(std::bit_ceil(2 * count));
  }

  /// Returns the number of a shape that is not null; adds it if there is none.
  std::uint32_t add(const TopoDS_Shape& shape) {
    if (2 * shapes_.size() >= table_.size()) grow(table_.empty() ? 64 : 4 * table_.size());
    std::uint32_t& number = table_[slot(shape)];
    if (number != no_id) return number;
    number = static_cast<std::uint32_t>(shapes_.size());
    shapes_.push_back(shape);
    return number;
  }
  /// Returns the number of a shape; no_id if it has none.
  std::uint32_t find(const TopoDS_Shape& shape) const { return shapes_.empty() ? no_id : table_[slot(shape)]; }

  std::size_t size() const { return shapes_.size(); }
  const TopoDS_Shape& operator[](std::size_t number) const { return shapes_[number]; }

 private:
  /// The slot of a shape, or the free one where it belongs.
  std::size_t slot(const TopoDS_Shape& shape) const {
    std::uint64_t key = reinterpret_cast<std::uintptr_t>(shape.TShape().get());
    if (places_ == Places::differ && !shape.Location().IsIdentity())
      key += static_cast<std::uint64_t>(shape.Location().HashCode(std::numeric_limits<int>::max()));
    key *= 0x9E3779B97F4A7C15u;
    std::size_t at = static_cast<std::size_t>(key >> 32) & (table_.size() - 1);
    while (table_[at] != no_id && !are_same(shapes_[table_[at]], shape)) at = (at + 1) & (table_.size() - 1);
    return at;
  }
  bool are_same(const TopoDS_Shape& a, const TopoDS_Shape& b) const {
    return places_ == Places::differ ? a.IsSame(b) : a.IsPartner(b);
  }
  void grow(std::size_t slots) {
    table_.assign(std::max<std::size_t>(slots, 2), no_id);
    for (std::uint32_t k = 0; k < shapes_.size(); ++k) table_[slot(shapes_[k])] = k;
  }

  Places places_;
  std::vector<TopoDS_Shape> shapes_;
  std::vector<std::uint32_t> table_;  ///< a power of two of numbers
};

}}  // namespace tessera::abi_0_1
