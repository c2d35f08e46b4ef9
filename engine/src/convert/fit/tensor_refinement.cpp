#include "convert/fit/tensor_refinement.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "base/text.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The intervals between breakpoints of one direction.
struct Line {
  std::vector<double> breaks;
  std::vector<char> halve = std::vector<char>(breaks.size() - 1);  // 1: halve this interval next

  std::size_t count() const { return breaks.size() - 1; }
  std::size_t halved_count() const {
    return count() + static_cast<std::size_t>(std::count(halve.begin(), halve.end(), 1));
  }
  bool is_shorter(std::size_t k, double shortest) const {
    const double a = breaks[k], b = breaks[k + 1];
    return (b - a) / 2 < shortest * std::max(std::abs(a), std::abs(b)) || !std::isnormal((b - a) / 2);
  }
  /// Halves the marked intervals. Returns for each new interval the old one that it equals, or nothing if it is new.
  std::vector<std::optional<std::size_t>> apply() {
    std::vector<std::optional<std::size_t>> origin;
    std::vector<double> halved{breaks.front()};
    for (std::size_t k = 0; k < count(); ++k) {
      if (halve[k]) {
        halved.push_back(breaks[k] + (breaks[k + 1] - breaks[k]) / 2);
        origin.insert(origin.end(), 2, std::nullopt);
      } else {
        origin.emplace_back(k);
      }
      halved.push_back(breaks[k + 1]);
    }
    breaks = std::move(halved);
    halve.assign(count(), 0);
    return origin;
  }
};

class Refinement {
 public:
  Refinement(std::vector<double> u, std::vector<double> v, const RefinementLimits& limits)
      : limits_(limits), u_{std::move(u)}, v_{std::move(v)}, errors_(u_.count() * v_.count()) {}

  Result<TensorBreaks> run(CellErrorFunction error) {
    for (;;) {
      if (Status status = measure(error); !status.ok()) return status;
      bool marked = false;
      for (std::size_t a = 0; a < u_.count(); ++a)
        for (std::size_t b = 0; b < v_.count(); ++b) {
          const auto more = mark(a, b);
          if (!more) return more.status();
          marked = marked || *more;
        }
      const std::size_t cell = worst();
      const bool full = u_.halved_count() > limits_.largest_count / v_.halved_count();
      if (!marked || (full && errors_[cell]->total <= limits_.tolerance))
        return TensorBreaks{u_.breaks, v_.breaks, errors_[cell]->total};
      if (full)
        return failure("by " + std::to_string(limits_.largest_count) + " patches, the largest count", cell / v_.count(),
                       cell % v_.count());
      halve();
    }
  }

 private:
  Domain cell(std::size_t a, std::size_t b) const {
    return {u_.breaks[a], u_.breaks[a + 1], v_.breaks[b], v_.breaks[b + 1]};
  }

  Status measure(CellErrorFunction error) {
    for (std::size_t a = 0; a < u_.count(); ++a)
      for (std::size_t b = 0; b < v_.count(); ++b) {
        auto& known = errors_[a * v_.count() + b];
        if (known) continue;
        const auto measured = error(cell(a, b));
        if (!measured) return measured.status();
        known = *measured;
      }
    return {};
  }

  /// Marks the cell's intervals for halving and returns whether it did.
  Result<bool> mark(std::size_t a, std::size_t b) {
    const CellError& error = *errors_[a * v_.count() + b];
    if (error.total <= limits_.accepted) return false;
    const double half = limits_.accepted / 2;
    const bool by_u = error.along_u >= error.along_v || error.along_u > half;
    const bool by_v = error.along_v > error.along_u || error.along_v > half;
    const bool short_u = by_u && u_.is_shorter(a, limits_.shortest),
               short_v = by_v && v_.is_shorter(b, limits_.shortest);
    if (short_u || short_v) {
      if (error.total <= limits_.tolerance) return false;
      return failure(short_u ? "on the shortest interval of u" : "on the shortest interval of v", a, b);
    }
    if (by_u) u_.halve[a] = 1;
    if (by_v) v_.halve[b] = 1;
    return true;
  }

  void halve() {
    const std::size_t old_columns = v_.count();
    const auto from_u = u_.apply(), from_v = v_.apply();
    std::vector<std::optional<CellError>> errors(from_u.size() * from_v.size());
    for (std::size_t a = 0; a < from_u.size(); ++a)
      for (std::size_t b = 0; b < from_v.size(); ++b)
        if (from_u[a] && from_v[b]) errors[a * from_v.size() + b] = errors_[*from_u[a] * old_columns + *from_v[b]];
    errors_ = std::move(errors);
  }

  std::size_t worst() const {
    const auto less = [](const auto& x, const auto& y) { return x->total < y->total; };
    return static_cast<std::size_t>(std::max_element(errors_.begin(), errors_.end(), less) - errors_.begin());
  }

  Status failure(const std::string& limit, std::size_t a, std::size_t b) const {
    const Domain d = cell(a, b);
    return {StatusCode::invalid_argument, "the tolerance " + text(limits_.tolerance) + " is not kept " + limit +
                                              ": the error is " + text(errors_[a * v_.count() + b]->total) + " on [" +
                                              text(d.u0) + ", " + text(d.u1) + "] x [" + text(d.v0) + ", " +
                                              text(d.v1) + "]"};
  }

  const RefinementLimits& limits_;
  Line u_, v_;
  std::vector<std::optional<CellError>> errors_;  // [a][b]; nothing for new cells
};

}  // namespace

Result<TensorBreaks> refine(std::vector<double> u, std::vector<double> v, const RefinementLimits& limits,
                            CellErrorFunction error) {
  return Refinement(std::move(u), std::move(v), limits).run(error);
}

}}  // namespace tessera::abi_0_1
