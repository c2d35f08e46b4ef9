#include "io_occt/iges_text.h"

#include <array>

#include "base/text.h"
#include "io_occt/iges_surfaces.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

Status check_weights(const IgesSurface& surface, const std::string& path) {
  if (surface.number(7) == 1) return {};  // a polynomial surface
  const std::size_t first = surface.weights(), row = surface.row();
  for (std::size_t k = 0; k < row * surface.rows() && first + k < surface.words.size(); ++k) {
    const double weight = surface.number(first + k);
    if (weight > 0) continue;
    return Status(StatusCode::invalid_weight, path + ": surface " + surface.entity + ": weight [" +
                                                  std::to_string(k % row) + "][" + std::to_string(k / row) + "] is " +
                                                  text(weight) + ", it must be greater than 0");
  }
  return {};
}

/// Completes the ranges of a surface. Whether any end was missing.
bool complete(IgesSurface& surface) {
  const std::size_t first = surface.ranges();
  if (surface.words.size() < first) return false;  // points are missing, too
  // Parameters run from knot M to knot K + 1, counted from 0.
  const std::array<std::size_t, 4> ends{surface.knots_u() + surface.count(3), surface.knots_u() + surface.row(),
                                        surface.knots_v() + surface.count(4), surface.knots_v() + surface.rows()};
  bool missing = false;
  for (std::size_t k = 0; k < ends.size(); ++k) {
    if (first + k == surface.words.size()) surface.words.emplace_back();
    std::string& word = surface.words[first + k];
    if (!word.empty()) continue;
    word = surface.words[ends[k]];
    missing = true;
  }
  return missing;
}

/// Appends the record of a surface. OpenCASCADE finds the lines of an entity by the number at their end.
void append_record(const IgesSurface& surface, std::string& out) {
  constexpr std::size_t columns = 64;
  std::string line;
  const auto end_line = [&] {
    line.resize(columns, ' ');
    out += line;
    out += surface.begin_of_tail;
    line.clear();
  };
  for (std::size_t k = 0; k < surface.words.size(); ++k) {
    const std::string word = surface.words[k] + (k + 1 < surface.words.size() ? surface.parameter : surface.terminator);
    if (line.size() + word.size() > columns) end_line();
    line += word;
  }
  end_line();
}

}  // namespace

Status check_iges_weights(std::string_view text, const std::string& path) {
  for (const IgesSurface& surface : iges_surfaces(text))
    if (Status status = check_weights(surface, path); !status.ok()) return status;
  return {};
}

std::optional<std::string> with_iges_ranges(std::string_view text) {
  std::string out;
  std::size_t done = 0;
  for (IgesSurface& surface : iges_surfaces(text)) {
    if (!complete(surface)) continue;
    out += text.substr(done, surface.begin - done);
    append_record(surface, out);
    done = surface.end;
  }
  if (done == 0) return {};
  out += text.substr(done);
  return out;
}

}}  // namespace tessera::abi_0_1
