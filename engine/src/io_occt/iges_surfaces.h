#pragma once
// The B-spline surfaces (entities of type 128) in the text of an IGES file.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace tessera { inline namespace abi_0_1 {

/// A record of type 128: 128, K1, K2, M1, M2, five flags, the knots, the weights, the points, and the four ends of the
/// ranges (IGES 5.3, sec. 4.23).
struct IgesSurface {
  std::string entity;              ///< "D3"
  std::vector<std::string> words;  ///< parameters without blanks; those at the end of the record may be missing
  std::size_t begin = 0, end = 0;  ///< its lines in the text
  std::string_view begin_of_tail;  ///< columns 65 and on of its first line
  char parameter = ',', terminator = ';';

  /// A parameter as a number; 0 if it is missing or is none. A D may stand for the E of an exponent.
  double number(std::size_t k) const;
  /// A number of things.
  std::size_t count(std::size_t k) const;
  std::size_t row() const { return count(1) + 1; }   ///< points along the first parameter, which runs fastest
  std::size_t rows() const { return count(2) + 1; }  ///< points along the second
  std::size_t knots_u() const { return 10; }         ///< place of the first knot
  std::size_t knots_v() const { return knots_u() + row() + count(3) + 1; }
  std::size_t weights() const { return knots_v() + rows() + count(4) + 1; }  ///< place of the first weight
  std::size_t ranges() const { return weights() + 4 * row() * rows(); }      ///< place of the first range's start
};

/// Lists the surfaces of a file. Text that is none is left to OpenCASCADE.
std::vector<IgesSurface> iges_surfaces(std::string_view text);

}}  // namespace tessera::abi_0_1
