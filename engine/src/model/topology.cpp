#include "tessera/topology.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

#include "base/text.h"
#include "tessera/guard.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// "edge 7".
std::string item(const char* kind, std::size_t k) { return std::string(kind) + ' ' + std::to_string(k); }

/// "shape 2 (nut): edge 7 ends at vertex 12, there are 12 vertices".
class Faults {
 public:
  Faults(const char* kind, std::size_t index, const std::string& name)
      : index_(static_cast<std::ptrdiff_t>(index)),
        begin_(item(kind, index) + (name.empty() ? "" : " (" + name + ")") + ": ") {}

  Status operator()(const std::string& sentence) const {
    return Status(StatusCode::invalid_argument, begin_ + sentence, index_);
  }

 private:
  std::ptrdiff_t index_;
  std::string begin_;
};

std::string there_are(std::size_t count, const char* one, const char* many) {
  return (count == 1 ? ", there is " : ", there are ") + counted(count, one, many);
}

bool is_length(double value) { return std::isfinite(value) && value >= 0; }

Status check_vertices(const Shape& shape, const Faults& fault) {
  for (std::size_t k = 0; k < shape.vertices.size(); ++k)
    if (!is_finite(shape.vertices[k].position) || !is_length(shape.vertices[k].tolerance))
      return fault(item("vertex", k) + " is not finite, or has a negative tolerance");
  return {};
}

Status check_edges(const Shape& shape, const Faults& fault) {
  for (std::size_t k = 0; k < shape.edges.size(); ++k) {
    const BrepEdge& edge = shape.edges[k];
    for (const std::uint32_t vertex : {edge.start, edge.end})
      if (vertex != no_id && vertex >= shape.vertices.size())
        return fault(item("edge", k) + " ends at " + item("vertex", vertex) +
                     there_are(shape.vertices.size(), "vertex", "vertices"));
    const Interval& range = edge.range;
    if (!(range.from < range.to) || !std::isfinite(range.to - range.from))
      return fault(item("edge", k) + " has the range from " + text(range.from) + " to " + text(range.to));
    if (!is_length(edge.tolerance)) return fault(item("edge", k) + " has the tolerance " + text(edge.tolerance));
  }
  return {};
}

/// Says what is wrong with the parameter that a coedge states; empty: nothing. `curve`: the loop's.
std::string parameter_fault(const Coedge& coedge, const Interval& edge, const Interval& curve) {
  constexpr double share = 1e-6;  // that rounding and readers may be off, of a range
  const Curve& table = *coedge.parameter;
  if (table.degree() != 1) return "is of degree " + std::to_string(table.degree()) + ", it must be of degree 1";
  const std::span<const Vec3> points = table.points();
  for (std::size_t k = 0; k + 1 < points.size(); ++k)
    if (coedge.reversed ? points[k].x < points[k + 1].x : points[k].x > points[k + 1].x)
      return "must " + std::string(coedge.reversed ? "fall" : "grow") + " along the edge, it goes from " +
             text(points[k].x) + " to " + text(points[k + 1].x);
  if (points.front().x == points.back().x) return "is " + text(points.front().x) + " everywhere";
  const Interval& d = table.domain();
  const double slack = share * (edge.to - edge.from);
  if (d.from > edge.from + slack || d.to < edge.to - slack)
    return "is stated from " + text(d.from) + " to " + text(d.to) + ", the edge's range is from " + text(edge.from) +
           " to " + text(edge.to);
  for (const double s : {edge.from, edge.to}) {
    const double t = evaluate_jet(table, std::clamp(s, d.from, d.to)).position.x;
    const double beyond = std::max(curve.from - t, t - curve.to);
    if (beyond > share * (curve.to - curve.from))
      return "is " + text(t) + " at " + text(s) + ", the curve's domain is from " + text(curve.from) + " to " +
             text(curve.to);
  }
  return {};
}

Status check_face(const Shape& shape, std::size_t face, const Faults& fault) {
  const std::vector<TrimLoop>& loops = edge_loops(shape.faces[face]);
  for (std::size_t k = 0; k < loops.size(); ++k) {
    const auto in_loop = [&](const std::string& sentence) {
      return fault(item("face", face) + ", " + item("loop", k) + sentence);
    };
    const std::vector<Coedge>& coedges = loops[k].coedges;
    if (!coedges.empty() && coedges.size() != loops[k].curves.size())
      return in_loop(" has " + counted(coedges.size(), "coedge") + " for " + counted(loops[k].curves.size(), "curve"));
    for (std::size_t c = 0; c < coedges.size(); ++c) {
      const Coedge& coedge = coedges[c];
      if (coedge.edge >= shape.edges.size())
        return in_loop(" uses " + item("edge", coedge.edge) + there_are(shape.edges.size(), "edge", "edges"));
      if (!coedge.parameter) continue;
      const std::string found = parameter_fault(coedge, shape.edges[coedge.edge].range, loops[k].curves[c].domain());
      if (!found.empty()) return in_loop(", " + item("coedge", c) + ": its parameter " + found);
    }
  }
  return {};
}

Status check_shells(const Shape& shape, const Faults& fault) {
  for (std::size_t k = 0; k < shape.shells.size(); ++k) {
    const Shell& shell = shape.shells[k];
    for (const std::uint32_t face : shell.faces)
      if (face >= shape.faces.size())
        return fault(item("shell", k) + " has " + item("face", face) + there_are(shape.faces.size(), "face", "faces"));
    if (shell.solid != no_id && shell.solid >= shape.solid_count)
      return fault(item("shell", k) + " is of " + item("solid", shell.solid) +
                   there_are(shape.solid_count, "solid", "solids"));
  }
  return {};
}

Status check_shape(const Shape& shape, std::size_t k) {
  const Faults fault("shape", k, *shape.name);
  if (Status status = check_vertices(shape, fault); !status.ok()) return status;
  if (Status status = check_edges(shape, fault); !status.ok()) return status;
  for (std::size_t face = 0; face < shape.faces.size(); ++face)
    if (Status status = check_face(shape, face, fault); !status.ok()) return status;
  return check_shells(shape, fault);
}

Status check_shape_id(std::span<const Shape> shapes, std::span<const Instance> instances, std::size_t k) {
  if (instances[k].shape < shapes.size()) return {};
  return Faults("instance", k, *instances[k].name)("it is of " + item("shape", instances[k].shape) +
                                                   there_are(shapes.size(), "shape", "shapes"));
}

Status check_instances(const Model& model) {
  std::size_t next = 0;
  for (std::size_t k = 0; k < model.instances.size(); ++k) {
    const Instance& instance = model.instances[k];
    if (Status status = check_shape_id(model.shapes, model.instances, k); !status.ok()) return status;
    const std::size_t faces = model.shapes[instance.shape].faces.size();
    if (instance.first_surface != next || faces > model.surfaces.size() - next)
      return Faults("instance", k, *instance.name)(
          "its " + counted(faces, "face") + " begin at " + item("surface", instance.first_surface) +
          ", they must begin at " + item("surface", next) + " of " + std::to_string(model.surfaces.size()));
    next += faces;
  }
  if (model.instances.empty() || next == model.surfaces.size()) return {};
  return Status(StatusCode::invalid_argument, "the instances have " + counted(next, "face") + ", the model has " +
                                                  counted(model.surfaces.size(), "surface"));
}

}  // namespace

Status check_topology(const Model& model) {
  return guarded([&]() -> Status {
    for (std::size_t k = 0; k < model.shapes.size(); ++k)
      if (Status status = check_shape(model.shapes[k], k); !status.ok()) return status;
    return check_instances(model);
  });
}

Status check_topology(const Shape& shape) {
  return guarded([&] { return check_shape(shape, 0); });
}

Result<std::vector<ModelSurface>> placed_faces(std::span<const Shape> shapes, std::span<const Instance> instances) {
  return guarded([&]() -> Result<std::vector<ModelSurface>> {
    std::vector<ModelSurface> surfaces;
    for (std::size_t k = 0; k < instances.size(); ++k) {
      if (Status status = check_shape_id(shapes, instances, k); !status.ok()) return status;
      const Instance& instance = instances[k];
      for (const ShapeFace& face : shapes[instance.shape].faces) {
        ModelSurface& placed = surfaces.emplace_back(face);
        placed.placement = instance.placement;
        if (face.placement != Affine{}) placed.placement = *instance.placement * *face.placement;
      }
    }
    return surfaces;
  });
}

namespace {

/// Calls use(EdgeUse) for all coedges of a face.
template <class Use>
void for_each_coedge(const Shape& shape, std::uint32_t face, Use use) {
  const std::vector<TrimLoop>& loops = edge_loops(shape.faces[face]);
  for (std::uint32_t loop = 0; loop < loops.size(); ++loop)
    for (std::uint32_t curve = 0; curve < loops[loop].coedges.size(); ++curve)
      use(loops[loop].coedges[curve].edge, EdgeUse{face, loop, curve});
}

}  // namespace

Result<EdgeUses> edge_uses(const Shape& shape) {
  return guarded([&]() -> Result<EdgeUses> {
    if (Status status = check_topology(shape); !status.ok()) return status;
    EdgeUses all;
    all.first.assign(shape.edges.size() + 1, 0);
    const auto faces = static_cast<std::uint32_t>(shape.faces.size());
    for (std::uint32_t face = 0; face < faces; ++face)
      for_each_coedge(shape, face, [&](std::uint32_t edge, const EdgeUse&) { ++all.first[edge + 1]; });
    for (std::size_t k = 1; k < all.first.size(); ++k) all.first[k] += all.first[k - 1];
    all.uses.resize(all.first.back());
    std::vector<std::size_t> next = all.first;
    for (std::uint32_t face = 0; face < faces; ++face)
      for_each_coedge(shape, face, [&](std::uint32_t edge, const EdgeUse& use) { all.uses[next[edge]++] = use; });
    return all;
  });
}

Result<std::vector<bool>> closed_shells(const Shape& shape) {
  return guarded([&]() -> Result<std::vector<bool>> {
    if (Status status = check_topology(shape); !status.ok()) return status;
    std::vector<bool> closed, odd(shape.edges.size());
    for (const Shell& shell : shape.shells) {
      bool named = !shell.faces.empty();
      std::size_t free = 0;
      for (const std::uint32_t face : shell.faces) {
        bool any = false;
        for_each_coedge(shape, face, [&](std::uint32_t edge, const EdgeUse&) {
          any = true;
          if (shape.edges[edge].degenerate) return;
          odd[edge] = !odd[edge];
          odd[edge] ? ++free : --free;
        });
        named = named && any;
      }
      closed.push_back(named && free == 0);
      if (free > 0) odd.assign(shape.edges.size(), false);
    }
    return closed;
  });
}

}}  // namespace tessera::abi_0_1
