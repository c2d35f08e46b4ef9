// Meshes of uniform rates.

#include <algorithm>
#include <atomic>
#include <optional>
#include <string>

#include "base/impl_access.h"
#include "base/saturated.h"
#include "base/text.h"
#include "eval/patch_edits.h"
#include "eval/uniform_grid.h"
#include "kernel/table/kernel_table.h"
#include "parallel/call_progress.h"
#include "parallel/parallel_for.h"
#include "tess/bounds/task_size.h"
#include "tess/cells/parameter_map.h"
#include "tess/cells/patch_triangles.h"
#include "tess/cells/segments.h"
#include "tess/mesh/tessellation_impl.h"
#include "tess/plan/certified_plan.h"
#include "tess/write/mesh_views.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr double progress_ends[] = {0.7, 1};  // after the vertices, and after all else

Status invalid(std::string message) { return {StatusCode::invalid_argument, std::move(message)}; }

Status check_rate(int rate, const char* direction) {
  if (rate >= 1 && rate <= max_rate) return {};
  return invalid(std::string("rate ") + direction + " is " + std::to_string(rate) + ", it must be 1 to " +
                 std::to_string(max_rate));
}

Status check_vertices(std::size_t patches, Rates rates) {
  if (patches <= max_vertices / rates.vertices()) return {};
  return invalid(std::to_string(patches) + " patches at rates " + std::to_string(rates.u) + " x " +
                 std::to_string(rates.v) + " have " + std::to_string(patches * rates.vertices()) +
                 " vertices, 32-bit indices reach " + std::to_string(max_vertices));
}

std::vector<float> parameters(int rate) {
  const std::vector<double> exact = uniform_parameters(rate + 1);
  std::vector<float> rounded(exact.size());
  std::transform(exact.begin(), exact.end(), rounded.begin(), [](double t) { return static_cast<float>(t); });
  return rounded;
}

QuantityViews<float> vertex_views(const MeshViews& out) {
  QuantityViews<float> grid;
  grid.position = out.position;
  grid.normal = out.normal;
  return grid;
}

/// A plan from rates. Layout of the vertices: `[patch][iu][iv]`.
class UniformMesh final : public Tessellation::Impl {
 public:
  UniformMesh(const PatchSet& set, UniformGrid grid, const TessellationOptions& options)
      : grid_(std::move(grid)),
        rates_{grid_.rate_u(), grid_.rate_v()},
        quads_(options.quads),
        parameters_(options.parameters.value_or(VertexParameters::surface)),
        u_(parameters(rates_.u)),
        v_(parameters(rates_.v)),
        origin_(set.origin()),
        shapes_(set.patch_count()),
        first_triangle_(set.patch_count() + 1),
        first_quad_(options.quads ? set.patch_count() + 1 : 0),
        revision_(set.revision()) {
    (void)lay_out(impl_of(set));
  }

  MeshCapacity capacity() const override { return before(shapes_.size()); }
  MeshCapacity before(std::size_t patch) const override {
    return {saturated_product(patch, rates_.vertices()), lone_triangle(patch), quads_ ? first_quad_[patch] : 0};
  }

  Mesh allocate() const override { return empty_mesh(capacity(), origin_); }

  Status run(const PatchSet& set, const MeshViews& out, const Execution& execution) const override {
    if (Status status = check_views(out, capacity()); !status.ok()) return status;
    if (Status status = quads_ ? Status() : check_no_quads(out); !status.ok()) return status;
    if (Status status = check_shapes(set, shapes_); !status.ok()) return status;
    CallProgress progress(execution, progress_ends);
    if (Status status = grid_.run(set, vertex_views(out), progress.loops()); !status.ok()) return status;
    return progress.finish(write_rest(impl_of(set), out, progress.loops()));
  }

  Result<MeshChange> update(PatchSet& set, const PatchEdits& edits, const MeshViews& out,
                            const Execution& execution) override {
    PatchSet::Impl& inner = impl_of(set);
    std::atomic<bool> keeps_shapes = true;
    if (Status status = start(set, edits, out, keeps_shapes, execution); !status.ok()) return status;
    MeshChange change;
    if (keeps_shapes && inner.revision == revision_) {
      if (Status status = grid_.update(inner, edits, *edits_, vertex_views(out), execution); !status.ok())
        return status;
    } else {
      const auto pack = [&](std::size_t begin, std::size_t end) {
        for (const std::uint32_t block : edits_->blocks().subspan(begin, end - begin))
          pack_edits(inner, edits, *edits_, kernel::default_kernels(), block);
      };
      const Execution quiet{.cancel = execution.cancel};
      const Status packed = parallel_for(edits_->blocks().size(), blocks_per_task, quiet, pack);
      finish_edits(inner, edits);
      if (!packed.ok()) return packed;
      change.patches = lay_out(inner);
      change.topology = change.patches > 0;
      if (!change.topology)
        if (Status status = grid_.run(inner, vertex_views(out), execution); !status.ok()) return status;
    }
    revision_ = inner.revision;
    return change;
  }

 private:
  /// Finds where the triangles of each patch lie. Returns how many patches have other shapes than before.
  std::size_t lay_out(const PatchSet::Impl& set) {
    std::size_t changed = 0;
    for (std::size_t k = 0; k < shapes_.size(); ++k) {
      const PatchShape shape = PatchShape::of(set.patches[k], set.collapsed[k]);
      changed += !(shape == shapes_[k]);
      shapes_[k] = shape;
      first_triangle_[k + 1] = saturated_sum(first_triangle_[k], triangle_count(shape, rates_));
      if (quads_) first_quad_[k + 1] = saturated_sum(first_quad_[k], quad_count(shape, rates_));
    }
    return changed;
  }

  /// Checks an update and makes its memory; after an error the set's values and the views are as they were. Clears
  /// `keeps_shapes` if an edit changes which triangles its patch has.
  Status start(PatchSet& set, const PatchEdits& edits, const MeshViews& out, std::atomic<bool>& keeps_shapes,
               const Execution& execution) {
    if (Status status = check_updated_views(out, capacity()); !status.ok()) return status;
    if (Status status = quads_ ? Status() : check_no_quads(out); !status.ok()) return status;
    PatchSet::Impl& inner = impl_of(set);
    if (!edits_) edits_.emplace(inner);
    if (Status status = edits_->add(inner, edits); !status.ok()) return status;
    const auto compare = [&](std::uint32_t patch, std::span<const Vec3> points) {
      if (!(PatchShape::of(inner.patches[patch], points) == shapes_[patch])) keeps_shapes = false;
      return true;
    };
    const KeepsShape check(compare);
    return prepare_edits(inner, edits, *edits_, execution, &check);
  }

  /// Writes parameters, indices and patch numbers.
  Status write_rest(const PatchSet::Impl& set, const MeshViews& out, const Execution& execution) const {
    const ParameterMaps maps(set, parameters_);
    ExecutionReport report;
    Execution part{.cancel = execution.cancel, .progress = {}, .stores = execution.stores, .report = &report};
    if (execution.progress) part.progress = [&](double done) { execution.progress(done); };
    Status status = parallel_for(shapes_.size(), patches_per_task, part, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        if (!out.parameter.empty()) write_parameters(k, maps.of(k), out.parameter);
        write_faces(k, out);
      }
    });
    if (execution.report) execution.report->tasks += report.tasks;
    return status;
  }

  void write_faces(std::size_t k, const MeshViews& out) const {
    const auto first = static_cast<std::uint32_t>(k * rates_.vertices()), patch = static_cast<std::uint32_t>(k);
    const auto fill = [patch](std::span<std::uint32_t> numbers, std::size_t begin, std::size_t end) {
      if (!numbers.empty()) std::fill(numbers.data() + begin, numbers.data() + end, patch);
    };
    if (!quads_) {
      write_triangles(shapes_[k], rates_, first, out.indices.data() + 3 * first_triangle_[k]);
      return fill(out.patch, first_triangle_[k], first_triangle_[k + 1]);
    }
    write_quads(shapes_[k], rates_, first, out.indices.data() + 3 * lone_triangle(k),
                out.quads.data() + 4 * first_quad_[k]);
    fill(out.patch, lone_triangle(k), lone_triangle(k + 1));
    fill(out.quad_patch, first_quad_[k], first_quad_[k + 1]);
  }

  /// Returns the first triangle of a patch among those that are not half of a quad.
  std::size_t lone_triangle(std::size_t patch) const {
    return first_triangle_[patch] - (quads_ ? 2 * first_quad_[patch] : 0);
  }

  void write_parameters(std::size_t patch, const ParameterMap& map, const View2<float>& view) const {
    std::size_t vertex = patch * rates_.vertices();
    const auto write = [&](auto put) {
      for (const float u : u_)
        for (const float v : v_) put(vertex++, u, v);
    };
    map.with_put(view, write);
  }

  UniformGrid grid_;
  Rates rates_;
  bool quads_;
  VertexParameters parameters_;
  std::vector<float> u_, v_;
  Vec3 origin_;
  std::vector<PatchShape> shapes_;
  std::vector<std::size_t> first_triangle_;  ///< `[patch]`, and the number of all at the end
  std::vector<std::size_t> first_quad_;      ///< likewise; empty without quads
  std::uint64_t revision_;                   ///< the set's, of the last update
  std::optional<TouchedBlocks> edits_;       ///< made by the first update
};

}  // namespace

Result<std::unique_ptr<Tessellation::Impl>> make_uniform_mesh(const PatchSet& set, const TessellationOptions& options) {
  const UniformRates rates = *options.rates;
  if (options.tolerance || options.angle || options.pixels || options.budget || options.border_tolerance ||
      !options.surface_tolerances.empty())
    return invalid("there are both rates and a tolerance: set one of them");
  if (set.cut_count() > 0)
    return Status(StatusCode::unsupported, "uniform rates need whole patches, and trimming loops cut " +
                                               counted(set.cut_count(), "patch", "patches") +
                                               " of this set: set a tolerance, or make the set without trims");
  if (Status status = check_rate(rates.u, "u"); !status.ok()) return status;
  if (Status status = check_rate(rates.v, "v"); !status.ok()) return status;
  if (Status status = check_vertices(set.patch_count(), {rates.u, rates.v}); !status.ok()) return status;
  Result<UniformGrid> grid = UniformGrid::make(set, rates.u, rates.v, options.isa);
  if (!grid) return grid.status();
  return std::unique_ptr<Tessellation::Impl>(std::make_unique<UniformMesh>(set, *std::move(grid), options));
}

}}  // namespace tessera::abi_0_1
