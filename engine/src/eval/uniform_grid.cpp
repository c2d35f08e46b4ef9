#include "eval/uniform_grid.h"

#include <algorithm>

#include "basis/bernstein.h"
#include "block/patch_set_impl.h"
#include "eval/edited_grids.h"
#include "eval/grid_plan_impl.h"
#include "eval/patch_edits.h"
#include "eval/task_size.h"
#include "kernel/table/kernel_table.h"
#include "parallel/parallel_for.h"
#include "tessera/bezier_patch.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

// Weights of border curves, whose bits do not depend on the direction in which the curve runs.

/// Bernstein weights at k / rate, `[k][i]`: B_i = C(n,i) (t^i s^(n-i)) with t = k / rate and s = (rate - k) / rate, so
/// that B_i at k is B_{n-i} at rate - k, bit for bit.
AlignedVector<float> symmetric_weights(int degree, int rate) {
  AlignedVector<float> weights;
  weights.reserve(static_cast<std::size_t>((rate + 1) * (degree + 1)));
  for (int k = 0; k <= rate; ++k) {
    std::array<double, max_degree + 1> t{1}, s{1};
    for (std::size_t i = 1; i <= static_cast<std::size_t>(degree); ++i) {
      t[i] = t[i - 1] * (static_cast<double>(k) / rate);
      s[i] = s[i - 1] * (static_cast<double>(rate - k) / rate);
    }
    for (int i = 0; i <= degree; ++i)
      weights.push_back(static_cast<float>(binomial(degree, i) *
                                           (t[static_cast<std::size_t>(i)] * s[static_cast<std::size_t>(degree - i)])));
  }
  return weights;
}

/// Where one edge of a patch lies in its net and in its grid.
struct EdgePlace {
  Side edge;
  bool along_u;  ///< the curve's parameter is u
  bool at_end;   ///< the other parameter is 1
};
constexpr EdgePlace edge_places[] = {
    {Side::v0, true, false}, {Side::v1, true, true}, {Side::u0, false, false}, {Side::u1, false, true}};

/// Evaluates the borders of one block and writes them to the records of its patches.
class BorderWriter {
 public:
  BorderWriter(const PatchSet::Impl& set, const kernel::KernelTable& kernels, int rate_u, int rate_v,
               const View3<float>& out, std::span<const AlignedVector<float>> weights_u,
               std::span<const AlignedVector<float>> weights_v)
      : set_(set),
        kernels_(kernels),
        rate_u_(rate_u),
        rate_v_(rate_v),
        out_(out),
        weights_u_(weights_u),
        weights_v_(weights_v) {}

  /// `wanted`: a bit for each lane to write.
  void run(std::size_t block, std::uint32_t wanted = ~0u) const {
    const BlockGroup& group = set_.group_of_block(block);
    const float* net = set_.f32.bernstein.data() + group.first_value + (block - group.first_block) * group.block_values;
    const std::ptrdiff_t coefficient = (group.rational ? 4 : 3) * PatchSet::lanes;
    const std::ptrdiff_t row = coefficient * (group.degree_v + 1);
    for (const EdgePlace& place : edge_places) {
      kernel::BorderJob<float> job;
      job.degree = place.along_u ? group.degree_u : group.degree_v;
      job.control_step = place.along_u ? row : coefficient;
      job.control = net + (place.at_end ? (place.along_u ? coefficient * group.degree_v : row * group.degree_u) : 0);
      job.rational = group.rational;
      evaluate_edge(block, wanted, place, job);
    }
    for (std::size_t lane = 0; lane < set_.lane_counts[block]; ++lane)
      if (wanted >> lane & 1u) write_corners(set_.lane_patches[block * PatchSet::lanes + lane]);
  }

 private:
  static constexpr int piece = 64;  ///< points staged at once

  void evaluate_edge(std::size_t block, std::uint32_t wanted, const EdgePlace& place,
                     kernel::BorderJob<float> job) const {
    alignas(cache_line) std::array<float, static_cast<std::size_t>(piece) * 3 * PatchSet::lanes> stage;
    const float* weights = (place.along_u ? weights_u_ : weights_v_)[static_cast<std::size_t>(job.degree)].data();
    const int count = (place.along_u ? rate_u_ : rate_v_) + 1;
    job.position = stage.data();
    for (int first = 0; first < count; first += piece) {
      job.weights = weights + std::ptrdiff_t{first} * (job.degree + 1);
      job.count = std::min(piece, count - first);
      kernels_.border_f32(job);
      for (std::size_t lane = 0; lane < set_.lane_counts[block]; ++lane) {
        if (!(wanted >> lane & 1u)) continue;
        const std::uint32_t patch = set_.lane_patches[block * PatchSet::lanes + lane];
        if (!set_.collapsed[patch].has(place.edge)) write(patch, place, first, job.count, stage.data() + lane);
      }
    }
  }

  /// Points first .. first + count - 1 of an edge.
  void write(std::size_t patch, const EdgePlace& place, int first, int count, const float* stage) const {
    for (int k = first; k < first + count; ++k, stage += 3 * PatchSet::lanes) {
      const std::size_t at = record(patch, place, k);
      for (int c = 0; c < 3; ++c) out_.at(at, c) = stage[c * PatchSet::lanes];
    }
  }

  /// Corners and poles are the control points themselves: w p / w would depend on the weight.
  void write_corners(std::size_t patch) const {
    const BezierPatch& net = set_.patches[patch];
    for (const EdgePlace& place : edge_places) {
      const int i = place.at_end && !place.along_u ? net.degree_u() : 0,
                j = place.at_end && place.along_u ? net.degree_v() : 0;
      const int last = place.along_u ? rate_u_ : rate_v_;
      write_point(record(patch, place, 0), net.point(i, j));
      if (set_.collapsed[patch].has(place.edge))
        for (int k = 1; k <= last; ++k) write_point(record(patch, place, k), net.point(i, j));
    }
    write_point(record(patch, edge_places[1], rate_u_), net.point(net.degree_u(), net.degree_v()));
  }

  void write_point(std::size_t at, const Vec3& point) const {
    const Vec3 p = point - set_.origin + Vec3{};  // as packed: adding +0 turns -0 into +0
    out_.at(at, 0) = static_cast<float>(p.x);
    out_.at(at, 1) = static_cast<float>(p.y);
    out_.at(at, 2) = static_cast<float>(p.z);
  }

  /// The record of an edge's point k.
  std::size_t record(std::size_t patch, const EdgePlace& place, int k) const {
    const auto iu = static_cast<std::size_t>(place.along_u ? k : place.at_end ? rate_u_ : 0);
    const auto iv = static_cast<std::size_t>(place.along_u ? (place.at_end ? rate_v_ : 0) : k);
    return (patch * static_cast<std::size_t>(rate_u_ + 1) + iu) * static_cast<std::size_t>(rate_v_ + 1) + iv;
  }

  const PatchSet::Impl& set_;
  const kernel::KernelTable& kernels_;
  int rate_u_, rate_v_;
  const View3<float>& out_;
  std::span<const AlignedVector<float>> weights_u_, weights_v_;
};

}  // namespace

Result<UniformGrid> UniformGrid::make(const PatchSet& set, int rate_u, int rate_v, std::optional<Isa> isa) {
  const auto u = uniform_parameters(rate_u + 1), v = uniform_parameters(rate_v + 1);
  auto plan = GridPlan::make(set, u, v, {.isa = isa});
  if (!plan) return plan.status();
  UniformGrid grid(std::move(*plan), rate_u, rate_v);
  for (const BlockGroup& group : impl_of(set).groups) {
    auto& along_u = grid.border_weights_u_[static_cast<std::size_t>(group.degree_u)];
    auto& along_v = grid.border_weights_v_[static_cast<std::size_t>(group.degree_v)];
    if (along_u.empty()) along_u = symmetric_weights(group.degree_u, rate_u);
    if (along_v.empty()) along_v = symmetric_weights(group.degree_v, rate_v);
  }
  return grid;
}

Status UniformGrid::run(const PatchSet::Impl& set, const QuantityViews<float>& out, const Execution& execution) const {
  if (Status status = evaluate(set, plan_, out, execution); !status.ok()) return status;
  if (out.position.empty()) return {};
  const BorderWriter borders(set, kernel::kernels(plan_.isa()), rate_u_, rate_v_, out.position, border_weights_u_,
                             border_weights_v_);
  const std::size_t border_points = static_cast<std::size_t>(2 * (rate_u_ + rate_v_)) * PatchSet::lanes;
  const std::size_t grain = std::max<std::size_t>(1, 16384 / border_points);
  Execution quiet;  // progress and the report are evaluate()'s
  quiet.cancel = execution.cancel;
  return parallel_for(impl_of(plan_).block_count, grain, quiet, [&](std::size_t begin, std::size_t end) {
    for (std::size_t block = begin; block < end; ++block) borders.run(block);
  });
}

Status UniformGrid::update(PatchSet::Impl& set, const PatchEdits& edits, const TouchedBlocks& touched,
                           const QuantityViews<float>& out, const Execution& execution) const {
  const GridPlan::Impl& plan = impl_of(plan_);
  const kernel::KernelTable& kernels = kernel::kernels(plan.isa);
  const StageLayout<float> layout(out, plan.isa);
  const bool streaming = views_stream(layout, edits.patch.size() * plan.samples(), execution.stores);
  const UpdateCall call{set, plan, kernels, edits, touched, out.normal.empty() ? 0 : 1, streaming};
  const BorderWriter borders(set, kernels, rate_u_, rate_v_, out.position, border_weights_u_, border_weights_v_);
  const auto blocks = touched.blocks();
  const auto write = [&](std::size_t begin, std::size_t end) {
    EditedGrids<float> task(call, layout, out);
    for (std::size_t k = begin; k < end; ++k) task.add(blocks[k]);
    task.finish();
    for (std::size_t k = begin; k < end; ++k) {
      std::uint32_t wanted = 0;
      for (std::size_t lane = 0; lane < PatchSet::lanes; ++lane)
        if (touched.edits(blocks[k])[lane] != no_id) wanted |= 1u << lane;
      borders.run(blocks[k], wanted);
    }
  };
  const Status status =
      parallel_for(blocks.size(), blocks_per_task(plan, blocks.size(), call.order > 0), execution, write);
  finish_edits(set, edits);
  report_run(execution, plan.isa, streaming);
  return status;
}

}}  // namespace tessera::abi_0_1
