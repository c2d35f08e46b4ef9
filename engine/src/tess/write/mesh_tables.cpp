#include "tess/write/mesh_tables.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <new>
#include <type_traits>
#include <utility>

#include "basis/bernstein.h"
#include "kernel/table/kernel_table.h"
#include "parallel/parallel_for.h"

namespace tessera { inline namespace abi_0_1 {
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
  const auto found = other_strips_.find({border, inner, collapsed});
  return found == other_strips_.end() ? Strip{} : found->second;
}

bool MeshTables::takes_points(const BlockGroup& group, const Division& division) {
  const auto is_graded = [](Segments along) { return along.is_graded(); };
  return group.degree_u == 3 && group.degree_v == 3 && !group.rational && !division.collapsed.any() &&
         !is_graded(division.inner.u) && !is_graded(division.inner.v) &&
         std::none_of(division.border.begin(), division.border.end(), is_graded);
}

bool MeshTables::has_weights(const Border& wanted) const {
  const Segments ring = wanted.ring_border(), inner = wanted.inner;
  const std::size_t degree = at(wanted.degree);
  if (wanted.by_points)
    return found(tables(ring).cubic_border, place(ring)).weights &&
           (inner.rate() == 1 || found(tables(inner).cubic_inner, place(inner)).rows);
  return found(tables(ring).border[degree], place(ring)) &&
         (inner.rate() == 1 || found(tables(inner).inner[degree], place(inner)));
}

bool MeshTables::has(const Border& wanted) const {
  const auto [inner, border] = std::pair(wanted.inner, wanted.border);
  if (!has_weights(wanted) || !found(tables(border).parameters, place(border))) return false;
  if (inner.rate() == 1) return true;
  if (!is_common(border, inner, wanted.collapsed))
    return found(tables(inner).parameters, place(inner)) &&
           other_strip(wanted.ring_border(), wanted.ring_inner(), wanted.collapsed).codes != nullptr;
  return at(inner.rate()) < strips_.size() &&
         found(strips_[at(inner.rate())], at(border.rate() + max_missing - inner.rate())).codes != nullptr;
}

void MeshTables::add(const Border& wanted) {
  for (const Segments along : {wanted.inner, wanted.border, wanted.ring_border()})
    if (!along.is_uniform()) other_places_.try_emplace(along.key(), other_places_.size());
  add_parameters(wanted.inner);
  add_parameters(wanted.border);
  add_border(wanted);
  if (wanted.inner.rate() == 1) return;
  add_inner(wanted);
  add_strip(wanted.ring_border(), wanted.ring_inner(), wanted.collapsed);
}

template <class T>
const T* MeshTables::hold(const AlignedVector<T>& made) {
  static_assert(sizeof(T) == sizeof(float) && std::is_trivially_copyable_v<T>);
  constexpr std::size_t line = cache_line / sizeof(float), largest_chunk = 4096;
  const std::size_t floats = (made.size() + line - 1) / line * line;
  if (floats > room_.floats) {
    memory_.push_back(std::make_shared<Chunk>(std::max(floats, room_.next_chunk)));
    room_.next_chunk = std::min(2 * room_.next_chunk, largest_chunk);
    room_.begin = memory_.back()->data();
    room_.floats = memory_.back()->size();
    bytes_ += sizeof(float) * room_.floats + cache_line;
  }
  float* const kept = room_.begin;
  room_.begin += floats;
  room_.floats -= floats;
  if (!made.empty()) std::memcpy(kept, made.data(), sizeof(T) * made.size());
  return reinterpret_cast<const T*>(kept);
}

void MeshTables::add_parameters(Segments along) {
  const float*& made = grown(tables(along).parameters, place(along));
  if (made) return;
  AlignedVector<float> parameters(at(along.rate()) + 1);
  for (int k = 0; k <= along.rate(); ++k) parameters[at(k)] = static_cast<float>(along.at(k).value());
  made = hold(parameters);
}

void MeshTables::add_inner(const Border& wanted) {
  const Segments along = wanted.inner;
  if (wanted.by_points) {
    kernel::MeshCubicInner& made = grown(tables(along).cubic_inner, place(along));
    if (!made.rows) made = make_cubic_inner(along);
  } else {
    const float*& made = grown(tables(along).inner[at(wanted.degree)], place(along));
    if (!made) made = hold(tiles_of_weights(wanted.degree, along, 1));
  }
}

void MeshTables::add_border(const Border& wanted) {
  const Segments along = wanted.ring_border();
  if (wanted.by_points) {
    kernel::MeshCubicBorder& made = grown(tables(along).cubic_border, place(along));
    if (!made.weights) made = make_cubic_border(along);
  } else {
    const float*& made = grown(tables(along).border[at(wanted.degree)], place(along));
    if (!made) made = hold(tiles_of_weights(wanted.degree, along, 0));
  }
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
  const float* const kept = hold(weights);
  return {kept, kept + rows * row_weights, hold(places), static_cast<std::ptrdiff_t>(stride)};
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
  return {hold(weights), static_cast<std::ptrdiff_t>(stride)};
}

void MeshTables::add_strip(Segments border, Segments inner, bool collapsed) {
  Strip& strip = is_common(border, inner, collapsed)
                     ? grown(grown(strips_, at(inner.rate())), at(border.rate() + max_missing - inner.rate()))
                     : other_strips_[StripKey{border, inner, collapsed}];
  if (strip.codes) return;
  const std::vector<std::uint32_t> codes = strip_codes(border, inner, collapsed, kernel::mesh_border_code);
  AlignedVector<std::uint32_t> whole((codes.size() + 15) / 16 * 16);
  std::copy(codes.begin(), codes.end(), whole.begin());
  strip = {hold(whole), static_cast<int>(codes.size())};
}

/// Knows most of the common borders that came before, by their degrees, and inner and border rates.
class SeenBorders {
 public:
  explicit SeenBorders(std::size_t patches) : keys_(std::bit_ceil(std::clamp<std::size_t>(16 * patches, 64, 4096))) {}

  /// Calls visit(border) for the borders of a patch.
  template <class Visit>
  static void for_borders(const BlockGroup& group, const Division& division, bool with_points, const Visit& visit) {
    if (division.empty) return;
    const bool by_points = with_points && MeshTables::takes_points(group, division);
    for (const Side side : all_sides)
      visit(MeshTables::Border{.degree = degree_along(side, group),
                               .by_points = by_points,
                               .backward = is_backward(side),
                               .collapsed = division.collapsed.has(side),
                               .inner = division.inner_along(side),
                               .border = division.border[static_cast<std::size_t>(side)]});
  }

  /// Whether all borders of a patch are known to have come before.
  bool has(const BlockGroup& group, const Division& division, bool with_points) const {
    std::uint64_t all = division.inner.u.key() | division.inner.v.key();
    for (const Segments border : division.border) all |= border.key();
    if (!Segments::are_uniform(all) || division.collapsed.any()) return false;
    const bool by_points = with_points && MeshTables::takes_points(group, division);
    const std::uint32_t u = key_of(by_points, group.degree_u, division.inner.u),
                        v = key_of(by_points, group.degree_v, division.inner.v);
    const std::uint32_t* const keys = keys_.data();
    const auto has = [&](std::uint32_t of_inner, Segments border) {
      const std::uint32_t key = of_inner | static_cast<std::uint32_t>(border.key());
      return keys[place_of(key)] == key;
    };
    return has(u, division.border[0]) && has(v, division.border[1]) && has(u, division.border[2]) &&
           has(v, division.border[3]);
  }
  /// Returns false for a border of a kind that is known to have come before.
  bool add(const MeshTables::Border& border) {
    if (!MeshTables::is_common(border.border, border.inner, border.collapsed)) return true;
    const std::uint32_t key =
        key_of(border.by_points, border.degree, border.inner) | static_cast<std::uint32_t>(border.border.rate());
    return std::exchange(keys_[place_of(key)], key) != key;
  }

 private:
  /// The key of a common border without its segments.
  static std::uint32_t key_of(bool by_points, int degree, Segments inner) {
    return static_cast<std::uint32_t>(by_points) << 30 | static_cast<std::uint32_t>(degree << 26 | inner.rate() << 13);
  }
  std::size_t place_of(std::uint32_t key) const { return (key * 0x9e3779b1u >> 20) & (keys_.size() - 1); }

  std::vector<std::uint32_t> keys_;
};

/// Uses the common tables, or a copy of them to which it adds what they lack.
class TableMaker {
 public:
  explicit TableMaker(SharedSlot<void>& kept)
      : kept_(kept), common_(std::static_pointer_cast<const MeshTables>(kept.load())) {
    if (!common_) common_ = own_ = std::shared_ptr<MeshTables>(new MeshTables());
    common_bytes_ = common_->bytes();
  }

  [[gnu::cold]] void add(const MeshTables::Border& wanted) {
    if (common_->has(wanted)) return;
    if (!own_) common_ = own_ = std::shared_ptr<MeshTables>(new MeshTables(*common_));
    own_->add(wanted);
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
  SharedSlot<void>& kept_;
  std::shared_ptr<const MeshTables> common_;
  std::size_t common_bytes_;
  std::shared_ptr<MeshTables> own_;  ///< a copy that replaces common_, if it lacked something
};

std::shared_ptr<const MeshTables> MeshTables::of(const PatchSet::Impl& set, std::span<const Division> divisions,
                                                 bool with_points) {
  // Threads find the patches that may need further tables. They are few, and one thread adds what these lack, in order.
  constexpr std::size_t patches_in_piece = 4096;
  std::vector<std::vector<std::uint32_t>> found((divisions.size() + patches_in_piece - 1) / patches_in_piece);
  const auto group_of = [&](std::size_t patch) -> const BlockGroup& {
    return set.group_of_block(set.slots[patch].block);
  };
  const auto borders_of = [&](std::size_t patch, const auto& visit) {
    SeenBorders::for_borders(group_of(patch), divisions[patch], with_points, visit);
  };
  const auto look = [&](std::size_t begin, std::size_t end) {
    SeenBorders seen(end - begin);
    for (std::size_t k = begin; k < end; ++k) {
      if (divisions[k].empty || seen.has(group_of(k), divisions[k], with_points)) continue;
      bool is_new = false;
      borders_of(k, [&](const Border& border) { is_new |= seen.add(border); });
      if (is_new) found[begin / patches_in_piece].push_back(static_cast<std::uint32_t>(k));
    }
  };
  if (!parallel_for(divisions.size(), patches_in_piece, {}, look).ok()) throw std::bad_alloc();
  TableMaker maker(set.plan_tables[with_points ? 1 : 0]);
  SeenBorders seen(divisions.size());
  const auto add = [&](const Border& border) {
    if (seen.add(border)) maker.add(border);
  };
  for (const std::vector<std::uint32_t>& patches : found)
    for (const std::uint32_t k : patches) borders_of(k, add);
  return maker.take();
}

}}  // namespace tessera::abi_0_1
