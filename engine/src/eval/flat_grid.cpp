#include "eval/flat_grid.h"

#include <algorithm>
#include <array>

#include "eval/task_size.h"
#include "parallel/parallel_for.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t lanes = kernel::flat_lanes, group_rows = kernel::flat_rows;

/// Returns the weights of the rows as `[group][i][lane]`, from a table `[k][order][i]`.
AlignedVector<float> weights_of_rows(std::span<const float> weights, std::size_t rows, std::size_t count) {
  AlignedVector<float> table((rows + group_rows - 1) / group_rows * count * lanes, 0);
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t i = 0; i < count; ++i)
      std::fill_n(table.data() + (row / group_rows * count + i) * lanes + 3 * (row % group_rows), 3,
                  weights[row * 3 * count + i]);
  return table;
}

/// Returns the weights of the numbers of a row as `[vector][j][lane]`, from a table `[k][order][i]`.
AlignedVector<float> weights_of_columns(std::span<const float> weights, std::size_t columns, std::size_t count) {
  AlignedVector<float> table((3 * columns + lanes - 1) / lanes * count * lanes, 0);
  for (std::size_t value = 0; value < 3 * columns; ++value)
    for (std::size_t j = 0; j < count; ++j)
      table[(value / lanes * count + j) * lanes + value % lanes] = weights[value / 3 * 3 * count + j];
  return table;
}

/// Whether the flat kernel is faster than the grid kernel. Each row begins with a new vector, so the last vector of a
/// row is partly empty; a last block is partly empty too. The flat kernel pays if it wastes at most 15%, by timings of
/// rows of all lengths, or less than the blocks do. Results do not depend on the choice.
bool pays(const GridPlan::Impl& plan) {
  constexpr double max_waste = 1.15;
  const std::size_t values = 3 * plan.count_v, vectors = (values + lanes - 1) / lanes;
  const double waste = static_cast<double>(vectors * lanes) / static_cast<double>(values);
  const double idle = static_cast<double>(plan.block_count * PatchSet::lanes) / static_cast<double>(plan.patch_count);
  return plan.count_v >= lanes && (waste <= max_waste || waste < idle);
}

/// A run of patches of one group, which the kernel takes together.
class FlatRun {
 public:
  FlatRun(const PatchSet::Impl& set, const GridPlan::Impl& plan, float* out, bool streaming)
      : set_(set), plan_(plan), kernels_(kernel::kernels(plan.isa)), out_(out) {
    job_.nets = nets_.data();
    job_.count_v = static_cast<int>(plan.count_v);
    job_.patch_step = static_cast<std::ptrdiff_t>(3 * plan.samples());
    job_.streaming = streaming;
  }

  /// Adds rows of one patch; `first_row` is a multiple of group_rows. Whole patches wait until the kernel can take many
  /// of them at once.
  void add(std::size_t patch, std::size_t first_row, std::size_t rows) {
    const PatchSet::Slot slot = set_.slots[patch];
    if (group_ == nullptr || slot.block - group_->first_block >= group_->block_count) {
      flush();
      group_ = &set_.group_of_block(slot.block);
    }
    if (job_.patches == 0) start(patch, first_row, rows);
    nets_[static_cast<std::size_t>(job_.patches++)] =
        set_.f32.of(plan_.options.representation).data() + group_->first_value +
        (slot.block - group_->first_block) * group_->block_values + slot.lane;
    if (rows != plan_.count_u || static_cast<std::size_t>(job_.patches) == nets_.size()) flush();
  }
  /// Evaluates the patches that wait. Returns the instruction set that ran last.
  Isa finish() {
    flush();
    if (job_.streaming) kernels_.finish_streaming();
    return isa_;
  }

 private:
  void start(std::size_t patch, std::size_t first_row, std::size_t rows) {
    job_.degree_u = group_->degree_u;
    job_.degree_v = group_->degree_v;
    job_.count_u = static_cast<int>(rows);
    job_.u_weights = plan_.flat.u[static_cast<std::size_t>(group_->degree_u)].data() +
                     first_row / group_rows * static_cast<std::size_t>(group_->degree_u + 1) * lanes;
    job_.v_weights = plan_.flat.v[static_cast<std::size_t>(group_->degree_v)].data();
    job_.out = out_ + 3 * (patch * plan_.samples() + first_row * plan_.count_v);
  }
  void flush() {
    if (job_.patches > 0) isa_ = kernels_.flat_f32(job_);
    job_.patches = 0;
  }

  const PatchSet::Impl& set_;
  const GridPlan::Impl& plan_;
  const kernel::KernelTable& kernels_;
  float* out_;
  const BlockGroup* group_ = nullptr;
  Isa isa_ = Isa::sse2;
  kernel::FlatJob job_;
  std::array<const float*, 64> nets_;
};

}  // namespace

void tabulate_flat(const PatchSet::Impl& set, GridPlan::Impl& plan) {
  const bool polynomial = std::ranges::none_of(set.groups, [](const BlockGroup& group) { return group.rational; });
  if (plan.by_patch || !polynomial || !pays(plan) || kernel::kernels(plan.isa).flat_f32 == nullptr) return;
  for (const BlockGroup& group : set.groups) {
    const auto degree_u = static_cast<std::size_t>(group.degree_u), degree_v = static_cast<std::size_t>(group.degree_v);
    if (auto& table = plan.flat.u[degree_u]; table.empty())
      table = weights_of_rows(plan.f32.u[degree_u], plan.count_u, degree_u + 1);
    if (auto& table = plan.flat.v[degree_v]; table.empty())
      table = weights_of_columns(plan.f32.v[degree_v], plan.count_v, degree_v + 1);
  }
  plan.is_flat = true;
}

Status evaluate_flat(const PatchSet::Impl& set, const GridPlan::Impl& plan, float* out, bool streaming,
                     const Execution& execution) {
  // A task takes many patches, or some rows of one.
  std::size_t rows = plan.count_u, grain = items_per_task(plan.patch_count, plan.samples());
  if (plan.samples() * plan.patch_count <= serial_positions) {
    grain = plan.patch_count;
  } else if (plan.samples() > 2 * points_per_task) {
    rows = std::max<std::size_t>(1, points_per_task / plan.count_v / group_rows) * group_rows;
  }
  const std::size_t parts = (plan.count_u + rows - 1) / rows;
  std::atomic<Isa> isa{plan.isa};
  Status status = parallel_for(plan.patch_count * parts, grain, execution, [&](std::size_t begin, std::size_t end) {
    FlatRun run(set, plan, out, streaming);
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t first = k % parts * rows;
      run.add(k / parts, first, std::min(rows, plan.count_u - first));
    }
    isa.store(run.finish(), std::memory_order_relaxed);
  });
  report_run(execution, isa, streaming);
  return status;
}

}}  // namespace tessera::abi_0_1
