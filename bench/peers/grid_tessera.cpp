// The grid by Tessera: splits the surface into Bezier patches once; then evaluates every patch with one plan.

#include "grid_tessera.h"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <memory>

#include "base/aligned.h"
#include "peers/interleaved.h"
#include "support/synthetic_sets.h"
#include "tessera/convert.h"
#include "tessera/evaluate.h"
#include "tessera/model.h"

namespace tessera::bench {
namespace {

using test::value_of;

PatchSet set_of(const BSplineSurface& surface, bool in_double) {
  const PatchGrid grid = value_of(to_bezier(surface));
  PatchSetOptions options;
  options.blocks.float_bernstein = !in_double;
  options.blocks.double_bernstein = in_double;
  return value_of(make_patch_set({&grid, 1}, options));
}

template <class T>
class Evaluation {
 public:
  Evaluation(const GridTask& task, const BSplineSurface& surface, bool blocks)
      : task_(task),
        blocks_(blocks),
        set_(set_of(surface, sizeof(T) == 8)),
        plan_(value_of(GridPlan::make(
            set_, task.local, task.local,
            {.precision = sizeof(T) == 4 ? Precision::single_precision : Precision::double_precision}))) {
    const std::size_t values = blocks ? plan_.block_capacity() : 3 * plan_.capacity();
    for (AlignedVector<T>* memory : {&position_, &du_, &dv_})
      if (memory == &position_ || task.tangents) memory->assign(values, T(0));
  }

  double run() {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    tbb::task_arena arena(1);
    return arena.execute([&] { return seconds_of([&] { evaluate_all(); }); });
  }

  GridValue read(std::size_t i, std::size_t j) const {
    GridValue value{at(position_, i, j), {}, {}};
    if (sizeof(T) == 4) value.position += set_.origin();
    if (task_.tangents) {
      value.du = at(du_, i, j);
      value.dv = at(dv_, i, j);
    }
    return value;
  }

 private:
  void evaluate_all() {
    Status status;
    if (blocks_) {
      QuantityBlocks<T> out;
      out.position = position_;
      out.du = du_;
      out.dv = dv_;
      status = evaluate(set_, plan_, out);
    } else {
      QuantityViews<T> out;
      out.position = View3<T>::interleaved(position_);
      if (task_.tangents) {
        out.du = View3<T>::interleaved(du_);
        out.dv = View3<T>::interleaved(dv_);
      }
      status = evaluate(set_, plan_, out);
    }
    if (!status.ok()) (void)value_of(Result<int>(status));
  }

  Vec3 at(const AlignedVector<T>& memory, std::size_t i, std::size_t j) const {
    const auto n = static_cast<std::size_t>(task_.per_span), samples = n * n;
    const std::size_t patch = i / n * static_cast<std::size_t>(task_.spans) + j / n, sample = i % n * n + j % n;
    const T* p = memory.data() + 3 * (patch * samples + sample);
    if (!blocks_) return {p[0], p[1], p[2]};
    const PatchSet::Slot slot = set_.slot(patch);
    p = memory.data() + (slot.block * samples + sample) * 3 * PatchSet::lanes + slot.lane;
    return {p[0], p[PatchSet::lanes], p[2 * PatchSet::lanes]};
  }

  const GridTask& task_;
  bool blocks_;
  PatchSet set_;
  GridPlan plan_;
  AlignedVector<T> position_, du_, dv_;
};

template <class T>
GridRun run_of(const GridTask& task, const BSplineSurface& surface, bool blocks) {
  const auto work = std::make_shared<Evaluation<T>>(task, surface, blocks);
  return {"Tessera " TESSERA_VERSION, blocks ? "blocks of 16 patches" : "x y z interleaved", sizeof(T) == 8,
          [=] { return work->run(); }, [=](std::size_t i, std::size_t j) { return work->read(i, j); }};
}

}  // namespace

BSplineSurface surface_of(const GridTask& task) {
  std::vector<double> knots;
  for (int k = -3; k <= task.spans + 3; ++k) knots.push_back(k);
  return value_of(BSplineSurface::polynomial(3, knots, 3, knots, task.net));
}

std::vector<GridRun> tessera_runs(const GridTask& task) {
  const BSplineSurface surface = surface_of(task);
  return {run_of<float>(task, surface, true), run_of<float>(task, surface, false), run_of<double>(task, surface, true),
          run_of<double>(task, surface, false)};
}

}  // namespace tessera::bench
