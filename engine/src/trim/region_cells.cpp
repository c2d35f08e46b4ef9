#include "trim/region_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <queue>
#include <span>
#include <utility>

#include "base/infinity.h"
#include "trim/piece_samples.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t crowded = 8;  ///< a cell with more entries gets a finer grid

/// A piece in a rectangle, and the heights at which it counts there.
struct Item {
  std::uint32_t piece;
  double from_v, to_v;
  bool counts_at(double v) const { return from_v <= v && v < to_v; }
};

/// A rectangle that is to be divided into cells.
struct Task {
  Domain rectangle;
  std::vector<Item> items;
  bool parity;       ///< the constant part of the parity
  std::size_t cell;  ///< the cell that gets the grid; none for the domain
  int depth;
};

/// A coordinate of a point as a cell of the grid sees it: -1 and count stand for beyond the first and the last cell.
std::int32_t place(std::int32_t inside, std::int32_t count, double x, double lower, double upper) {
  return x < lower ? -1 : x > upper ? count : inside;
}

}  // namespace

class CellsBuilder {
 public:
  CellsBuilder(const std::vector<TrimPiece>& pieces, const Domain& domain)
      : pieces_(pieces), entry_budget_(64 * pieces.size() + 4096) {
    const double u = std::max(std::abs(domain.u0), std::abs(domain.u1));
    const double v = std::max(std::abs(domain.v0), std::abs(domain.v1));
    rounding_ = {16 * 0x1p-52 * u, 16 * 0x1p-52 * v};
    for (const TrimPiece& piece : pieces) reach_.push_back(reach(piece) + rounding_);
  }

  RegionCells build(const Domain& domain, bool starts_inside) {
    std::queue<Task> tasks;
    Task all{domain, {}, starts_inside, no_cell, 0};
    for (std::size_t k = 0; k < pieces_.size(); ++k)
      all.items.push_back({static_cast<std::uint32_t>(k), pieces_[k].lower_v(), pieces_[k].upper_v()});
    tasks.push(std::move(all));
    while (!tasks.empty()) {
      divide(tasks.front());
      for (Task& task : crowded_) tasks.push(std::move(task));
      crowded_.clear();
      tasks.pop();
    }
    return std::move(made_);
  }

 private:
  static constexpr std::size_t no_cell = static_cast<std::size_t>(-1);

  /// An entry that waits for its place.
  struct Pending {
    std::size_t cell;
    CellEntry entry;
  };

  void divide(const Task& task) {
    rectangle_ = task.rectangle;
    depth_ = task.depth;
    const auto side = static_cast<std::int32_t>(std::ceil(6 * std::sqrt(static_cast<double>(task.items.size()))));
    const std::int32_t cells = std::clamp(side, 4, task.depth == 0 ? 512 : 64);
    grid_ = {rectangle_.u0,
             rectangle_.v0,
             cells / (rectangle_.u1 - rectangle_.u0),
             cells / (rectangle_.v1 - rectangle_.v0),
             cells,
             cells,
             static_cast<std::uint32_t>(made_.cells_.size())};
    const auto count = static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells);
    toggles_.assign(count, 0);
    pending_.clear();
    pending_items_.clear();
    if (task.parity)
      for (std::size_t row = 0; row < static_cast<std::size_t>(cells); ++row) toggles_[(row + 1) * cells - 1] ^= 1;
    for (const Item& item : task.items) add(item);
    made_.cells_.resize(made_.cells_.size() + count);
    finish();
    if (task.cell != no_cell) made_.cells_[task.cell] = Cell::make(Cell::grid, made_.grids_.size());
    made_.grids_.push_back(grid_);
  }

  double row_from(std::int32_t row) const { return rectangle_.v0 + row / grid_.per_v; }
  double column_from(std::int32_t column) const { return rectangle_.u0 + column / grid_.per_u; }
  std::int32_t column_of(double u, double pad) const {
    return place(grid_.column(u), grid_.columns, u, rectangle_.u0 - pad, rectangle_.u1 + pad);
  }
  std::int32_t row_of(double v, double pad) const {
    return place(grid_.row(v), grid_.rows, v, rectangle_.v0 - pad, rectangle_.v1 + pad);
  }

  /// Lists an item in the cells that it passes through, and toggles the parity of those on its left.
  void add(const Item& item) {
    const TrimPiece& piece = pieces_[item.piece];
    const ParameterPoint pad = reach_[item.piece];
    const std::int32_t first = std::max(row_of(piece.lower_v() - pad.v, 0), 0);
    const std::int32_t last = std::min(row_of(piece.upper_v() + pad.v, 0), grid_.rows - 1);
    const Domain within{rectangle_.u0 - pad.u, rectangle_.u1 + pad.u, rectangle_.v0 - pad.v, rectangle_.v1 + pad.v};
    samples_.set(piece, within, {0.5 / grid_.per_u, 0.5 / grid_.per_v});
    const bool goes_on = item.from_v == -infinity || item.to_v == infinity;
    for (std::int32_t row = goes_on ? 0 : first; row <= (goes_on ? grid_.rows - 1 : last); ++row) {
      std::optional<SampleRange> range;
      const double lower = row_from(row) - pad.v, upper = row_from(row + 1) + pad.v;
      if (row >= first && row <= last) range = samples_.within(&ParameterPoint::v, lower, upper);
      if (range || goes_on) add_row(item, row, range);
    }
  }

  void add_row(const Item& item, std::int32_t row, const std::optional<SampleRange>& range) {
    const TrimPiece& piece = pieces_[item.piece];
    const ParameterPoint pad = reach_[item.piece];
    std::int32_t from = grid_.columns, to = grid_.columns;  // beyond the row: it counts as a line on the right
    if (range) {
      const auto [lower, upper] = std::minmax(samples_[range->first].u, samples_[range->last].u);
      from = column_of(lower - pad.u, 0);
      to = column_of(upper + pad.u, 0);
      const bool goes_on_below = item.from_v == -infinity && row <= row_of(piece.lower_v(), 0);
      const bool goes_on_above = item.to_v == infinity && row >= row_of(piece.upper_v(), 0);
      if (goes_on_below || goes_on_above) to = grid_.columns;
    }
    const double middle = 0.5 * row_from(row) + 0.5 * row_from(row + 1);
    if (item.counts_at(middle) && from > 0) toggle(row, from);
    for (std::int32_t column = std::max(from, 0); column <= to && column < grid_.columns; ++column)
      list(item, row, column, middle, *range);
  }

  /// Toggles the parity of the cells before a column.
  void toggle(std::int32_t row, std::int32_t column) { toggles_[at(row, column - 1)] ^= 1; }
  std::size_t at(std::int32_t row, std::int32_t column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(grid_.columns) + static_cast<std::size_t>(column);
  }

  /// Lists an item in one cell.
  void list(const Item& item, std::int32_t row, std::int32_t column, double middle, const SampleRange& in_row) {
    const TrimPiece& piece = pieces_[item.piece];
    Item own = item;
    // The end with larger u is the upper one unless the piece falls.
    const bool starts_left = piece.start().u <= piece.end().u;
    const ParameterPoint& left = starts_left ? piece.start() : piece.end();
    const ParameterPoint& right = starts_left ? piece.end() : piece.start();
    const bool falls = right.v < left.v;
    const auto goes_on = [&](const ParameterPoint& end) {
      return row_of(end.v, rounding_.v) == row && column_of(end.u, rounding_.u) > column;
    };
    if (goes_on(left)) (falls ? own.to_v : own.from_v) = falls ? infinity : -infinity;
    if (goes_on(right)) (falls ? own.from_v : own.to_v) = falls ? -infinity : infinity;
    // All of the piece is beyond the cell, and only its reach and rounding are not: it has no strip here.
    const bool is_beyond = falls ? own.to_v == infinity : own.from_v == -infinity;
    if (own.counts_at(middle) && !item.counts_at(middle)) toggle_only(row, column);
    CellEntry entry = strip(item.piece, column, in_row, falls, is_beyond);
    entry.from_v = own.from_v;
    entry.to_v = own.to_v;
    pending_.push_back({at(row, column), entry});
    pending_items_.push_back(own);
  }
  void toggle_only(std::int32_t row, std::int32_t column) {
    toggles_[at(row, column)] ^= 1;
    if (column > 0) toggles_[at(row, column - 1)] ^= 1;
  }

  /// The strip that holds the piece within a cell. Without one, every point of the cell takes the slow way.
  CellEntry strip(std::uint32_t index, std::int32_t column, const SampleRange& in_row, bool falls, bool without) {
    const TrimPiece& piece = pieces_[index];
    const ParameterPoint pad = reach_[index];
    CellEntry entry{0, 0, 0, -infinity, infinity, 0, 0, index, 0};
    const double lower = column_from(column) - pad.u, upper = column_from(column + 1) + pad.u;
    const std::optional<SampleRange> range = samples_.within(&ParameterPoint::u, lower, upper, in_row);
    if (without || !range || range->first == range->last) return entry;
    const ParameterPoint from = samples_[range->first], to = samples_[range->last];
    const double du = std::abs(to.u - from.u), dv = std::abs(to.v - from.v);
    entry.a = -dv;
    entry.b = falls ? -du : du;
    const ParameterPoint middle{0.5 * from.u + 0.5 * to.u, 0.5 * from.v + 0.5 * to.v};
    entry.c = -(entry.a * middle.u + entry.b * middle.v);
    const auto value = [&](const ParameterPoint& p) { return entry.a * (p.u - middle.u) + entry.b * (p.v - middle.v); };
    const auto [least, most] = hull(piece, samples_.parameter(range->first), samples_.parameter(range->last), value);
    // Reach, the rounding of the sum at every point of the cell, and that of the hull.
    const ParameterPoint size = distance(piece.start(), piece.end());
    const double rounding = plane_error(piece.curve.degree()) * (dv * size.u + du * size.v);
    const double wider = 2 * (dv * pad.u + du * pad.v + rounding);
    entry.lower = least - wider;
    entry.upper = most + wider;
    return entry;
  }

  /// The smallest and the largest value of a linear function at the control points of a part of a piece.
  template <class Value>
  static std::pair<double, double> hull(const TrimPiece& piece, double t0, double t1, Value value) {
    const std::size_t count = piece.curve.points.size();
    std::array<double, max_degree + 1> f, w;
    for (std::size_t i = 0; i < count; ++i) {
      w[i] = piece.curve.weight(i);
      f[i] = w[i] * value(piece.curve.points[i]);
    }
    const auto step = [&](std::size_t to, std::size_t a, std::size_t b, double t) {
      f[to] = (1 - t) * f[a] + t * f[b];
      w[to] = (1 - t) * w[a] + t * w[b];
    };
    for (std::size_t level = 1; level < count; ++level)
      for (std::size_t i = count - 1; i >= level; --i) step(i, i - 1, i, t1);
    for (std::size_t level = 1; level < count; ++level)
      for (std::size_t i = 0; i + level < count; ++i) step(i, i, i + 1, t0 / t1);
    double least = infinity, most = -infinity;
    for (std::size_t i = 0; i < count; ++i) {
      least = std::min(least, f[i] / w[i]);
      most = std::max(most, f[i] / w[i]);
    }
    return {least, most};
  }

  /// Writes the cells of the grid, their entries, and the tasks of crowded ones.
  void finish() {
    const auto count = toggles_.size();
    std::vector<std::uint32_t> first(count + 1, 0), order(pending_.size());
    for (const Pending& pending : pending_) ++first[pending.cell + 1];
    for (std::size_t k = 0; k < count; ++k) first[k + 1] += first[k];
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    for (std::size_t k = 0; k < pending_.size(); ++k) order[next[pending_[k].cell]++] = static_cast<std::uint32_t>(k);
    for (std::int32_t row = 0; row < grid_.rows; ++row) {
      bool parity = false;
      for (std::int32_t column = grid_.columns; column-- > 0;) {
        const std::size_t cell = at(row, column);
        parity ^= toggles_[cell] != 0;
        const std::span<const std::uint32_t> listed(order.data() + first[cell], first[cell + 1] - first[cell]);
        write_cell(row, column, parity, listed);
      }
    }
  }

  void write_cell(std::int32_t row, std::int32_t column, bool parity, std::span<const std::uint32_t> listed) {
    const std::size_t cell = grid_.first_cell + at(row, column);
    if (listed.empty()) {
      made_.cells_[cell] = Cell::make(parity ? Cell::inside : Cell::outside);
      return;
    }
    if (listed.size() > crowded && may_divide(listed.size())) {
      Task task{{column_from(column), column_from(column + 1), row_from(row), row_from(row + 1)},
                {},
                parity,
                cell,
                depth_ + 1};
      for (const std::uint32_t k : listed) task.items.push_back(pending_items_[k]);
      crowded_.push_back(std::move(task));
      return;
    }
    made_.cells_[cell] = Cell::make(parity ? Cell::list_inside : Cell::list, made_.entries_.size());
    for (const std::uint32_t k : listed) made_.entries_.push_back(pending_[k].entry);
    made_.entries_.back().is_last = 1;
  }

  /// Whether a finer grid may help: cells stay much larger than rounding, and coincident pieces do not multiply.
  bool may_divide(std::size_t entries) {
    if (depth_ >= 8 || 4 * entries > entry_budget_) return false;
    if (1 / grid_.per_u < 0x1p12 * rounding_.u || 1 / grid_.per_v < 0x1p12 * rounding_.v) return false;
    entry_budget_ -= 4 * entries;
    return true;
  }

  const std::vector<TrimPiece>& pieces_;
  std::vector<ParameterPoint> reach_;  ///< of each piece, with the rounding of coordinates
  ParameterPoint rounding_;
  std::size_t entry_budget_;
  RegionCells made_;
  std::vector<Task> crowded_;
  // The grid in work.
  Domain rectangle_;
  CellGrid grid_{};
  int depth_ = 0;
  PieceSamples samples_;
  std::vector<std::uint8_t> toggles_;  ///< `[row][column]`: whether the parity changes from here to the left
  std::vector<Pending> pending_;
  std::vector<Item> pending_items_;  ///< of each pending entry
};

RegionCells RegionCells::make(const std::vector<TrimPiece>& pieces, const Domain& domain, bool starts_inside) {
  return CellsBuilder(pieces, domain).build(domain, starts_inside);
}

}}  // namespace tessera::abi_0_1
