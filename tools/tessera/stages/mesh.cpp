#include "stages/mesh.h"

#include <tbb/parallel_pipeline.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "console/memory.h"
#include "console/progress.h"
#include "tessera/io.h"

namespace tessera::cli {
namespace {

/// Refuses a mesh that takes more memory than --max-memory, or than most of what is free.
Status check_memory(const MeshCapacity& mesh, const MeshOptions& options, bool has_doubles) {
  // Position, normal and parameters of a vertex in float, and its position in double; the indices and the patch of a
  // triangle, or of half a quad; and writing takes about as much again as the vertices.
  const std::uint64_t vertex_bytes = 2 * (32 + (has_doubles ? 24 : 0)), max_bytes = options.max_memory;
  constexpr std::uint64_t triangle_bytes = 16;
  const std::uint64_t triangles = mesh.triangles + 2 * mesh.quads;
  const std::uint64_t needed = mesh.vertices * vertex_bytes + triangles * triangle_bytes;
  const std::uint64_t limit = max_bytes > 0 ? max_bytes : available_memory() / 4 * 3;
  if (needed <= limit) return {};
  return {StatusCode::out_of_memory, "a mesh of " + counted(triangles, "triangle") + " needs " +
                                         readable_bytes(needed) + " of memory, the limit is " + readable_bytes(limit) +
                                         (max_bytes > 0 ? "" : ", three quarters of what is free") +
                                         "; use fewer segments, a tolerance, or --max-memory"};
}

bool has_doubles(const TessellationOptions& options) { return options.precision == Precision::double_precision; }

Result<Tessellation> plan_of(const PatchSet& set, const TessellationOptions& options) {
  Result<Tessellation> plan = Tessellation::make(set, options, {.cancel = &interrupted()});
  if (plan || !options.rates || set.cut_count() == 0) return plan;
  return Status(plan.status().code(), plan.status().message() + " (--untrimmed)");
}

/// Adds what is known of a plan.
void add_plan(const Tessellation& plan, const PackedSet& use, Meshed& made) {
  const PatchSet& set = *use.set;
  const MeshCapacity size = plan.capacity();
  made.size.vertices += use.count * size.vertices;
  made.size.triangles += use.count * size.triangles;
  made.size.quads += use.count * size.quads;
  made.patches += use.count * set.patch_count();
  made.cut_patches += use.count * set.cut_count();
  made.whole_faces += use.count * set.trim_faults().size();
  made.fit_error.distance = std::max(made.fit_error.distance, use.stretch * set.fit_error().distance);
  made.fit_error.certified &= set.fit_error().certified;
  made.welded_borders += use.count * plan.welded_borders();
  made.angle = std::max(made.angle, plan.angle() / degree);
  made.patches_without_angle += use.count * plan.patches_without_angle();
  made.pixels = std::max(made.pixels, plan.pixels());
  made.bound = std::max(made.bound, use.stretch * plan.bound());
  made.gap = std::max(made.gap, use.stretch * plan.gap());
  made.proven &= plan.certified();
  made.tolerance = plan.tolerance();
  for (const std::uint32_t patch : plan.crossed_patches()) {
    const std::size_t surface = use.first_surface + set.source(patch).surface;
    if (made.crossed.empty() || made.crossed.back() != surface) made.crossed.push_back(surface);
  }
  for (const std::uint32_t patch : plan.patches_beyond_tolerance()) {
    const std::size_t surface = use.first_surface + set.source(patch).surface;
    if (made.rough.empty() || made.rough.back().surface != surface) made.rough.push_back({surface, 0});
    double& bound = made.rough.back().bound;
    bound = std::max(bound, use.stretch * static_cast<double>(plan.bounds()[patch]));
  }
}

/// The open edges of a mesh. They are counted where loops cut patches or faces share edges, because the plan's own
/// number takes for granted that loops do not run over each other.
Result<std::size_t> open_edges(const Tessellation& plan, const PatchSet& set, const Mesh& mesh) {
  if (set.cut_count() == 0 && plan.edge_gaps().empty()) return plan.open_edges();
  const Result<MeshReport> report = check(mesh);
  if (!report) return report.status();
  return report->open_edges;
}

/// The box of all control points where the instances stand.
Box3 box_of(const Model& model, const Packed& packed) {
  Box3 box;
  for (const Instance& instance : model.instances) {
    const std::optional<PatchSet>& set = packed.sets[instance.shape].set;
    for (std::size_t k = 0; set && k < set->patch_count(); ++k)
      for (const Vec3& point : set->patch(k).points()) box.extend(instance.placement->point(point));
  }
  return box;
}

/// A bound of how far flatten() of mesh_assembly.h moves vertices of a model in this box, if they lie within
/// `tolerance` of it. In float that is 2^-24 of the distance from the box's centre; in double a few units in the last
/// place.
double flat_rounding(const Box3& box, double tolerance, Precision precision) {
  if (precision == Precision::single_precision) return std::ldexp(box.diagonal() / 2 + tolerance, -24);
  return std::ldexp(std::max(max_abs(box.lower), max_abs(box.upper)) + tolerance, -50);
}

/// Whether a format holds one mesh, and not instances.
bool is_flat(const std::string& path) {
  const std::string extension = lower_extension(path);
  return extension != ".glb" && extension != ".gltf";
}

/// Whether a format names the parts of a mesh.
bool has_parts(const std::string& path) { return !is_flat(path) || lower_extension(path) == ".obj"; }

/// The plan of the file, and what flatten() adds to the meshes' bounds.
struct ShapesPlan {
  FilePlan file;
  double rounding = 0;
};

Result<ShapesPlan> shapes_plan(const MeshOptions& options, const Model& model, const Box3& box,
                               const std::string& path) {
  const bool is_moved = model.instances.size() > 1 || *model.instances[0].placement != Affine();
  ShapesPlan plan{plan_for_file(options, box, path)};
  const double tolerance = plan.file.tolerance;
  if (is_flat(path) && is_moved) {
    const bool has_tolerance = plan.file.options.tolerance.has_value();
    plan.rounding = flat_rounding(box, has_tolerance ? tolerance : 0, plan.file.options.precision);
    plan.file = plan_for_file(options, box, path, plan.rounding);
  }
  if (tolerance > 2 * plan.rounding) return plan;
  return Status(StatusCode::invalid_argument, "the tolerance " + readable(tolerance) + " must be above " +
                                                  readable(2 * plan.rounding, 2) +
                                                  ", the rounding of all instances in one mesh; .glb and .gltf keep a "
                                                  "smaller one");
}

/// "shape 2 (nut): ...", if there are several.
Status in_shape(const Model& model, std::size_t k, const Status& status) {
  if (model.shapes.size() == 1) return status;
  const std::string& name = *model.shapes[k].name;
  return {status.code(),
          "shape " + std::to_string(k) + (name.empty() ? "" : " (" + name + ")") + ": " + status.message()};
}

/// Counts what the meshes of a file take, and refuses too much.
class MeshSizes {
 public:
  /// `flat`: whether the file gets a mesh for each instance, beside the shape's own.
  MeshSizes(const MeshOptions& options, bool has_doubles, bool flat)
      : options_(options), has_doubles_(has_doubles), flat_(flat) {}

  /// Adds the mesh of a set that stands `count` times.
  Status add(const MeshCapacity& mesh, std::size_t count, bool by_shapes) {
    const std::size_t in_file = flat_ ? count : 1, in_memory = flat_ ? count + 1 : 1;
    triangles_ += in_file * (mesh.triangles + 2 * mesh.quads);
    memory_.vertices += in_memory * mesh.vertices;
    memory_.triangles += in_memory * mesh.triangles;
    memory_.quads += in_memory * mesh.quads;
    if (by_shapes && !options_.grid && triangles_ > options_.certified.max_triangles)
      return {StatusCode::invalid_argument, "the meshes of all shapes up to here take " +
                                                counted(triangles_, "triangle") + ", the limit is " +
                                                std::to_string(options_.certified.max_triangles)};
    return check_memory(memory_, options_, has_doubles_);
  }

 private:
  const MeshOptions& options_;
  bool has_doubles_, flat_;
  MeshCapacity memory_;
  std::size_t triangles_ = 0;
};

/// A set on its way to a mesh.
struct SetMesh {
  std::size_t number = 0;
  Status status = {};  ///< the first error
  std::optional<Tessellation> plan = {};
  Mesh mesh = {};
  std::size_t open_edges = 0;
};

/// The steps from a set to its mesh, and what is known of it.
class SetMesher {
 public:
  SetMesher(const MeshOptions& options, const FilePlan& plan, bool flat, std::size_t sets, Meshed& made)
      : options_(options),
        plan_(plan),
        made_(made),
        sizes_(options, has_doubles(plan.options), flat),
        progress_("tessellating", sets) {}

  /// Threads: any number, as for mesh().
  void plan(const PackedSet& packed, const TessellationOptions& options, SetMesh& work) {
    Result<Tessellation> plan = plan_of(*packed.set, options);
    if (plan)
      work.plan = *std::move(plan);
    else
      work.status = plan.status();
  }

  /// Adds what is known of the plan. Threads: one, sets in their order.
  void count(const PackedSet& packed, SetMesh& work) {
    if (!work.status.ok()) return;
    add_plan(*work.plan, packed, made_);
    work.status = sizes_.add(work.plan->capacity(), packed.count, made_.by_shapes);
  }

  void mesh(const PackedSet& packed, SetMesh& work) {
    if (work.status.ok()) work.status = run(packed, work);
    work.plan.reset();
  }

  /// Lengths of the model become lengths of the shape.
  TessellationOptions options_in(const PackedSet& shape) const {
    TessellationOptions options = plan_.options;
    const double stretch = shape.stretch > 0 ? shape.stretch : 1;
    if (options.tolerance) options.tolerance = *options.tolerance / stretch;
    options.relative = false;
    if (options.joining.weld) options.joining.weld = *options.joining.weld / stretch;
    if (options.joining.max_gap) options.joining.max_gap = *options.joining.max_gap / stretch;
    return options;
  }

 private:
  Status run(const PackedSet& packed, SetMesh& work) {
    Result<Mesh> mesh = work.plan->allocate();
    if (!mesh) return mesh.status();
    work.mesh = *std::move(mesh);
    const Status status = work.plan->run(*packed.set, work.mesh.views(), progress_.execution(work.number));
    if (!status.ok() || options_.grid) return status;
    const Result<std::size_t> open = open_edges(*work.plan, *packed.set, work.mesh);
    if (open) work.open_edges = *open;
    return open.status();
  }

  const MeshOptions& options_;
  const FilePlan& plan_;
  Meshed& made_;
  MeshSizes sizes_;
  PartsProgress progress_;
};

/// Meshes all surfaces as one set.
Status mesh_as_one(Packed& packed, const Model& model, const MeshOptions& options, const std::string& path,
                   Meshed& made) {
  const PackedSet& only = packed.sets[0];
  const Box3 box = only.set->model_box();
  const FilePlan file = plan_for_file(options, box, path);
  SetMesher mesher(options, file, false, 1, made);
  SetMesh work;
  mesher.plan(only, file.options, work);
  mesher.count(only, work);
  mesher.mesh(only, work);
  if (!work.status.ok()) return work.status;
  made.mesh = std::move(work.mesh);
  if (has_parts(path) || !model.instances.empty()) {  // a colour that no file can hold is an error in any
    Result<std::vector<MeshPart>> parts = parts_by_surface(made.mesh, *only.set, model);
    if (!parts) return parts.status();
    made.mesh.parts = *std::move(parts);
  }
  made.open_edges = only.count * work.open_edges;
  add_file(file, options, box, made);
  return {};
}

/// Gives the mesh of a shape its parts.
void add_parts(const Model& model, const PackedSet& packed, SetMesh& work) {
  if (!work.status.ok()) return;
  Result<std::vector<MeshPart>> parts = parts_by_face(work.mesh, *packed.set, model.shapes[work.number]);
  if (parts)
    work.mesh.parts = *std::move(parts);
  else
    work.status = parts.status();
}

/// Meshes the shapes that have a set, several side by side; `works` has an element for each shape. After an error no
/// further shape begins. Sets are dropped once they are meshed.
void run_shapes(Packed& packed, const Model& model, SetMesher& mesher, std::vector<SetMesh>& works) {
  using tbb::filter_mode, tbb::make_filter;
  std::size_t next = 0;
  std::atomic<bool> has_failed = false;
  const auto take = [&](tbb::flow_control& flow) {
    while (next < works.size() && !packed.sets[next].set) ++next;
    if (next == works.size() || has_failed) flow.stop();
    return next++;
  };
  const auto plan = [&](std::size_t k) {
    works[k].number = k;
    mesher.plan(packed.sets[k], mesher.options_in(packed.sets[k]), works[k]);
    return k;
  };
  const auto count = [&](std::size_t k) {
    mesher.count(packed.sets[k], works[k]);
    return k;
  };
  const auto mesh = [&](std::size_t k) {
    mesher.mesh(packed.sets[k], works[k]);
    add_parts(model, packed.sets[k], works[k]);
    packed.sets[k].set.reset();
    if (!works[k].status.ok()) has_failed = true;
  };
  const auto at_once = 2 * static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
  tbb::parallel_pipeline(at_once, make_filter<void, std::size_t>(filter_mode::serial_in_order, take) &
                                      make_filter<std::size_t, std::size_t>(filter_mode::parallel, plan) &
                                      make_filter<std::size_t, std::size_t>(filter_mode::serial_in_order, count) &
                                      make_filter<std::size_t, void>(filter_mode::parallel, mesh));
}

/// Meshes each shape once.
Status mesh_shapes(Packed& packed, const Model& model, const MeshOptions& options, const std::string& path,
                   Meshed& made) {
  Result<MeshAssembly> assembly = instances_of(model);
  if (!assembly) return assembly.status();
  made.assembly = *std::move(assembly);
  made.by_shapes = true;
  const Box3 box = box_of(model, packed);
  const Result<ShapesPlan> plan = shapes_plan(options, model, box, path);
  if (!plan) return plan.status();
  SetMesher mesher(options, plan->file, is_flat(path), packed.sets.size(), made);
  std::vector<SetMesh> works(packed.sets.size());
  run_shapes(packed, model, mesher, works);
  for (std::size_t k = 0; k < works.size(); ++k) {
    if (!works[k].status.ok()) return in_shape(model, k, works[k].status);
    made.open_edges += packed.sets[k].count * works[k].open_edges;
    made.assembly.shapes[k].mesh = std::move(works[k].mesh);
  }
  made.bound += plan->rounding;
  add_file(plan->file, options, box, made);
  return {};
}

/// Whether lengths grow evenly in all directions, so that angles are kept.
bool is_even(const Affine& placement) {
  constexpr double rounding = 1e-9;
  const std::array<Vec3, 3>& c = placement.columns;
  const double square = dot(c[0], c[0]);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = i; j < 3; ++j)
      if (std::abs(dot(c[i], c[j]) - (i == j ? square : 0)) > rounding * square) return false;
  return true;
}

}  // namespace

bool allows_shapes(const MeshOptions& options) { return options.pixels == 0 && !options.certified.budget; }

bool suits_shapes(const MeshOptions& options, const Loaded& loaded) {
  if (!allows_shapes(options) || !loaded.all_have_shapes) return false;
  return !options.certified.angle ||
         std::ranges::all_of(loaded.model.instances, [](const Instance& one) { return is_even(*one.placement); });
}

void add_file(const FilePlan& plan, const MeshOptions& options, const Box3& box, Meshed& made) {
  made.rounding += plan.rounding;
  made.bound += plan.rounding;
  if (!options.certified.budget) made.tolerance = plan.tolerance;
  made.has_doubles = has_doubles(plan.options) || plan.has_double_sums;
  if (options.pixels > 0) made.pixels += pixels_of_length(options.view, box, plan.rounding);
  made.keeps_tolerances = !(made.bound > plan.tolerance) && !(options.pixels > 0 && made.pixels > options.pixels);
}

Result<Meshed> mesh_sets(Packed packed, const Loaded& loaded, const MeshOptions& options, const std::string& path,
                         Timings& timings) {
  const auto phase = timings.phase("evaluate");
  Meshed made;
  const Status status = (packed.by_shapes ? mesh_shapes : mesh_as_one)(packed, loaded.model, options, path, made);
  if (!status.ok()) return in_file(loaded.files[0], status);
  return made;
}

}  // namespace tessera::cli
