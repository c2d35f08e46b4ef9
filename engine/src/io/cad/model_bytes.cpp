#include "io/cad/model_bytes.h"

#include <cstdint>
#include <vector>

#include "base/text.h"
#include "io/cad/byte_stream.h"
#include "io/cad/face_bytes.h"
#include "tessera/topology.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

// Shapes and instances as bytes.

// The numbers of the first surfaces follow from the shapes, and are no part of the bytes.

void put_edge(ByteWriter& out, const BrepEdge& edge) {
  out.put(edge.start);
  out.put(edge.end);
  out.put(edge.range);
  put_curve(out, edge.curve);
  out.put(edge.tolerance);
  out.put(edge.degenerate);
  out.put(edge.same_parameter);
}

bool take_edge(ByteReader& in, std::vector<BrepEdge>& edges) {
  BrepEdge& edge = edges.emplace_back();
  return in.take(edge.start) && in.take(edge.end) && in.take(edge.range) && take_curve(in, edge.curve) &&
         in.take(edge.tolerance) && in.take(edge.degenerate) && in.take(edge.same_parameter);
}

bool take_shell(ByteReader& in, std::vector<Shell>& shells) {
  Shell& shell = shells.emplace_back();
  return in.take_list(shell.faces) && in.take(shell.solid);
}

bool take_shape(ByteReader& in, std::vector<Shape>& shapes) {
  Shape& shape = shapes.emplace_back();
  std::string name;
  if (!in.take_list(name)) return false;
  shape.name = std::move(name);
  return take_faces(in, shape.faces) && in.take_list(shape.vertices) &&
         in.take_each(shape.edges, [&](std::vector<BrepEdge>& list) { return take_edge(in, list); }) &&
         in.take_each(shape.shells, [&](std::vector<Shell>& list) { return take_shell(in, list); }) &&
         in.take(shape.solid_count);
}

bool take_instance(ByteReader& in, std::vector<Instance>& instances) {
  std::string name;
  Affine placement;
  Instance& instance = instances.emplace_back();
  if (!in.take(instance.shape) || !in.take_list(name) || !in.take(placement)) return false;
  instance.name = std::move(name);
  instance.placement = placement;
  return take_colour(in, instance.colour);
}

/// Errors: internal (a surface that is no B-spline).
Status put_shapes(ByteWriter& out, const std::vector<Shape>& shapes) {
  out.put_count(shapes.size());
  for (const Shape& shape : shapes) {
    out.put_text(*shape.name);
    if (Status status = put_faces(out, shape.faces); !status.ok()) return status;
    out.put_list(std::span(shape.vertices));
    out.put_count(shape.edges.size());
    for (const BrepEdge& edge : shape.edges) put_edge(out, edge);
    out.put_count(shape.shells.size());
    for (const Shell& shell : shape.shells) {
      out.put_list(std::span(shell.faces));
      out.put(shell.solid);
    }
    out.put(shape.solid_count);
  }
  return {};
}

/// Returns false if the bytes end too early or hold no shapes. Leaves ids unchecked.
bool take_shapes(ByteReader& in, std::vector<Shape>& shapes) {
  return in.take_each(shapes, [&](std::vector<Shape>& list) { return take_shape(in, list); });
}

void put_instances(ByteWriter& out, const std::vector<Instance>& instances) {
  out.put_count(instances.size());
  for (const Instance& instance : instances) {
    out.put(instance.shape);
    out.put_text(*instance.name);
    out.put(*instance.placement);
    put_colour(out, instance.colour);
  }
}

bool take_instances(ByteReader& in, std::vector<Instance>& instances) {
  return in.take_each(instances, [&](std::vector<Instance>& list) { return take_instance(in, list); });
}

/// Places the faces of the instances. A few bytes can state many, hence a limit: 512 MiB of surfaces.
Status place(Model& model) {
  constexpr std::size_t max_faces = std::size_t{1} << 22;
  std::size_t count = 0;
  for (Instance& instance : model.instances) {
    instance.first_surface = count;
    if (instance.shape < model.shapes.size()) count += model.shapes[instance.shape].faces.size();
    if (count > max_faces)
      return Status(StatusCode::unsupported,
                    "its instances have more than " + counted(max_faces, "face") + ", the most that a model may have");
  }
  Result<std::vector<ModelSurface>> placed = placed_faces(model.shapes, model.instances);
  if (!placed) return placed.status();
  model.surfaces = *std::move(placed);
  return {};
}

bool take_model(ByteReader& in, Model& model) {
  const auto take_text = [&](std::vector<std::string>& list) { return in.take_list(list.emplace_back()); };
  return in.take_list(model.name) && take_surfaces(in, model.surfaces) && take_shapes(in, model.shapes) &&
         take_instances(in, model.instances) && (model.instances.empty() || model.surfaces.empty()) &&
         in.take_list(model.unit) && in.take_list(model.file_unit) && in.take_each(model.warnings, take_text);
}

Status damaged(const std::string& why = {}) {
  return Status(StatusCode::internal, std::string(damaged_model) + (why.empty() ? "" : ": " + why));
}

Result<Model> checked(Model model) {
  if (!model.instances.empty())
    if (const Status status = place(model); !status.ok())
      return status.code() == StatusCode::invalid_argument ? damaged(status.message()) : status;
  if (const Status status = check_topology(model); !status.ok())
    return status.code() == StatusCode::invalid_argument ? damaged(status.message()) : status;
  return model;
}

void put_status(ByteWriter& out, const Status& status) {
  out.put(status.code());
  out.put(std::int64_t{status.index()});
  out.put_text(status.message());
}

Status put_model(ByteWriter& out, const Model& model) {
  out.put_text(model.name);
  const std::span<const ModelSurface> surfaces = model.surfaces;
  if (Status status = put_surfaces(out, model.instances.empty() ? surfaces : surfaces.first(0)); !status.ok())
    return status;
  if (Status status = put_shapes(out, model.shapes); !status.ok()) return status;
  put_instances(out, model.instances);
  out.put_text(model.unit);
  out.put_text(model.file_unit);
  out.put_count(model.warnings.size());
  for (const std::string& warning : model.warnings) out.put_text(warning);
  return {};
}

}  // namespace

std::string to_bytes(const Result<Model>& model) {
  Status status = model.status();
  if (model) {
    ByteWriter out;
    put_status(out, {});
    status = put_model(out, *model);
    if (status.ok()) return out.take();
  }
  ByteWriter out;
  put_status(out, status);
  return out.take();
}

Result<Model> model_from_bytes(std::string_view bytes) {
  ByteReader in(bytes);
  StatusCode code{};
  std::int64_t index = 0;
  std::string message;
  Model model;
  if (in.take(code) && in.take(index) && in.take_list(message) && code <= StatusCode::internal) {
    if (code != StatusCode::ok) return Status(code, message, static_cast<std::ptrdiff_t>(index));
    if (take_model(in, model)) return checked(std::move(model));
  }
  return damaged();
}

}}  // namespace tessera::abi_0_1
