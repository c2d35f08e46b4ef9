#pragma once
// The curves in parameter space (curv2) of an OBJ file, and the loops that trim and hole make of them.

#include <cstddef>
#include <vector>

#include "io/file/text_cursor.h"
#include "tessera/curve.h"
#include "tessera/model.h"

namespace tessera { inline namespace abi_0_1 {

/// Each curve is a chain of pieces. Loops share whole pieces; a part of a piece is a copy with another domain. All
/// copies together may have as many control points as the file has bytes; files that refer to each curve a few times
/// stay far below.
class ObjTrimCurves {
 public:
  explicit ObjTrimCurves(std::size_t file_size) : allowed_(file_size) {}

  std::size_t size() const { return curves_.size(); }
  void add(std::vector<Curve> pieces) { curves_.push_back(std::move(pieces)); }

  /// Reads triples "u0 u1 curv2" to the end of the line.
  Status read_loop(TextCursor& cursor, std::vector<Curve>& loop);

 private:
  bool allow(std::size_t points);

  std::vector<std::vector<Curve>> curves_;
  std::size_t allowed_;
};

}}  // namespace tessera::abi_0_1
