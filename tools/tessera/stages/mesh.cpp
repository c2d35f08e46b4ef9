#include "stages/mesh.h"

#include <algorithm>
#include <cmath>

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

Result<Mesh> run_plan(const Tessellation& plan, const PatchSet& set) {
  Result<Mesh> mesh = plan.allocate();
  if (!mesh) return mesh;
  Progress progress("tessellating");
  const Status status = plan.run(set, mesh->views(), progress.execution());
  if (!status.ok()) return status;
  return mesh;
}

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

/// Adds the open edges of a mesh. They are counted where loops cut patches or faces share edges, because the plan's own
/// number takes for granted that loops do not run over each other.
Status add_open_edges(const Tessellation& plan, const PackedSet& use, const Mesh& mesh, Meshed& made) {
  std::size_t open = plan.open_edges();
  if (use.set->cut_count() > 0 || !plan.edge_gaps().empty()) {
    const Result<MeshReport> report = check(mesh);
    if (!report) return report.status();
    open = report->open_edges;
  }
  made.open_edges += use.count * open;
  return {};
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

/// Meshes sets one after the other.
class SetMesher {
 public:
  SetMesher(const MeshOptions& options, const FilePlan& plan, bool flat, Meshed& made)
      : options_(options), plan_(plan), flat_(flat), made_(made) {}

  Result<Mesh> mesh(const PackedSet& packed, const TessellationOptions& options) {
    const Result<Tessellation> plan = plan_of(*packed.set, options);
    if (!plan) return plan.status();
    add_plan(*plan, packed, made_);
    if (const Status status = check_size(plan->capacity(), packed.count); !status.ok()) return status;
    Result<Mesh> mesh = run_plan(*plan, *packed.set);
    if (!mesh || options_.grid) return mesh;
    if (Status status = add_open_edges(*plan, packed, *mesh, made_); !status.ok()) return status;
    return mesh;
  }

  Status add_shape(const Model& model, std::size_t k, const PackedSet& packed) {
    if (!packed.set) return {};
    Result<Mesh> mesh = this->mesh(packed, options_in(packed));
    if (!mesh) return mesh.status();
    Result<std::vector<MeshPart>> parts = parts_by_face(*mesh, *packed.set, model.shapes[k]);
    if (!parts) return parts.status();
    mesh->parts = *std::move(parts);
    made_.assembly.shapes[k].mesh = *std::move(mesh);
    return {};
  }

 private:
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

  /// Adds to what is held in memory and in the file, and refuses too much.
  Status check_size(const MeshCapacity& mesh, std::size_t count) {
    const std::size_t in_file = flat_ ? count : 1, in_memory = flat_ ? count + 1 : 1;
    triangles_ += in_file * (mesh.triangles + 2 * mesh.quads);
    memory_.vertices += in_memory * mesh.vertices;
    memory_.triangles += in_memory * mesh.triangles;
    memory_.quads += in_memory * mesh.quads;
    if (made_.by_shapes && !options_.grid && triangles_ > options_.certified.max_triangles)
      return {StatusCode::invalid_argument, "the meshes of all shapes up to here take " +
                                                counted(triangles_, "triangle") + ", the limit is " +
                                                std::to_string(options_.certified.max_triangles)};
    return check_memory(memory_, options_, has_doubles(plan_.options));
  }

  const MeshOptions& options_;
  const FilePlan& plan_;
  bool flat_;  ///< whether the file gets a mesh for each instance
  Meshed& made_;
  MeshCapacity memory_;
  std::size_t triangles_ = 0;
};

/// Meshes all surfaces as one set.
Status mesh_as_one(const Packed& packed, const Model& model, const MeshOptions& options, const std::string& path,
                   Meshed& made) {
  const PatchSet& set = *packed.sets[0].set;
  const FilePlan file = plan_for_file(options, set.model_box(), path);
  Result<Mesh> mesh = SetMesher(options, file, false, made).mesh(packed.sets[0], file.options);
  if (!mesh) return mesh.status();
  Result<std::vector<MeshPart>> parts = parts_by_surface(*mesh, set, model);
  if (!parts) return parts.status();
  made.mesh = *std::move(mesh);
  made.mesh.parts = *std::move(parts);
  add_file(file, options, set.model_box(), made);
  return {};
}

/// Meshes each shape once.
Status mesh_shapes(const Packed& packed, const Model& model, const MeshOptions& options, const std::string& path,
                   Meshed& made) {
  Result<MeshAssembly> assembly = instances_of(model);
  if (!assembly) return assembly.status();
  made.assembly = *std::move(assembly);
  made.by_shapes = true;
  const Box3 box = box_of(model, packed);
  const Result<ShapesPlan> plan = shapes_plan(options, model, box, path);
  if (!plan) return plan.status();
  SetMesher mesher(options, plan->file, is_flat(path), made);
  for (std::size_t k = 0; k < packed.sets.size(); ++k)
    if (const Status added = mesher.add_shape(model, k, packed.sets[k]); !added.ok()) return in_shape(model, k, added);
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
