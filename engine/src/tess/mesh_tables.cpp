#include "tess/mesh_tables.h"

#include <algorithm>

#include "basis/bernstein.h"
#include "kernel/kernel_table.h"

namespace tessera {
namespace {

constexpr std::size_t tile = kernel::mesh_tile;

/// C(n,i) (t^i s^(n-i)) with t = k / rate and s = (rate - k) / rate: B_i at k is B_{n-i} at rate - k, bit for bit.
double weight(int degree, int i, int k, int rate) {
  double t = 1, s = 1;
  for (int n = 0; n < i; ++n) t *= double(k) / rate;
  for (int n = i; n < degree; ++n) s *= double(rate - k) / rate;
  return binomial(degree, i) * (t * s);
}

/// n (B^{n-1}_{i-1} - B^{n-1}_i).
double first_derivative(int degree, int i, int k, int rate) {
  const double before = i > 0 ? weight(degree - 1, i - 1, k, rate) : 0, next = i < degree ? weight(degree - 1, i, k, rate) : 0;
  return degree * (before - next);
}

/// `[tile][order][i][8]` for k = first .. last, which then repeats; an even number of tiles.
AlignedVector<float> tiles_of_weights(int degree, int rate, int first, int last) {
  const auto count = static_cast<std::size_t>(last - first + 1), terms = static_cast<std::size_t>(degree) + 1;
  const std::size_t tiles = (count + 2 * tile - 1) / (2 * tile) * 2;
  AlignedVector<float> weights(tiles * 2 * terms * tile);
  for (std::size_t k = 0; k < tiles * tile; ++k) {
    const int number = first + static_cast<int>(std::min(k, count - 1));
    for (std::size_t i = 0; i < terms; ++i) {
      float* value = weights.data() + (k / tile * 2 * terms + i) * tile + k % tile;
      value[0] = static_cast<float>(weight(degree, static_cast<int>(i), number, rate));
      value[terms * tile] = static_cast<float>(first_derivative(degree, static_cast<int>(i), number, rate));
    }
  }
  return weights;
}

/// The entry of a vector that grows to hold it.
template <class T>
T& grown(std::vector<T>& entries, int k) {
  const auto at = static_cast<std::size_t>(k);
  if (at >= entries.size()) entries.resize(at + 1);
  return entries[at];
}

}  // namespace

void MeshTables::add_weights(int degree, int inner, int border) {
  if (inner > 1)
    if (auto& weights = grown(inner_[at(degree)], inner); weights.empty())
      weights = tiles_of_weights(degree, inner, 1, inner - 1);
  if (auto& weights = grown(border_[at(degree)], border); weights.empty())
    weights = tiles_of_weights(degree, border, 0, border - 1);
  for (const int rate : {inner, border}) {
    auto& parameters = grown(parameters_, rate);
    if (!parameters.empty()) continue;
    for (int k = 0; k <= rate; ++k) parameters.push_back(static_cast<float>(double(k) / rate));
  }
}

void MeshTables::add_strip(int border, int inner) {
  Strip& strip = grown(grown(strips_, inner), border + most_missing - inner);
  if (!strip.codes.empty()) return;
  const std::vector<std::uint32_t> codes = strip_codes(border, inner, kernel::mesh_border_code);
  strip.count = static_cast<int>(codes.size());
  strip.codes.assign(codes.begin(), codes.end());
  strip.codes.resize((strip.codes.size() + 15) / 16 * 16);
}

}  // namespace tessera
