// Models of the C interface.

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "c/objects.h"
#include "model/surface_face.h"
#include "tessera/edge_matching.h"
#include "tessera/io.h"
#include "tessera/topology.h"

using namespace tessera;

namespace tessera { inline namespace abi_0_1 { namespace {

std::span<const double> numbers(const double* data, std::size_t count) {
  return data ? std::span(data, count) : std::span<const double>();
}
/// Points of three numbers.
std::span<const Vec3> points_of(const double* data, std::size_t count) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  return data ? std::span(reinterpret_cast<const Vec3*>(data), count) : std::span<const Vec3>();
}

/// The number of control points of a surface; nothing if it is beyond memory.
std::optional<std::size_t> point_count(const tsr_bspline& of) {
  constexpr std::size_t most = PTRDIFF_MAX / sizeof(Vec3);
  if (of.count_u == 0 || of.count_v == 0 || of.count_u > most / of.count_v) return {};
  return of.count_u * of.count_v;
}

Result<Surface> bezier_of(const tsr_bspline& of, std::size_t count) {
  const auto is_degree = [](int degree) { return degree >= 1 && degree <= max_degree; };
  const auto needed = [](int degree) { return static_cast<std::size_t>(degree) + 1; };
  if (is_degree(of.degree_u) && is_degree(of.degree_v) &&
      (of.count_u != needed(of.degree_u) || of.count_v != needed(of.degree_v)))
    return Status(StatusCode::count_mismatch,
                  "a Bezier patch of degrees " + std::to_string(of.degree_u) + " and " + std::to_string(of.degree_v) +
                      " has " + std::to_string(of.degree_u + 1) + " x " + std::to_string(of.degree_v + 1) +
                      " points, found " + std::to_string(of.count_u) + " x " + std::to_string(of.count_v));
  Result<BezierPatch> made =
      of.weights
          ? BezierPatch::rational(of.degree_u, of.degree_v, points_of(of.points, count), numbers(of.weights, count))
          : BezierPatch::polynomial(of.degree_u, of.degree_v, points_of(of.points, count));
  if (!made) return made.status();
  return Surface(*std::move(made));
}

Result<Surface> surface_of(const tsr_bspline& of) {
  const std::optional<std::size_t> count = point_count(of);
  if (!count || !of.points)
    return Status(StatusCode::invalid_argument,
                  of.points ? "there are no control points, or more than memory holds" : "points is a null pointer");
  if (!of.knots_u && !of.knots_v) return bezier_of(of, *count);
  if (!of.knots_u || !of.knots_v)
    return Status(StatusCode::invalid_argument, "one of knots_u and knots_v is a null pointer, and the other is not");
  const std::span<const double> u = numbers(of.knots_u, of.knot_count_u), v = numbers(of.knots_v, of.knot_count_v);
  Result<BSplineSurface> made =
      of.weights ? BSplineSurface::rational(of.degree_u, u, of.degree_v, v, points_of(of.points, *count),
                                            numbers(of.weights, *count))
                 : BSplineSurface::polynomial(of.degree_u, u, of.degree_v, v, points_of(of.points, *count));
  if (!made) return made.status();
  if (made->count_u() != of.count_u || made->count_v() != of.count_v)
    return Status(StatusCode::count_mismatch, "the knots are those of " + std::to_string(made->count_u()) + " x " +
                                                  std::to_string(made->count_v()) + " points, found " +
                                                  std::to_string(of.count_u) + " x " + std::to_string(of.count_v));
  return Surface(*std::move(made));
}

Result<Model> model_of(const tsr_bspline* surfaces, std::size_t count) {
  Model model;
  model.surfaces.reserve(std::min<std::size_t>(count, 1 << 20));
  const char* at = reinterpret_cast<const char*>(surfaces);
  for (std::size_t k = 0; k < count; ++k, at += surfaces->struct_size) {
    tsr_bspline of{};
    std::memcpy(&of, at, sizeof of);
    if (of.struct_size != surfaces->struct_size)
      return Status(StatusCode::invalid_argument, "surfaces have different struct_size",
                    static_cast<std::ptrdiff_t>(k));
    Result<Surface> surface = surface_of(of);
    if (!surface)
      return Status(surface.status().code(), "surface " + std::to_string(k) + ": " + surface.status().message(),
                    static_cast<std::ptrdiff_t>(k));
    model.surfaces.push_back({.name = std::string(of.name ? of.name : ""), .surface = *std::move(surface)});
  }
  return model;
}

/// Joins the edges of each shape; without shapes, all surfaces are one.
Result<Model> joined_model(const Model& model, double distance) {
  Model joined = model;
  if (joined.shapes.empty()) {
    Shape& one = joined.shapes.emplace_back();
    one.name = model.name;
    for (const ModelSurface& surface : model.surfaces) one.faces.push_back({surface});
    joined.instances = {Instance{}};
  }
  for (Shape& shape : joined.shapes) {
    if (shape.faces.empty()) continue;
    Result<double> reach = distance;
    if (distance == 0) reach = joining_distance(shape);
    if (!reach) return reach.status();
    if (*reach == 0) continue;
    Result<Shape> made = joined_edges(shape, *reach);
    if (!made) return made.status();
    shape = *std::move(made);
  }
  Result<std::vector<ModelSurface>> faces = placed_faces(joined.shapes, joined.instances);
  if (!faces) return faces.status();
  joined.surfaces = *std::move(faces);
  return joined;
}

const std::string* text_of(const Model& model, std::int32_t kind, std::size_t index) {
  switch (kind) {
    case TSR_TEXT_UNIT:
      return index == 0 ? &model.unit : nullptr;
    case TSR_TEXT_WARNING:
      return index < model.warnings.size() ? &model.warnings[index] : nullptr;
    case TSR_TEXT_SURFACE:
      return index < model.surfaces.size() ? &*model.surfaces[index].name : nullptr;
    case TSR_TEXT_SHAPE:
      return index < model.shapes.size() ? &*model.shapes[index].name : nullptr;
    case TSR_TEXT_INSTANCE:
      return index < model.instances.size() ? &*model.instances[index].name : nullptr;
    default:
      return nullptr;
  }
}

/// Writes a colour as four numbers; returns whether there is one.
std::int32_t write_colour(const std::optional<Colour>& colour, float (&to)[4]) {
  if (colour) std::ranges::copy(std::array{colour->red, colour->green, colour->blue, colour->alpha}, to);
  return colour.has_value();
}

/// Describes a surface of the model as a face.
tsr_face_info face_of(const Model& model, std::size_t surface) {
  constexpr std::uint32_t none = 0xffffffff;
  tsr_face_info filled{};
  filled.instance = filled.shape = filled.face = none;
  const std::optional<SurfaceFace> found = face_of_surface(model, surface);
  if (!found) return filled;
  filled.instance = static_cast<std::uint32_t>(found->instance - model.instances.data());
  filled.shape = found->instance->shape;
  filled.face = static_cast<std::uint32_t>(surface - found->instance->first_surface);
  filled.has_colour = write_colour(found->colour(), filled.colour);
  return filled;
}

CStatus no_such(const char* what, std::size_t index, std::size_t count) {
  CStatus status =
      bad(std::string(what) + " " + std::to_string(index) + " is none, there are " + std::to_string(count));
  status.index = static_cast<std::ptrdiff_t>(index);
  return status;
}

}}}  // namespace tessera::abi_0_1

extern "C" {

tsr_status tsr_model_read(tsr_model** model, const char* path, const tsr_run* run) {
  if (model) *model = nullptr;
  return c_call([&]() -> CStatus {
    if (!model || !path) return null_pointer(model ? "path" : "model");
    return run_work(run, [&](const Execution& execution) {
      const CadOptions cad{.cancel = execution.cancel, .progress = execution.progress};
      return give_model(model, read_model(path, {.cad = cad}));
    });
  });
}

tsr_status tsr_model_parse(tsr_model** model, const char* text, size_t length, const char* name) {
  if (model) *model = nullptr;
  return c_call([&]() -> CStatus {
    if (!model || !text) return null_pointer(model ? "text" : "model");
    return give_model(model, parse_json_model({text, length}, name ? name : "text"));
  });
}

tsr_status tsr_model_new(tsr_model** model, const tsr_bspline* surfaces, size_t count) {
  if (model) *model = nullptr;
  return c_call([&]() -> CStatus {
    if (!model || !surfaces) return null_pointer(model ? "surfaces" : "model");
    if (count == 0) return bad("there are no surfaces");
    if (CStatus status = check_size("tsr_bspline", surfaces->struct_size, sizeof *surfaces, sizeof *surfaces);
        status.code)
      return status;
    return give_model(model, model_of(surfaces, count));
  });
}

tsr_status tsr_model_join(tsr_model** joined, const tsr_model* model, double distance) {
  if (joined) *joined = nullptr;
  return c_call([&]() -> CStatus {
    if (!joined) return null_pointer("joined");
    const Held<CModel> of(model);
    if (!of) return of.error();
    if (!(distance >= 0)) return bad("the distance is not 0 or more");
    return give_model(joined, joined_model(of->model, distance));
  });
}

tsr_status tsr_model_save(const tsr_model* model, const char* path) {
  return c_call([&]() -> CStatus {
    const Held<CModel> of(model);
    if (!of) return of.error();
    if (!path) return null_pointer("path");
    const Result<WrittenModel> written = write_model(of->model, path);
    return written ? CStatus() : CStatus(written.status());
  });
}

tsr_status tsr_model_describe(const tsr_model* model, tsr_model_info* info) {
  return c_call([&]() -> CStatus {
    const Held<CModel> of(model);
    if (!of) return of.error();
    tsr_model_info filled{};
    filled.surfaces = of->model.surfaces.size();
    filled.shapes = of->model.shapes.size();
    filled.instances = of->model.instances.size();
    filled.warnings = of->model.warnings.size();
    for (const ModelSurface& surface : of->model.surfaces) filled.trimmed += !surface.trims->empty();
    return write_struct("tsr_model_info", info, filled);
  });
}

const char* tsr_model_text(const tsr_model* model, int32_t kind, size_t index) {
  const Held<CModel> of(model);
  if (!of) return nullptr;
  if (kind == TSR_TEXT_SURFACE_KIND)  // literals
    return index < of->model.surfaces.size() ? kind_name(of->model.surfaces[index].surface).data() : nullptr;
  const std::string* const text = text_of(of->model, kind, index);
  return text ? text->c_str() : nullptr;
}

tsr_status tsr_model_surface(const tsr_model* model, size_t surface, tsr_surface_info* info) {
  return c_call([&]() -> CStatus {
    const Held<CModel> of(model);
    if (!of) return of.error();
    const std::vector<ModelSurface>& surfaces = of->model.surfaces;
    if (surface >= surfaces.size()) return no_such("surface", surface, surfaces.size());
    const Domain range = domain(surfaces[surface].surface);
    return write_struct("tsr_surface_info", info,
                        {0, {range.u0, range.u1, range.v0, range.v1}, surfaces[surface].trims->size()});
  });
}

tsr_status tsr_model_instance(const tsr_model* model, size_t instance, tsr_instance_info* info) {
  return c_call([&]() -> CStatus {
    const Held<CModel> of(model);
    if (!of) return of.error();
    if (instance >= of->model.instances.size()) return no_such("instance", instance, of->model.instances.size());
    const Instance& from = of->model.instances[instance];
    tsr_instance_info filled{};
    filled.shape = from.shape;
    filled.first_surface = from.first_surface;
    const Affine& placement = *from.placement;
    double* at = filled.placement;
    for (const Vec3& column : {placement.columns[0], placement.columns[1], placement.columns[2], placement.translation})
      for (const double value : {column.x, column.y, column.z}) *at++ = value;
    filled.has_colour = write_colour(from.colour, filled.colour);
    return write_struct("tsr_instance_info", info, filled);
  });
}

tsr_status tsr_model_face(const tsr_model* model, size_t surface, tsr_face_info* info) {
  return c_call([&]() -> CStatus {
    const Held<CModel> of(model);
    if (!of) return of.error();
    const std::size_t count = of->model.surfaces.size();
    if (surface >= count) return no_such("surface", surface, count);
    return write_struct("tsr_face_info", info, face_of(of->model, surface));
  });
}

}  // extern "C"
