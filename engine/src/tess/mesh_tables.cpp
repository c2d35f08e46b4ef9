#include "tess/mesh_tables.h"

#include <algorithm>
#include <array>

#include "basis/bernstein.h"
#include "kernel/kernel_table.h"

namespace tessera {
namespace {

constexpr std::size_t tile = kernel::mesh_tile;

/// The Bernstein polynomials of a degree and their derivatives at a fraction.
class WeightsAt {
 public:
  explicit WeightsAt(int degree) : degree_(degree) {
    for (int i = 0; i <= degree; ++i) binomial_[at(i)] = binomial(degree, i);
    for (int i = 0; i < degree; ++i) below_[at(i)] = binomial(degree - 1, i);
  }

  void set(Segments::Fraction at_parameter) {
    const double along = at_parameter.value(), back = at_parameter.rest();
    std::array<double, max_degree + 1> t, s;  // their powers
    t[0] = s[0] = 1;
    for (int n = 1; n <= degree_; ++n) {
      t[at(n)] = t[at(n - 1)] * along;
      s[at(n)] = s[at(n - 1)] * back;
    }
    // C(n,i) (t^i s^(n-i)): B_i is B_{n-i} at the rest, bit for bit.
    for (int i = 0; i <= degree_; ++i) value_[at(i)] = binomial_[at(i)] * (t[at(i)] * s[at(degree_ - i)]);
    // n (B^{n-1}_{i-1} - B^{n-1}_i)
    double before = 0;
    for (int i = 0; i <= degree_; ++i) {
      const double next = i < degree_ ? below_[at(i)] * (t[at(i)] * s[at(degree_ - 1 - i)]) : 0;
      slope_[at(i)] = degree_ * (before - next);
      before = next;
    }
  }
  float value(int i) const { return static_cast<float>(value_[at(i)]); }
  float slope(int i) const { return static_cast<float>(slope_[at(i)]); }

 private:
  static std::size_t at(int k) { return static_cast<std::size_t>(k); }

  int degree_;
  std::array<double, max_degree + 1> binomial_{}, below_{}, value_, slope_;
};

/// `[tile][order][i][8]` where segments k = first .. begin, the last of which then repeats; an even number of tiles.
AlignedVector<float> tiles_of_weights(int degree, Segments along, int first) {
  const auto count = static_cast<std::size_t>(along.rate() - first), terms = static_cast<std::size_t>(degree) + 1;
  const std::size_t tiles = (count + 2 * tile - 1) / (2 * tile) * 2;
  AlignedVector<float> weights(tiles * 2 * terms * tile);
  WeightsAt at(degree);
  for (std::size_t k = 0; k < tiles * tile; ++k) {
    if (k < count) at.set(along.at(first + static_cast<int>(k)));
    for (std::size_t i = 0; i < terms; ++i) {
      float* value = weights.data() + (k / tile * 2 * terms + i) * tile + k % tile;
      value[0] = at.value(static_cast<int>(i));
      value[terms * tile] = at.slope(static_cast<int>(i));
    }
  }
  return weights;
}

/// The entry of a vector that grows to hold it.
template <class T>
T& grown(std::vector<T>& entries, std::size_t at) {
  if (at >= entries.size()) entries.resize(at + 1);
  return entries[at];
}

}  // namespace

std::size_t MeshTables::other_place(Segments along) const { return other_places_.find(along.key())->second; }

const MeshTables::Strip& MeshTables::other_strip(Segments border, Segments inner) const {
  return other_strips_.find(key(border, inner))->second;
}

void MeshTables::add_unseen(int degree, Segments inner, Segments border) {
  add_weights(degree, inner, border);
  if (inner.rate() > 1) add_strip(border, inner);
}

void MeshTables::add_weights(int degree, Segments inner, Segments border) {
  for (const Segments along : {inner, inner.reversed(), border, border.reversed()}) {
    if (!along.is_uniform()) other_places_.try_emplace(along.key(), other_places_.size());
    auto& parameters = grown(tables(along).parameters, place(along));
    if (!parameters.empty()) continue;
    for (int k = 0; k <= along.rate(); ++k) parameters.push_back(static_cast<float>(along.at(k).value()));
  }
  if (inner.rate() > 1)
    if (auto& weights = grown(tables(inner).inner[at(degree)], place(inner)); weights.empty())
      weights = tiles_of_weights(degree, inner, 1);
  if (auto& weights = grown(tables(border).border[at(degree)], place(border)); weights.empty())
    weights = tiles_of_weights(degree, border, 0);
  if (!with_cubic_ || degree != 3) return;
  if (inner.rate() > 1) add_cubic_inner(inner);
  add_cubic_border(border);
}

void MeshTables::add_cubic_inner(Segments along) {
  CubicInner& made = grown(tables(along).cubic_inner, place(along));
  if (!made.weights.empty()) return;
  constexpr std::size_t lanes = 16, row_weights = kernel::mesh_row_weights;
  const auto count = static_cast<std::size_t>(along.rate() - 1), rows = (count + 7) / 8 * 8,
             stride = (count + 2 * lanes - 1) / lanes * lanes;
  made.weights.resize(rows * row_weights + 8 * stride);
  made.places.resize(stride);
  float* const columns = made.weights.data() + rows * row_weights;
  WeightsAt at(3);
  for (std::size_t k = 0; k < rows; ++k) {
    if (k < count) at.set(along.at(static_cast<int>(k) + 1));
    for (int i = 0; i < 4; ++i) {
      const auto term = static_cast<std::size_t>(i);
      float* const row = made.weights.data() + (k / 4 * 8 + term) * lanes + k % 4 * 4;
      std::fill_n(row, 4, at.value(i));
      std::fill_n(row + 4 * lanes, 4, at.slope(i));
      for (std::size_t x = k; k < count && x < stride; x += count) {
        columns[term * stride + x] = at.value(i);
        columns[(4 + term) * stride + x] = at.slope(i);
      }
    }
  }
  for (std::size_t x = 0; x < stride; ++x) made.places[x] = static_cast<std::int32_t>(4 * (x / count));
  made.table = {made.weights.data(), columns, made.places.data(), static_cast<std::ptrdiff_t>(stride)};
}

void MeshTables::add_cubic_border(Segments along) {
  CubicBorder& made = grown(tables(along).cubic_border, place(along));
  if (!made.weights.empty()) return;
  constexpr std::size_t lanes = 16;
  const auto count = static_cast<std::size_t>(along.rate()), stride = lanes + (count + 2 * lanes - 1) / lanes * lanes;
  made.weights.resize(8 * stride);
  WeightsAt at(3);
  for (int k = 0; k < along.rate(); ++k) {
    at.set(along.at(k));
    for (int i = 0; i < 4; ++i) {
      float* const value =
          made.weights.data() + static_cast<std::size_t>(i) * stride + lanes + static_cast<std::size_t>(k);
      value[0] = at.value(i);
      value[4 * stride] = at.slope(i);
    }
  }
  made.table = {made.weights.data(), static_cast<std::ptrdiff_t>(stride)};
}

void MeshTables::add_strip(Segments border, Segments inner) {
  const bool are_uniform = border.is_uniform() && inner.is_uniform();
  Strip& strip = are_uniform ? grown(grown(strips_, inner.rate()), at(border.rate() + most_missing - inner.rate()))
                             : other_strips_[key(border, inner)];
  if (!strip.codes.empty()) return;
  const std::vector<std::uint32_t> codes = strip_codes(border, inner, kernel::mesh_border_code);
  strip.count = static_cast<int>(codes.size());
  strip.codes.assign(codes.begin(), codes.end());
  strip.codes.resize((strip.codes.size() + 15) / 16 * 16);
}

}  // namespace tessera
