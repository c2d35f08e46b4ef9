#include "io/cad/shape_bytes.h"

#include "io/cad/face_bytes.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

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

}  // namespace

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

}}  // namespace tessera::abi_0_1
