#include "tess/trimmed/band_refiner.h"

#include <utility>

namespace tessera::inline abi_0_1 {

void BandRefiner::add_edge(std::uint32_t a, std::uint32_t b, std::uint32_t triangle) {
  const auto [at, is_new] = edges_.try_emplace(key(a, b), std::array{triangle, none});
  if (!is_new) at->second[1] = triangle;
}

void BandRefiner::move_edge(std::uint32_t a, std::uint32_t b, std::uint32_t from, std::uint32_t to) {
  for (std::uint32_t& triangle : edges_.at(key(a, b)))
    if (triangle == from) triangle = to;
}

std::uint32_t BandRefiner::divide(std::vector<Triangle>& triangles, std::uint32_t triangle, std::uint32_t a,
                                  std::uint32_t b, std::uint32_t m) {
  const auto added = static_cast<std::uint32_t>(triangles.size());
  const Triangle whole = triangles[triangle];
  Triangle low = whole, high = whole;
  std::uint32_t apex = none;
  for (std::size_t c = 0; c < 3; ++c) {
    if (whole[c] == b) low[c] = m;
    if (whole[c] == a) high[c] = m;
    if (whole[c] != a && whole[c] != b) apex = whole[c];
  }
  triangles[triangle] = low;
  triangles.push_back(high);
  move_edge(b, apex, triangle, added);
  add_edge(a, m, triangle), add_edge(m, b, added);
  edges_[key(m, apex)] = {triangle, added};
  return added;
}

void BandRefiner::run(std::vector<ParameterPoint>& vertices, std::vector<Triangle>& triangles, std::size_t first,
                      FunctionRef<bool(const Triangle&)> is_large,
                      FunctionRef<double(std::uint32_t, std::uint32_t)> length) {
  large_.clear();
  for (std::size_t t = first; t < triangles.size(); ++t)
    if (is_large(triangles[t])) large_.push_back(static_cast<std::uint32_t>(t));
  if (large_.empty()) return;
  edges_.clear();
  for (std::size_t t = first; t < triangles.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c)
      add_edge(triangles[t][c], triangles[t][(c + 1) % 3], static_cast<std::uint32_t>(t));
  while (!large_.empty()) {
    const std::uint32_t t = large_.back();
    large_.pop_back();
    const Triangle triangle = triangles[t];
    if (!is_large(triangle)) continue;
    std::uint32_t a = triangle[2], b = triangle[0];
    for (std::size_t c = 0; c < 2; ++c)
      if (length(triangle[c], triangle[c + 1]) > length(a, b)) a = triangle[c], b = triangle[c + 1];
    const auto edge = edges_.find(key(a, b));
    const std::array<std::uint32_t, 2> beside = edge->second;
    if (beside[1] == none) continue;
    edges_.erase(edge);
    const auto m = static_cast<std::uint32_t>(vertices.size());
    vertices.push_back({(vertices[a].u + vertices[b].u) / 2, (vertices[a].v + vertices[b].v) / 2});
    for (const std::uint32_t side : beside) {
      large_.push_back(divide(triangles, side, a, b, m));
      large_.push_back(side);
    }
  }
}

}  // namespace tessera::inline abi_0_1
