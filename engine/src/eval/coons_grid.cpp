#include "tessera/evaluate.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>

#include "base/aligned.h"
#include "base/internal_export.h"
#include "eval/parameter_grid.h"
#include "eval/task_size.h"
#include "kernel/table/kernel_table.h"
#include "parallel/parallel_for.h"
#include "surface/callable/border_curve.h"
#include "tessera/coons_patch.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Below so many points one thread is faster than waking another.
constexpr std::size_t serial_points = 32768;

/// Samples of the borders for each u and for each v, in the layout of kernel::BlendJob.
template <class T>
class Samples {
 public:
  Samples(std::size_t count_u, std::size_t count_v)
      : count_v_(count_v), step_((count_v + 15) / 16 * 16), rows_(count_u * 8, T(0)), columns_(step_ * 8, T(0)) {}

  /// Row i: g1 C1 + g2 C2 + f1 K1 + f2 K2, of which C and f are given.
  void set_row(std::size_t i, const std::array<Vec3, 2>& c, const std::array<double, 2>& f) {
    const double values[] = {c[0].x, c[0].y, c[0].z, c[1].x, c[1].y, c[1].z, f[0], f[1]};
    for (std::size_t k = 0; k < 8; ++k) rows_[8 * i + k] = static_cast<T>(values[k]);
    for (std::size_t a = 0; a < 2; ++a) {
      largest_c_ = std::max(largest_c_, max_abs(c[a]));
      largest_f_ = std::max(largest_f_, std::abs(f[a]));
    }
  }
  /// Column j, of which g and K are given.
  void set_column(std::size_t j, const std::array<double, 2>& g, const std::array<Vec3, 2>& k) {
    const double values[] = {g[0], g[1], k[0].x, k[0].y, k[0].z, k[1].x, k[1].y, k[1].z};
    for (std::size_t e = 0; e < 8; ++e) columns_[e * step_ + j] = static_cast<T>(values[e]);
    for (std::size_t a = 0; a < 2; ++a) {
      largest_g_ = std::max(largest_g_, std::abs(g[a]));
      largest_k_ = std::max(largest_k_, max_abs(k[a]));
    }
  }

  /// No partial sum leaves the range of T. Errors: non_finite.
  Status check_range() const {
    const double bound = 2 * largest_g_ * largest_c_ + 2 * largest_f_ * largest_k_;
    if (bound <= 0.999 * static_cast<double>(std::numeric_limits<T>::max())) return {};
    return {StatusCode::non_finite, std::string("the surface's coordinates may be as large as ") + text(bound) +
                                        ", too large for " + (sizeof(T) == 4 ? "float" : "double")};
  }

  /// Rows begin .. end, into the whole grid's view.
  kernel::BlendJob<T> job(std::size_t begin, std::size_t end, const View3<T>& out) const {
    kernel::BlendJob<T> job;
    job.rows = &rows_[8 * begin];
    job.columns = columns_.data();
    job.column_step = static_cast<std::ptrdiff_t>(step_);
    job.row_count = static_cast<std::ptrdiff_t>(end - begin);
    job.column_count = static_cast<std::ptrdiff_t>(count_v_);
    for (std::size_t c = 0; c < 3; ++c) job.out[c] = &out.at(begin * count_v_, static_cast<int>(c));
    job.stride = out.stride;
    return job;
  }

 private:
  std::size_t count_v_, step_;
  AlignedVector<T> rows_, columns_;
  double largest_c_ = 0, largest_f_ = 0, largest_g_ = 0, largest_k_ = 0;
};

Status sample_pair(const BorderCurve& first, const char* first_name, const BorderCurve& second, const char* second_name,
                   double t, std::array<Vec3, 2>& points) {
  const auto a = position(first, t, first_name);
  if (!a) return a.status();
  const auto b = position(second, t, second_name);
  if (!b) return b.status();
  points = {*a, *b};
  return {};
}

/// C_b and f_a for each u; g_b and K_a = D_a - r_a0 g1 - r_a1 g2 for each v.
template <class T>
Status sample(const CoonsPatch& patch, std::span<const double> u, std::span<const double> v, Samples<T>& samples) {
  const CoonsBorders& b = patch.borders();
  const Domain d = patch.domain();
  std::array<Vec3, 2> points;
  for (std::size_t i = 0; i < u.size(); ++i) {
    Status status = sample_pair(b.c1, coons_border_names[0], b.c2, coons_border_names[1], u[i], points);
    if (!status.ok()) return status;
    const auto f = patch.f().values_at(d.local_u(u[i]));
    if (!f) return f.status();
    samples.set_row(i, points, *f);
  }
  for (std::size_t j = 0; j < v.size(); ++j) {
    Status status = sample_pair(b.d1, coons_border_names[2], b.d2, coons_border_names[3], v[j], points);
    if (!status.ok()) return status;
    const auto g = patch.g().values_at(d.local_v(v[j]));
    if (!g) return g.status();
    for (int a = 0; a < 2; ++a) {
      Vec3& point = points[static_cast<std::size_t>(a)];
      point = point - ((*g)[0] * patch.corner(a, 0) + (*g)[1] * patch.corner(a, 1));
    }
    samples.set_column(j, *g, points);
  }
  return {};
}

/// The curves for each parameter along them, their shares for each across.
template <class T>
Status sample(const RuledSurface& surface, std::span<const double> u, std::span<const double> v, Samples<T>& samples) {
  const bool along_u = surface.straight() == Direction::v;
  const Domain d = surface.domain();
  const double from = along_u ? d.v0 : d.u0, to = along_u ? d.v1 : d.u1;
  const std::span<const double> along = along_u ? u : v, across = along_u ? v : u;
  for (std::size_t i = 0; i < along.size(); ++i) {
    std::array<Vec3, 2> points;
    Status status =
        sample_pair(surface.first(), ruled_curve_names[0], surface.second(), ruled_curve_names[1], along[i], points);
    if (!status.ok()) return status;
    along_u ? samples.set_row(i, points, {}) : samples.set_column(i, {}, points);
  }
  for (std::size_t j = 0; j < across.size(); ++j) {
    const std::array<double, 2> shares{(to - across[j]) / (to - from), (across[j] - from) / (to - from)};
    along_u ? samples.set_column(j, shares, {}) : samples.set_row(j, {}, shares);
  }
  return {};
}

Isa run(const kernel::KernelTable& kernels, const kernel::BlendJob<float>& job) { return kernels.blend_f32(job); }
Isa run(const kernel::KernelTable& kernels, const kernel::BlendJob<double>& job) { return kernels.blend_f64(job); }

template <class Surface, class T>
Status evaluate_grid(const Surface& surface, std::span<const double> u, std::span<const double> v, const View3<T>& out,
                     const Execution& execution) {
  const Domain domain = surface.domain();
  if (Status status = check_parameters(u, "u", domain.u0, domain.u1); !status.ok()) return status;
  if (Status status = check_parameters(v, "v", domain.v0, domain.v1); !status.ok()) return status;
  if (Status status = check_view(out, u, v); !status.ok()) return status;
  const auto isa = default_isa();
  if (!isa) return isa.status();
  Samples<T> samples(u.size(), v.size());
  if (Status status = sample(surface, u, v, samples); !status.ok()) return status;
  if (Status status = samples.check_range(); !status.ok()) return status;
  const auto& kernels = kernel::kernels(*isa);
  const bool serial = u.size() * v.size() <= serial_points;
  const std::size_t grain = serial ? u.size() : std::max<std::size_t>(1, points_per_task / v.size());
  std::atomic<Isa> ran{*isa};
  Status status = parallel_for(u.size(), grain, execution, [&](std::size_t begin, std::size_t end) {
    ran.store(run(kernels, samples.job(begin, end, out)), std::memory_order_relaxed);
  });
  if (execution.report != nullptr) {
    execution.report->isa = ran;
    execution.report->streaming = false;
  }
  return status;
}

}  // namespace

template <class T>
Status evaluate(const CoonsPatch& patch, std::span<const double> u, std::span<const double> v, const View3<T>& out,
                const Execution& execution) {
  return guarded([&] { return evaluate_grid(patch, u, v, out, execution); });
}
template TESSERA_EXPORT Status evaluate(const CoonsPatch&, std::span<const double>, std::span<const double>,
                                        const View3<float>&, const Execution&);
template TESSERA_EXPORT Status evaluate(const CoonsPatch&, std::span<const double>, std::span<const double>,
                                        const View3<double>&, const Execution&);

template <class T>
Status evaluate(const RuledSurface& surface, std::span<const double> u, std::span<const double> v, const View3<T>& out,
                const Execution& execution) {
  return guarded([&] { return evaluate_grid(surface, u, v, out, execution); });
}
template TESSERA_EXPORT Status evaluate(const RuledSurface&, std::span<const double>, std::span<const double>,
                                        const View3<float>&, const Execution&);
template TESSERA_EXPORT Status evaluate(const RuledSurface&, std::span<const double>, std::span<const double>,
                                        const View3<double>&, const Execution&);

}}  // namespace tessera::abi_0_1
