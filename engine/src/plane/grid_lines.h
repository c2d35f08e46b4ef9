#pragma once
// The grid of parameters that divides a patch into cells.

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>

#include "tessera/geometry.h"

namespace tessera { inline namespace abi_0_1 {

/// A place in a grid: of a cell, or of a vertex.
struct GridPlace {
  std::uint32_t i = 0, j = 0;  ///< along u and along v
};

/// Lines u = const and v = const, and the cells between them. Cells and vertices are counted along v first.
class GridLines {
 public:
  GridLines() = default;
  /// Takes the parameters of the lines: at least 2 a list, each larger than the one before. They must outlive the grid.
  GridLines(std::span<const double> u, std::span<const double> v) : u_(u), v_(v) {
    assert(u.size() > 1 && v.size() > 1);
  }

  std::uint32_t columns() const { return static_cast<std::uint32_t>(u_.size() - 1); }  ///< cells along u
  std::uint32_t rows() const { return static_cast<std::uint32_t>(v_.size() - 1); }     ///< cells along v
  std::size_t cell_count() const { return std::size_t{columns()} * rows(); }
  std::size_t vertex_count() const { return u_.size() * v_.size(); }
  std::uint32_t cell(std::uint32_t i, std::uint32_t j) const { return i * rows() + j; }
  std::uint32_t vertex(std::uint32_t i, std::uint32_t j) const { return i * (rows() + 1) + j; }
  GridPlace place_of_vertex(std::uint32_t vertex) const { return {vertex / (rows() + 1), vertex % (rows() + 1)}; }

  double u(std::uint32_t i) const { return u_[i]; }
  double v(std::uint32_t j) const { return v_[j]; }
  ParameterPoint point(GridPlace vertex) const { return {u_[vertex.i], v_[vertex.j]}; }
  /// Returns the cell that holds a point; on a line that which begins there. `near`: a cell where the search starts.
  GridPlace find(const ParameterPoint& at, GridPlace near) const {
    return {interval_of(u_, at.u, near.i), interval_of(v_, at.v, near.j)};
  }
  std::uint32_t find_row(double v, std::uint32_t near) const { return interval_of(v_, v, near); }
  std::uint32_t find_column(double u, std::uint32_t near) const { return interval_of(u_, u, near); }

 private:
  static std::uint32_t interval_of(std::span<const double> lines, double at, std::uint32_t near) {
    const std::uint32_t last = static_cast<std::uint32_t>(lines.size() - 2);
    while (near > 0 && at < lines[near]) --near;
    while (near < last && at >= lines[near + 1]) ++near;
    return near;
  }

  std::span<const double> u_, v_;
};

}}  // namespace tessera::abi_0_1
