#include "tessera/evaluate.h"

#include <atomic>
#include <limits>
#include <mutex>

#include "base/internal_export.h"
#include "base/text.h"
#include "eval/parameter_grid.h"
#include "parallel/parallel_for.h"
#include "tessera/guard.h"
#include "tessera/parametric_surface.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Row i of the grid.
template <class T>
Status evaluate_row(const ParametricSurface& surface, double u, std::span<const double> v, std::size_t first,
                    const View3<T>& out) {
  for (std::size_t j = 0; j < v.size(); ++j) {
    const auto point = surface.position(u, v[j]);
    if (!point) return point.status();
    if (max_abs(*point) > static_cast<double>(std::numeric_limits<T>::max()))
      return {StatusCode::non_finite,
              "the surface at (u, v) = (" + text(u) + ", " + text(v[j]) + ") is too large for float"};
    out.at(first + j, 0) = static_cast<T>(point->x);
    out.at(first + j, 1) = static_cast<T>(point->y);
    out.at(first + j, 2) = static_cast<T>(point->z);
  }
  return {};
}

/// The error of the first row that has one.
class FirstError {
 public:
  bool is_before(std::size_t row) const { return row_.load(std::memory_order_relaxed) < row; }
  void add(std::size_t row, Status status) {
    const std::lock_guard lock(mutex_);
    if (row >= row_) return;
    row_ = row;
    status_ = std::move(status);
  }
  const Status& status() const { return status_; }

 private:
  std::atomic<std::size_t> row_{std::numeric_limits<std::size_t>::max()};
  std::mutex mutex_;
  Status status_;
};

template <class Row>
Status rows_on_one_thread(std::size_t count, const Execution& execution, Row&& row) {
  if (execution.report) execution.report->tasks = 1;
  for (std::size_t i = 0; i < count; ++i) {
    if (execution.cancel && execution.cancel->load(std::memory_order_relaxed))
      return {StatusCode::cancelled, "cancelled by the caller"};
    if (Status status = row(i); !status.ok()) return status;
    if (execution.progress && (i + 1) * 100 / count != i * 100 / count)
      execution.progress(static_cast<double>(i + 1) / static_cast<double>(count));
  }
  return {};
}

template <class Row>
Status rows_on_threads(std::size_t count, const Execution& execution, Row&& row) {
  FirstError error;
  const Status status = parallel_for(count, 1, execution, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (error.is_before(i)) return;
      if (Status failed = row(i); !failed.ok()) error.add(i, std::move(failed));
    }
  });
  return status.ok() ? error.status() : status;
}

template <class T>
Status evaluate_grid(const ParametricSurface& surface, std::span<const double> u, std::span<const double> v,
                     const View3<T>& out, const Execution& execution, Calls calls) {
  const Domain& domain = surface.domain();
  if (Status status = check_parameters(u, "u", domain.u0, domain.u1); !status.ok()) return status;
  if (Status status = check_parameters(v, "v", domain.v0, domain.v1); !status.ok()) return status;
  if (Status status = check_view(out, u, v); !status.ok()) return status;
  const auto row = [&](std::size_t i) { return evaluate_row(surface, u[i], v, i * v.size(), out); };
  return calls == Calls::concurrent ? rows_on_threads(u.size(), execution, row)
                                    : rows_on_one_thread(u.size(), execution, row);
}

}  // namespace

template <class T>
Status evaluate(const ParametricSurface& surface, std::span<const double> u, std::span<const double> v,
                const View3<T>& out, const Execution& execution, Calls calls) {
  return guarded([&] { return evaluate_grid(surface, u, v, out, execution, calls); });
}
template TESSERA_EXPORT Status evaluate(const ParametricSurface&, std::span<const double>, std::span<const double>,
                                        const View3<float>&, const Execution&, Calls);
template TESSERA_EXPORT Status evaluate(const ParametricSurface&, std::span<const double>, std::span<const double>,
                                        const View3<double>&, const Execution&, Calls);

}}  // namespace tessera::abi_0_1
