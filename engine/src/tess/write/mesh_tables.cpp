#include "tess/write/mesh_tables.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "basis/bernstein.h"
#include "kernel/table/kernel_table.h"

namespace tessera::inline abi_0_1 {
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
    // C(n,i) (t^i s^(n-i)): B_i at t is B_{n-i} at s, bit for bit.
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

/// Returns weights `[tile][order][i][8]` where segments k = first .. begin. The last one repeats up to an even number
/// of tiles.
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

/// Returns the entry of a vector, which grows to hold it.
template <class T>
T& grown(std::vector<T>& entries, std::size_t at) {
  if (at >= entries.size()) entries.resize(at + 1);
  return entries[at];
}
/// Returns the entry of a vector, or T{} if there is none.
template <class T>
T found(const std::vector<T>& entries, std::size_t at) {
  return at < entries.size() ? entries[at] : T{};
}

}  // namespace

std::size_t MeshTables::other_place(Segments along) const {
  const auto found = other_places_.find(along.key());
  return found == other_places_.end() ? static_cast<std::size_t>(-1) : found->second;
}

MeshTables::Strip MeshTables::other_strip(Segments border, Segments inner, bool collapsed) const {
  const auto found = other_strips_.find(key(border, inner, collapsed));
  return found == other_strips_.end() ? Strip{} : found->second;
}

bool MeshTables::has(int degree, Segments inner, Segments border, bool collapsed) const {
  if (!found(tables(border).border[at(degree)], place(border))) return false;
  if (inner.rate() == 1) return true;
  if (!found(tables(inner).inner[at(degree)], place(inner))) return false;
  if (!is_common(border, inner, collapsed)) return other_strip(border, inner, collapsed).codes != nullptr;
  return at(inner.rate()) < strips_.size() &&
         found(strips_[at(inner.rate())], at(border.rate() + max_missing - inner.rate())).codes != nullptr;
}

void MeshTables::add(int degree, Segments inner, Segments border, bool collapsed) {
  for (const Segments along : {inner, inner.reversed(), border, border.reversed()}) {
    if (!along.is_uniform()) other_places_.try_emplace(along.key(), other_places_.size());
    add_parameters(along);
  }
  add_border(degree, border);
  if (inner.rate() == 1) return;
  add_inner(degree, inner);
  add_strip(border, inner, collapsed);
}

template <class T>
const T* MeshTables::hold(AlignedVector<T> made) {
  const auto kept = std::make_shared<const AlignedVector<T>>(std::move(made));
  memory_.push_back(kept);
  bytes_ += sizeof(T) * kept->size() + 2 * cache_line;
  return kept->data();
}

void MeshTables::add_parameters(Segments along) {
  const float*& made = grown(tables(along).parameters, place(along));
  if (made) return;
  AlignedVector<float> parameters(at(along.rate()) + 1);
  for (int k = 0; k <= along.rate(); ++k) parameters[at(k)] = static_cast<float>(along.at(k).value());
  made = hold(std::move(parameters));
}

void MeshTables::add_inner(int degree, Segments along) {
  const float*& made = grown(tables(along).inner[at(degree)], place(along));
  if (made) return;
  made = hold(tiles_of_weights(degree, along, 1));
  if (with_cubic_ && degree == 3) grown(tables(along).cubic_inner, place(along)) = make_cubic_inner(along);
}

void MeshTables::add_border(int degree, Segments along) {
  const float*& made = grown(tables(along).border[at(degree)], place(along));
  if (made) return;
  made = hold(tiles_of_weights(degree, along, 0));
  if (with_cubic_ && degree == 3) grown(tables(along).cubic_border, place(along)) = make_cubic_border(along);
}

kernel::MeshCubicInner MeshTables::make_cubic_inner(Segments along) {
  constexpr std::size_t lanes = 16, row_weights = kernel::mesh_row_weights;
  const auto count = static_cast<std::size_t>(along.rate() - 1), rows = (count + 7) / 8 * 8,
             stride = (count + 2 * lanes - 1) / lanes * lanes;
  AlignedVector<float> weights(rows * row_weights + 8 * stride);
  AlignedVector<std::int32_t> places(stride);
  float* const columns = weights.data() + rows * row_weights;
  WeightsAt at(3);
  for (std::size_t k = 0; k < rows; ++k) {
    if (k < count) at.set(along.at(static_cast<int>(k) + 1));
    for (int i = 0; i < 4; ++i) {
      const auto term = static_cast<std::size_t>(i);
      float* const row = weights.data() + (k / 4 * 8 + term) * lanes + k % 4 * 4;
      std::fill_n(row, 4, at.value(i));
      std::fill_n(row + 4 * lanes, 4, at.slope(i));
      for (std::size_t x = k; k < count && x < stride; x += count) {
        columns[term * stride + x] = at.value(i);
        columns[(4 + term) * stride + x] = at.slope(i);
      }
    }
  }
  for (std::size_t x = 0; x < stride; ++x) places[x] = static_cast<std::int32_t>(4 * (x / count));
  const float* const kept = hold(std::move(weights));
  return {kept, kept + rows * row_weights, hold(std::move(places)), static_cast<std::ptrdiff_t>(stride)};
}

kernel::MeshCubicBorder MeshTables::make_cubic_border(Segments along) {
  constexpr std::size_t lanes = 16;
  const auto count = static_cast<std::size_t>(along.rate()), stride = lanes + (count + 2 * lanes - 1) / lanes * lanes;
  AlignedVector<float> weights(8 * stride);
  WeightsAt at(3);
  for (int k = 0; k < along.rate(); ++k) {
    at.set(along.at(k));
    for (int i = 0; i < 4; ++i) {
      float* const value = weights.data() + static_cast<std::size_t>(i) * stride + lanes + static_cast<std::size_t>(k);
      value[0] = at.value(i);
      value[4 * stride] = at.slope(i);
    }
  }
  return {hold(std::move(weights)), static_cast<std::ptrdiff_t>(stride)};
}

void MeshTables::add_strip(Segments border, Segments inner, bool collapsed) {
  Strip& strip = is_common(border, inner, collapsed)
                     ? grown(grown(strips_, at(inner.rate())), at(border.rate() + max_missing - inner.rate()))
                     : other_strips_[key(border, inner, collapsed)];
  if (strip.codes) return;
  const std::vector<std::uint32_t> codes = strip_codes(border, inner, collapsed, kernel::mesh_border_code);
  AlignedVector<std::uint32_t> whole((codes.size() + 15) / 16 * 16);
  std::copy(codes.begin(), codes.end(), whole.begin());
  strip = {hold(std::move(whole)), static_cast<int>(codes.size())};
}

/// Uses the common tables, or a copy of them to which it adds what they lack.
class TableMaker {
 public:
  TableMaker(SharedSlot<MeshTables>& kept, std::size_t patches, bool with_cubic)
      : kept_(kept), common_(kept.load()), seen_(std::bit_ceil(std::clamp<std::size_t>(16 * patches, 64, 4096))) {
    if (!common_) common_ = own_ = std::shared_ptr<MeshTables>(new MeshTables(with_cubic));
    common_bytes_ = common_->bytes();
  }

  void add(const PatchShape& shape, const Division& division) {
    if (division.empty) return;
    for (const Side side : all_sides) {
      const int degree = runs_along_u(side) ? shape.degree_u : shape.degree_v;
      const Segments inner = division.inner_along(side), border = division.border[static_cast<std::size_t>(side)];
      const bool collapsed = division.collapsed.has(edge_of(side));
      if (MeshTables::is_common(border, inner, collapsed)) {
        add_common(degree, inner, border);
      } else {
        add(degree, division.inner_along_ring(side), division.along_ring(side), collapsed);
      }
    }
  }
  /// Returns the tables. They become the common ones if they are small. If they are too large and the common ones are
  /// more than half full, the common ones begin anew.
  std::shared_ptr<const MeshTables> take() {
    if (!own_) return common_;
    if (own_->bytes() <= MeshTables::max_common_bytes) {
      kept_.store(own_);
    } else if (common_bytes_ > MeshTables::max_common_bytes / 2) {
      kept_.store(nullptr);
    }
    return own_;
  }

 private:
  void add_common(int degree, Segments inner, Segments border) {
    const std::uint32_t wanted = static_cast<std::uint32_t>(degree) << 26 | inner.key() << 13 | border.key();
    std::uint32_t& seen = seen_[(wanted * 0x9e3779b1u >> 20) & (seen_.size() - 1)];
    if (seen == wanted) return;
    add(degree, inner, border, false);
    seen = wanted;
  }
  [[gnu::cold]] void add(int degree, Segments inner, Segments border, bool collapsed) {
    if (common_->has(degree, inner, border, collapsed)) return;
    if (!own_) common_ = own_ = std::shared_ptr<MeshTables>(new MeshTables(*common_));
    own_->add(degree, inner, border, collapsed);
  }

  SharedSlot<MeshTables>& kept_;
  std::shared_ptr<const MeshTables> common_;
  std::size_t common_bytes_;
  std::shared_ptr<MeshTables> own_;  ///< a copy that replaces common_, if it lacked something
  std::vector<std::uint32_t> seen_;  ///< a cache of what has been added: degrees, inner and border rates
};

std::shared_ptr<const MeshTables> MeshTables::of(const PatchSet::Impl& set, std::span<const PatchShape> shapes,
                                                 std::span<const Division> divisions, bool with_cubic) {
  TableMaker maker(set.mesh_tables[with_cubic ? 1 : 0], shapes.size(), with_cubic);
  for (std::size_t k = 0; k < shapes.size(); ++k) maker.add(shapes[k], divisions[k]);
  return maker.take();
}

}  // namespace tessera::inline abi_0_1
