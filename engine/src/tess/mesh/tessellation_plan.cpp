#include <algorithm>
#include <string>

#include "eval/uniform_grid.h"
#include "parallel/call_progress.h"
#include "parallel/parallel_for.h"
#include "tess/cells/patch_triangles.h"
#include "tess/write/mesh_views.h"
#include "tessera/guard.h"
#include "tessera/status.h"
#include "tessera/tessellation.h"

namespace tessera::inline abi_0_1 {
namespace {

constexpr int max_rate = 4096;
constexpr std::uint64_t max_vertices = std::uint64_t{1} << 32;  // the limit of 32-bit indices
constexpr std::size_t patches_per_task = 64;
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

}  // namespace

class TessellationPlan::Impl {
 public:
  Impl(const PatchSet& set, UniformGrid grid)
      : grid_(std::move(grid)),
        rates_{grid_.rate_u(), grid_.rate_v()},
        u_(parameters(rates_.u)),
        v_(parameters(rates_.v)),
        origin_(set.origin()) {
    shapes_.reserve(set.patch_count());
    for (auto* first : {&first_triangle_, &first_quad_}) {
      first->reserve(set.patch_count() + 1);
      first->push_back(0);
    }
    for (std::size_t k = 0; k < set.patch_count(); ++k) {
      shapes_.push_back(PatchShape::of(set.patch(k)));
      first_triangle_.push_back(first_triangle_.back() + triangle_count(shapes_.back(), rates_));
      first_quad_.push_back(first_quad_.back() + quad_count(shapes_.back(), rates_));
    }
  }

  Rates rates() const { return rates_; }
  MeshCapacity capacity() const {
    return {.vertices = shapes_.size() * rates_.vertices(), .triangles = first_triangle_.back()};
  }

  MeshCapacity quad_capacity() const {
    return {capacity().vertices, first_lone_triangle(shapes_.size()), first_quad_.back()};
  }

  Mesh allocate(const MeshCapacity& capacity) const { return empty_mesh(capacity, origin_); }

  Status run(const PatchSet& set, const MeshViews& out, const Execution& execution) const {
    if (Status status = check_views(out, out.quads.empty() ? capacity() : quad_capacity()); !status.ok()) return status;
    if (Status status = check_shapes(set, shapes_); !status.ok()) return status;
    CallProgress progress(execution, progress_ends);
    if (Status status = write_vertices(set, out, progress.loops()); !status.ok()) return status;
    return progress.finish(write_rest(out, progress.loops()));
  }

 private:
  Status write_vertices(const PatchSet& set, const MeshViews& out, const Execution& execution) const {
    QuantityViews<float> grid;
    grid.position = out.position;
    grid.normal = out.normal;
    return grid_.run(set, grid, execution);
  }

  /// Writes parameters, indices and patch numbers.
  Status write_rest(const MeshViews& out, const Execution& execution) const {
    ExecutionReport report;
    Execution part{.cancel = execution.cancel, .progress = {}, .stores = execution.stores, .report = &report};
    if (execution.progress) part.progress = [&](double done) { execution.progress(done); };
    Status status = parallel_for(shapes_.size(), patches_per_task, part, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        if (!out.parameter.empty()) write_parameters(k, out.parameter);
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
    if (out.quads.empty()) {
      write_triangles(shapes_[k], rates_, first, out.indices.data() + 3 * first_triangle_[k]);
      return fill(out.patch, first_triangle_[k], first_triangle_[k + 1]);
    }
    write_quads(shapes_[k], rates_, first, out.indices.data() + 3 * first_lone_triangle(k),
                out.quads.data() + 4 * first_quad_[k]);
    fill(out.patch, first_lone_triangle(k), first_lone_triangle(k + 1));
    fill(out.quad_patch, first_quad_[k], first_quad_[k + 1]);
  }

  /// Returns the first triangle of a patch among those that are not half of a quad.
  std::size_t first_lone_triangle(std::size_t patch) const { return first_triangle_[patch] - 2 * first_quad_[patch]; }

  void write_parameters(std::size_t patch, const View2<float>& view) const {
    std::size_t vertex = patch * rates_.vertices();
    for (const float u : u_)
      for (const float v : v_) {
        view.at(vertex, 0) = u;
        view.at(vertex++, 1) = v;
      }
  }

  UniformGrid grid_;
  Rates rates_;
  std::vector<float> u_, v_;
  Vec3 origin_;
  std::vector<PatchShape> shapes_;
  std::vector<std::size_t> first_triangle_, first_quad_;  ///< `[patch]`, and the number of all at the end
};

Result<TessellationPlan> TessellationPlan::make(const PatchSet& set, const TessellationOptions& options) {
  return guarded([&]() -> Result<TessellationPlan> {
    if (Status status = check_rate(options.rate_u, "u"); !status.ok()) return status;
    if (Status status = check_rate(options.rate_v, "v"); !status.ok()) return status;
    if (Status status = check_vertices(set.patch_count(), {options.rate_u, options.rate_v}); !status.ok())
      return status;
    Result<UniformGrid> grid = UniformGrid::make(set, options.rate_u, options.rate_v, options.isa);
    if (!grid) return grid.status();
    return TessellationPlan(std::make_unique<Impl>(set, std::move(*grid)));
  });
}

TessellationPlan::TessellationPlan(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
TessellationPlan::TessellationPlan(TessellationPlan&&) noexcept = default;
TessellationPlan& TessellationPlan::operator=(TessellationPlan&&) noexcept = default;
TessellationPlan::~TessellationPlan() = default;

MeshCapacity TessellationPlan::capacity() const { return impl_->capacity(); }
MeshCapacity TessellationPlan::quad_capacity() const { return impl_->quad_capacity(); }
int TessellationPlan::rate_u() const { return impl_->rates().u; }
int TessellationPlan::rate_v() const { return impl_->rates().v; }

Result<Mesh> TessellationPlan::allocate() const {
  return guarded([&]() -> Result<Mesh> { return impl_->allocate(impl_->capacity()); });
}

Result<Mesh> TessellationPlan::allocate_quads() const {
  return guarded([&]() -> Result<Mesh> { return impl_->allocate(impl_->quad_capacity()); });
}

Status TessellationPlan::run(const PatchSet& set, const MeshViews& out, const Execution& execution) const {
  return guarded([&] { return impl_->run(set, out, execution); });
}

}  // namespace tessera::inline abi_0_1
