// Evaluates scattered samples, on threads. All samples are checked before the first one is evaluated; then each task
// evaluates chunk after chunk.

#include "base/internal_export.h"
#include "tessera/evaluate.h"

#include <algorithm>
#include <atomic>

#include "base/impl_access.h"
#include "base/text.h"
#include "eval/point_chunk.h"
#include "eval/point_sources.h"
#include "kernel/table/kernel_table.h"
#include "parallel/parallel_for.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Below these many samples one thread is faster than waking another.
constexpr std::size_t serial_positions = 4096, serial_normals = 2048;

/// Checks options and views. Sets `order` to the highest order of the derivatives that the outputs need.
template <class T, class Source>
Status check_call(const Source& source, const QuantityViews<T>& out, const PointOptions& options, int& order) {
  if (!source.lengths_fit())
    return Status(StatusCode::count_mismatch,
                  "every list of these samples must hold at least " + counted(source.count(), "record"));
  const auto fraction = [](double value) { return value >= 0 && value < 1; };
  if (!fraction(options.geometry.min_sine) || !fraction(options.geometry.umbilic_tolerance))
    return Status(StatusCode::invalid_argument, "min_sine and umbilic_tolerance must lie in [0, 1), they are " +
                                                    text(options.geometry.min_sine) + " and " +
                                                    text(options.geometry.umbilic_tolerance));
  ViewChecks checks(source.count());
  order = -1;
  for_each_quantity([&](const auto& output) {
    const auto& view = output.of(out);
    const bool wanted = std::ranges::any_of(view.component, [](const auto* memory) { return memory != nullptr; });
    if (!wanted) return;
    checks.add(output.name, view);
    order = std::max(order, output.order);
  });
  if (source.count() > 0) source.check_views(checks);
  if (Status status = checks.status(); !status.ok()) return status;
  return order < 0 ? Status(StatusCode::invalid_argument, "all output views are empty: at least one must have memory")
                   : Status();
}

/// Returns the error of the first sample that cannot be evaluated, the same one for any number of threads.
template <class Source>
Status check_samples(const Source& source, const kernel::KernelTable& kernels, std::size_t grain,
                     const Execution& execution) {
  std::atomic<std::size_t> failed{source.count()};
  const Execution checking{.cancel = execution.cancel};
  Status status = parallel_for(source.count(), grain, checking, [&](std::size_t begin, std::size_t end) {
    if (begin >= failed.load(std::memory_order_relaxed)) return;
    const Status found = source.check(begin, end, kernels);
    if (found.ok()) return;
    const auto sample = static_cast<std::size_t>(found.index());
    std::size_t first = failed;
    while (sample < first && !failed.compare_exchange_weak(first, sample)) continue;
  });
  if (!status.ok() || failed == source.count()) return status;
  return source.check(failed, failed + 1, kernels);
}

template <class T, class Source>
Status run(const PatchSet::Impl& set, const Source& source, const QuantityViews<T>& out, const PointOptions& options,
           const Execution& execution) {
  int order = 0;
  if (Status status = check_call(source, out, options, order); !status.ok()) return status;
  const Result<Isa> isa = usable_isa(options.isa);
  if (!isa || source.count() == 0) return isa.status();
  const std::size_t capacity = ChunkSamples<T>::capacity;
  const bool serial = source.count() <= (order > 0 ? serial_normals : serial_positions);
  const std::size_t grain = serial ? std::max<std::size_t>(source.count(), 1) : capacity;
  const kernel::KernelTable& kernels = kernel::kernels(*isa);
  if (Status status = check_samples(source, kernels, 8 * grain, execution); !status.ok()) return status;

  const auto coefficients = set.points<T>(execution.cancel);
  if (!coefficients) return coefficients.status();
  const PointCall<T> call{set, **coefficients, kernels, out, options.geometry};
  std::atomic<Isa> ran{*isa};
  Status status = parallel_for(source.count(), grain, execution, [&](std::size_t begin, std::size_t end) {
    PointChunk<T> chunk(call);
    for (; begin < end; begin += capacity) {
      auto& samples = chunk.samples();
      samples.begin = begin;
      samples.count = std::min(capacity, end - begin);
      source.fill(begin, samples.count, call.kernels, samples);
      ran.store(chunk.run(), std::memory_order_relaxed);
    }
  });
  if (execution.report) {
    execution.report->isa = ran;
    execution.report->streaming = false;
  }
  return status;
}

}  // namespace

template <class T>
Status evaluate(const PatchSet& set, const PatchSamples<T>& samples, const QuantityViews<T>& out,
                const PointOptions& options, const Execution& execution) {
  return guarded([&] {
    return run(impl_of(set), SamplesByPatch<T>(impl_of(set), samples, options.outside), out, options, execution);
  });
}
template TESSERA_EXPORT Status evaluate(const PatchSet&, const PatchSamples<float>&, const QuantityViews<float>&,
                                        const PointOptions&, const Execution&);
template TESSERA_EXPORT Status evaluate(const PatchSet&, const PatchSamples<double>&, const QuantityViews<double>&,
                                        const PointOptions&, const Execution&);

template <class T>
Status evaluate(const PatchSet& set, const SurfaceMap& map, const SurfaceSamples& samples, const QuantityViews<T>& out,
                const PointOptions& options, const Execution& execution) {
  return guarded([&]() -> Status {
    if (impl_of(map).patch_count != set.patch_count() || map.surface_count() != set.surface_count())
      return Status(StatusCode::stale, "the surface map was made for " + counted(map.surface_count(), "surface") +
                                           " of " + counted(impl_of(map).patch_count, "patch", "patches") +
                                           ", this set has " + counted(set.surface_count(), "surface") + " of " +
                                           counted(set.patch_count(), "patch", "patches") + "; make a new map");
    return run(impl_of(set), SamplesBySurface<T>(impl_of(map), samples, options.outside), out, options, execution);
  });
}
template TESSERA_EXPORT Status evaluate(const PatchSet&, const SurfaceMap&, const SurfaceSamples&,
                                        const QuantityViews<float>&, const PointOptions&, const Execution&);
template TESSERA_EXPORT Status evaluate(const PatchSet&, const SurfaceMap&, const SurfaceSamples&,
                                        const QuantityViews<double>&, const PointOptions&, const Execution&);

}}  // namespace tessera::abi_0_1
