#include "tessera/model_part.h"

#include <algorithm>
#include <string>

#include "base/text.h"
#include "model/box_tree.h"
#include "model/model_patches.h"
#include "parallel/parallel_for.h"
#include "tessera/guard.h"
#include "tessera/topology.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Calls use(edge) for the edges of all coedges of a face.
template <class Use>
void for_each_edge(const ShapeFace& face, Use use) {
  for (const TrimLoop& loop : edge_loops(face))
    for (const Coedge& coedge : loop.coedges) use(coedge.edge);
}

/// The edges and vertices of some faces of a shape.
class Outline {
 public:
  explicit Outline(const Shape& shape) : shape_(shape), edges_(shape.edges.size()), vertices_(shape.vertices.size()) {}

  void add(const ShapeFace& face) {
    for_each_edge(face, [&](std::uint32_t edge) {
      edges_[edge] = true;
      for (const std::uint32_t vertex : {shape_.edges[edge].start, shape_.edges[edge].end})
        if (vertex != no_id) vertices_[vertex] = true;
    });
  }
  bool touches(const ShapeFace& face) const {
    const auto has = [&](std::uint32_t vertex) { return vertex != no_id && vertices_[vertex]; };
    bool touches = false;
    for_each_edge(face, [&](std::uint32_t edge) {
      touches = touches || edges_[edge] || has(shape_.edges[edge].start) || has(shape_.edges[edge].end);
    });
    return touches;
  }
  const std::vector<bool>& edges() const { return edges_; }
  const std::vector<bool>& vertices() const { return vertices_; }

 private:
  const Shape& shape_;
  std::vector<bool> edges_, vertices_;
};

/// Appends the items that are wanted to a list. Returns for each of all items its place there.
template <class T>
std::vector<std::uint32_t> take(const std::vector<T>& all, const std::vector<bool>& wanted, std::vector<T>& taken) {
  std::vector<std::uint32_t> places(all.size(), no_id);
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (!wanted[k]) continue;
    places[k] = static_cast<std::uint32_t>(taken.size());
    taken.push_back(all[k]);
  }
  return places;
}

/// Returns loops whose coedges name the edges by their new places.
Shared<std::vector<TrimLoop>> renamed(const Shared<std::vector<TrimLoop>>& loops,
                                      const std::vector<std::uint32_t>& places) {
  const auto stays = [&](const TrimLoop& loop) {
    return std::ranges::all_of(loop.coedges, [&](const Coedge& coedge) { return places[coedge.edge] == coedge.edge; });
  };
  if (std::ranges::all_of(*loops, stays)) return loops;
  std::vector<TrimLoop> copy = *loops;
  for (TrimLoop& loop : copy)
    for (Coedge& coedge : loop.coedges) coedge.edge = places[coedge.edge];
  return copy;
}

/// Returns a shape of some faces, with their edges and vertices.
Shape shape_of(const Shape& whole, std::span<const std::uint32_t> faces) {
  Outline outline(whole);
  Shape shape;
  shape.name = whole.name;
  for (const std::uint32_t face : faces) {
    outline.add(whole.faces[face]);
    shape.faces.push_back(whole.faces[face]);
  }
  const std::vector<std::uint32_t> vertices = take(whole.vertices, outline.vertices(), shape.vertices);
  const std::vector<std::uint32_t> edges = take(whole.edges, outline.edges(), shape.edges);
  for (BrepEdge& edge : shape.edges)
    for (std::uint32_t* vertex : {&edge.start, &edge.end})
      if (*vertex != no_id) *vertex = vertices[*vertex];
  for (ShapeFace& face : shape.faces) {
    face.trims = renamed(face.trims, edges);
    face.outline = renamed(face.outline, edges);
  }
  return shape;
}

/// Marks the surfaces that share an edge or a vertex with a wanted one of the same instance, and those that share one
/// with these: where chords of a face cross, they are divided for the faces behind its other edges too.
void mark_joined(const Model& model, std::size_t first, std::size_t end, std::vector<bool>& marks) {
  for (const Instance& instance : model.instances) {
    const Shape& shape = model.shapes[instance.shape];
    const std::size_t begin = instance.first_surface, behind = begin + shape.faces.size();
    if (behind <= first || end <= begin) continue;
    Outline wanted(shape), around(shape);
    for (std::size_t k = std::max(first, begin); k < std::min(end, behind); ++k) wanted.add(shape.faces[k - begin]);
    for (const ShapeFace& face : shape.faces)
      if (wanted.touches(face)) around.add(face);
    for (std::size_t k = begin; k < behind; ++k)
      if (around.touches(shape.faces[k - begin])) marks[k] = true;
  }
}

Box3 box_of(std::span<const Box3> boxes) {
  Box3 box;
  for (const Box3& one : boxes) box.extend(one);
  return box;
}

/// Marks the surfaces whose boxes come within reach of inner ones, and returns their boxes.
std::vector<Box3> mark_ring(std::span<const Box3> boxes, std::span<const Box3> inner, double reach,
                            std::vector<bool>& marks) {
  std::vector<Box3> ring, others_boxes, border;
  // Most surfaces are far from the border between inner ones and others. Twice the reach, as rounding differs with the
  // box that grows.
  std::vector<std::size_t> others;
  const Box3 towards_others = grown(box_of(inner), 2 * reach);
  for (std::size_t k = 0; k < boxes.size(); ++k)
    if (meet(towards_others, boxes[k]) && !marks[k]) others.push_back(k), others_boxes.push_back(boxes[k]);
  const Box3 towards_inner = grown(box_of(others_boxes), 2 * reach);
  for (const Box3& box : inner)
    if (meet(towards_inner, box)) border.push_back(box);
  if (border.empty()) return ring;
  const BoxTree tree = tree_towards(others_boxes, border, reach);
  for (std::size_t k = 0; k < others.size(); ++k)
    if (tree.touches(others_boxes[k], reach)) marks[others[k]] = true, ring.push_back(others_boxes[k]);
  return ring;
}

/// Adds what a part has of the instances, and of their shapes.
void take_instances(const Model& model, const std::vector<bool>& marks, Model& part) {
  for (const Instance& instance : model.instances) {
    const Shape& shape = model.shapes[instance.shape];
    std::vector<std::uint32_t> faces;
    for (std::uint32_t face = 0; face < shape.faces.size(); ++face)
      if (marks[instance.first_surface + face]) faces.push_back(face);
    if (faces.empty()) continue;
    Instance& taken = part.instances.emplace_back(instance);
    taken.shape = static_cast<std::uint32_t>(part.shapes.size());
    taken.first_surface = part.surfaces.size();
    part.shapes.push_back(shape_of(shape, faces));
    for (std::size_t k = 0; k < faces.size(); ++k) {
      ModelSurface surface = model.surfaces[instance.first_surface + faces[k]];
      surface.trims = part.shapes.back().faces[k].trims;
      part.surfaces.push_back(std::move(surface));
    }
  }
}

Status check_part(const Model& model, std::span<const Box3> boxes, std::size_t first, std::size_t end, double reach) {
  const std::size_t count = model.surfaces.size();
  if (!(first <= end && end <= count))
    return Status(StatusCode::invalid_argument, "a part of a model of " + counted(count, "surface") +
                                                    " can't be its surfaces from " + std::to_string(first) + " until " +
                                                    std::to_string(end));
  if (!(reach >= 0))
    return Status(StatusCode::invalid_argument, "the reach is " + text(reach) + ", it must be at least 0");
  if (boxes.size() != count)
    return Status(StatusCode::count_mismatch,
                  "there are " + counted(boxes.size(), "box", "boxes") + " for " + counted(count, "surface"));
  return check_topology(model);
}

/// Sets the boxes of surfaces that are Bezier patches as they stand.
Status box_patches(const Model& model, std::span<Box3> boxes) {
  constexpr std::size_t grain = 4096;
  return parallel_for(boxes.size(), grain, {}, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      if (const auto* const patch = std::get_if<BezierPatch>(&model.surfaces[k].surface)) boxes[k] = patch->hull_box();
  });
}

}  // namespace

Result<SurfaceExtents> surface_extents(const Model& model, const FitOptions& fit) {
  return guarded([&]() -> Result<SurfaceExtents> {
    if (Status status = check_topology(model); !status.ok()) return status;
    ModelPatches patches(model, {});
    patches.name_edges();
    SurfaceExtents extents{std::vector<Box3>(model.surfaces.size()), {}};
    if (Status status = box_patches(model, extents.boxes); !status.ok()) return status;
    for (std::size_t k = 0; k < model.surfaces.size(); ++k) {
      if (patches.pass_whole_patch()) continue;
      Result<PatchGrid> grid = to_bezier(model.surfaces[k], fit);
      if (!grid) return in_surface(model, k, grid.status());
      if (Status status = patches.add(*std::move(grid)); !status.ok()) return status;
      extents.boxes[k] = patches.take_box();
    }
    extents.fit_error = patches.gathered().fit_error;
    return extents;
  });
}

Result<ModelPart> part_of(const Model& model, const SurfaceExtents& extents, std::size_t first, std::size_t end,
                          double reach) {
  return guarded([&]() -> Result<ModelPart> {
    const std::span<const Box3> boxes = extents.boxes;
    if (Status status = check_part(model, boxes, first, end, reach); !status.ok()) return status;
    std::vector<bool> marks(boxes.size());
    const auto begin = marks.begin();
    std::fill(begin + static_cast<std::ptrdiff_t>(first), begin + static_cast<std::ptrdiff_t>(end), true);
    const std::span<const Box3> own = boxes.subspan(first, end - first);
    mark_ring(boxes, mark_ring(boxes, own, reach, marks), reach, marks);
    mark_joined(model, first, end, marks);
    ModelPart part;
    part.own_box = box_of(own), part.box = extents.box(), part.fit_error = extents.fit_error;
    part.model.name = model.name, part.model.unit = model.unit, part.model.file_unit = model.file_unit;
    for (std::size_t k = 0; k < marks.size(); ++k) {
      if (k == first) part.first = part.surfaces.size();
      if (marks[k]) part.surfaces.push_back(k);
    }
    part.end = part.first + (end - first);
    if (model.instances.empty()) {
      part.model.surfaces.reserve(part.surfaces.size());
      for (const std::uint64_t k : part.surfaces)
        part.model.surfaces.push_back(model.surfaces[static_cast<std::size_t>(k)]);
    } else {
      take_instances(model, marks, part.model);
    }
    return part;
  });
}

}}  // namespace tessera::abi_0_1
