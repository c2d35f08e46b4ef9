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
  const double before = i > 0 ? weight(degree - 1, i - 1, k, rate) : 0,
               next = i < degree ? weight(degree - 1, i, k, rate) : 0;
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
  if (with_cubic_ && degree == 3) {
    if (inner > 1) add_cubic_inner(inner);
    add_cubic_border(border);
  }
  for (const int rate : {inner, border}) {
    auto& parameters = grown(parameters_, rate);
    if (!parameters.empty()) continue;
    for (int k = 0; k <= rate; ++k) parameters.push_back(static_cast<float>(double(k) / rate));
  }
}

void MeshTables::add_cubic_inner(int rate) {
  CubicInner& made = grown(cubic_inner_, rate);
  if (!made.weights.empty()) return;
  constexpr std::size_t lanes = 16, row_weights = kernel::mesh_row_weights;
  const auto count = static_cast<std::size_t>(rate - 1), rows = (count + 7) / 8 * 8,
             stride = (count + 2 * lanes - 1) / lanes * lanes;
  made.weights.resize(rows * row_weights + 8 * stride);
  made.places.resize(stride);
  float* const columns = made.weights.data() + rows * row_weights;
  for (std::size_t i = 0; i < 4; ++i)
    for (const std::size_t order : {0, 1}) {
      const auto value = [&](std::size_t k) {
        const int number = static_cast<int>(k) + 1, term = static_cast<int>(i);
        return static_cast<float>(order == 0 ? weight(3, term, number, rate) : first_derivative(3, term, number, rate));
      };
      for (std::size_t k = 0; k < rows; ++k)
        std::fill_n(made.weights.data() + (k / 4 * 8 + order * 4 + i) * lanes + k % 4 * 4, 4,
                    value(std::min(k, count - 1)));
      for (std::size_t x = 0; x < stride; ++x) columns[(order * 4 + i) * stride + x] = value(x % count);
    }
  for (std::size_t x = 0; x < stride; ++x) made.places[x] = static_cast<std::int32_t>(4 * (x / count));
  made.table = {made.weights.data(), columns, made.places.data(), static_cast<std::ptrdiff_t>(stride)};
}

void MeshTables::add_cubic_border(int rate) {
  CubicBorder& made = grown(cubic_border_, rate);
  if (!made.weights.empty()) return;
  constexpr std::size_t lanes = 16;
  const auto count = static_cast<std::size_t>(rate), stride = lanes + (count + 2 * lanes - 1) / lanes * lanes;
  made.weights.resize(8 * stride);
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < rate; ++k) {
      float* const value =
          made.weights.data() + static_cast<std::size_t>(i) * stride + lanes + static_cast<std::size_t>(k);
      value[0] = static_cast<float>(weight(3, i, k, rate));
      value[4 * stride] = static_cast<float>(first_derivative(3, i, k, rate));
    }
  made.table = {made.weights.data(), static_cast<std::ptrdiff_t>(stride)};
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
