#include "io/step/step_topology.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <map>
#include <unordered_map>
#include <utility>

#include "parallel/parallel_for.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// An edge of a loop as the file has it.
struct RawUse {
  std::uint64_t edge = 0;            ///< EDGE_CURVE, or 0 for a side of a polygon
  std::uint64_t start = 0, end = 0;  ///< of a side: CARTESIAN_POINT
  bool reversed = false;
};
struct RawBound {
  bool is_outer = false;
  std::uint64_t vertex = 0;  ///< VERTEX_POINT of a vertex loop
  std::vector<RawUse> uses;
};

bool is_face(const StepEntity& entity) {
  return entity.is("ADVANCED_FACE") || entity.is("FACE_SURFACE") || entity.is("FACE");
}
bool is_shell(const StepEntity& entity) {
  return entity.is("CLOSED_SHELL") || entity.is("OPEN_SHELL") || entity.is("CONNECTED_FACE_SET");
}
bool is_oriented_shell(const StepEntity& entity) {
  return entity.is("ORIENTED_CLOSED_SHELL") || entity.is("ORIENTED_OPEN_SHELL");
}
bool is_solid(const StepEntity& entity) {
  return entity.is("MANIFOLD_SOLID_BREP") || entity.is("BREP_WITH_VOIDS") || entity.is("FACETED_BREP");
}
bool is_model(const StepEntity& entity) {
  return entity.is("SHELL_BASED_SURFACE_MODEL") || entity.is("FACE_BASED_SURFACE_MODEL");
}
bool is_set_of_geometry(const StepEntity& entity) {
  return entity.is("GEOMETRIC_SET") || entity.is("GEOMETRIC_CURVE_SET");
}

/// The k-th attribute after the name, of a simple instance or of the part of a complex one that has it.
std::size_t own_attribute(StepEntity& entity, std::string_view kind, std::size_t k) {
  return entity.has_parts() ? entity.attribute(entity.part(kind), k) : entity.attribute(k + 1);
}

/// Gathers the faces of items and the wholes that hold them.
class FaceWalk {
 public:
  FaceWalk(const StepIndex& index, StepTopology& out) : index_(index), out_(out) {}

  void add_item(std::uint64_t number, bool is_mirrored) { add(number, {no_id, no_id, no_id, is_mirrored}, 0); }

 private:
  struct Place {
    std::uint32_t whole = no_id, shell = no_id, solid = no_id;
    bool reversed = false;
  };
  static constexpr int max_depth = 16;
  /// Wholes may share faces and other wholes, but a file must not grow by that.
  std::size_t max_visits() const { return 4 * index_.instances().size() + 64; }
  bool is_full() const { return visits_ > max_visits(); }

  void add(std::uint64_t number, Place place, int depth) {
    if (is_full()) return;
    StepEntity entity(index_, number);
    if (depth > max_depth) entity.fail("is made of too many wholes, or of itself");
    if (++visits_ > max_visits()) entity.fail("holds the same faces too often", StatusCode::unsupported);
    if (!entity.status().ok()) return out_.unread.push_back(entity.status().message());
    if (is_face(entity)) return add_face(number, 0, place);
    if (entity.is("ORIENTED_FACE") || is_oriented_shell(entity)) {
      const std::uint64_t inner = entity.reference(entity.attribute(2));
      place.reversed = place.reversed == entity.logical(entity.attribute(3));
      if (!entity.status().ok()) return out_.unread.push_back(entity.status().message());
      return add(inner, place, depth + 1);
    }
    if (!is_solid(entity) && !is_shell(entity) && !is_model(entity) && !is_set_of_geometry(entity)) {
      if (depth > 0) out_.unread.push_back(entity.error("is no face, shell or set of faces").message());
      return;
    }
    const std::uint32_t above = std::exchange(place.whole, static_cast<std::uint32_t>(out_.wholes.size()));
    const std::vector<std::uint64_t> parts = parts_of(entity, number, place);
    if (!entity.status().ok()) return out_.unread.push_back(entity.status().message());
    out_.wholes.push_back({number, above, place.shell, place.solid});
    const bool is_set = is_set_of_geometry(entity);
    for (const std::uint64_t part : parts) {
      if (is_full()) return;
      if (is_set)
        add_element(part, place);
      else
        add(part, place, depth + 1);
    }
  }

  /// Returns what a whole holds, and enters the solid or the shell that it is.
  std::vector<std::uint64_t> parts_of(StepEntity& entity, std::uint64_t number, Place& place) {
    if (is_solid(entity)) {
      place.solid = out_.solid_count++;
      std::vector<std::uint64_t> parts{entity.reference(own_attribute(entity, "MANIFOLD_SOLID_BREP", 0))};
      if (!entity.is("BREP_WITH_VOIDS")) return parts;
      const std::size_t voids =
          entity.has_parts() ? entity.attribute(entity.part("BREP_WITH_VOIDS"), 0) : entity.attribute(2);
      for (const std::uint64_t one : entity.references(voids)) parts.push_back(one);
      return parts;
    }
    if (is_shell(entity)) {
      place.shell = static_cast<std::uint32_t>(out_.shells.size());
      out_.shells.push_back(place.solid);
      return usable_references(entity, number, own_attribute(entity, "CONNECTED_FACE_SET", 0));
    }
    if (is_model(entity) || is_set_of_geometry(entity)) return entity.references(entity.attribute(1));
    return {};
  }

  /// Returns the references of a list to instances of the file; others are said in `unread`.
  std::vector<std::uint64_t> usable_references(StepEntity& entity, std::uint64_t number, std::size_t list) {
    std::vector<std::uint64_t> out;
    for (const std::size_t k : entity.list(list)) {
      const std::uint64_t one = entity.reference(k);
      if (entity.status().ok()) {
        out.push_back(one);
        continue;
      }
      out_.unread.push_back(entity.status().message());
      entity.read(number);  // forgets the error
    }
    return out;
  }

  /// Adds an element of a set if it is a surface; curves and points are passed over.
  void add_element(std::uint64_t number, const Place& place) {
    ++visits_;
    const StepEntity entity(index_, number);
    constexpr std::array<std::string_view, 12> surfaces{"RECTANGULAR_TRIMMED_SURFACE",
                                                        "B_SPLINE_SURFACE_WITH_KNOTS",
                                                        "B_SPLINE_SURFACE",
                                                        "BEZIER_SURFACE",
                                                        "QUASI_UNIFORM_SURFACE",
                                                        "UNIFORM_SURFACE",
                                                        "SPHERICAL_SURFACE",
                                                        "TOROIDAL_SURFACE",
                                                        "DEGENERATE_TOROIDAL_SURFACE",
                                                        "SURFACE_OF_REVOLUTION",
                                                        "OFFSET_SURFACE",
                                                        "CURVE_BOUNDED_SURFACE"};
    if (std::ranges::any_of(surfaces, [&](std::string_view kind) { return entity.is(kind); }))
      add_face(number, number, place);
  }

  void add_face(std::uint64_t number, std::uint64_t surface, const Place& place) {
    StepFace& face = out_.faces.emplace_back();
    face.number = number, face.surface = surface, face.whole = place.whole;
    face.agrees = !place.reversed;
  }

  const StepIndex& index_;
  StepTopology& out_;
  std::size_t visits_ = 0;
};

/// Reads one loop of a face.
class LoopReader {
 public:
  explicit LoopReader(const StepIndex& index) : entity_(index), edge_(index) {}

  Result<RawBound> read(std::uint64_t bound) {
    RawBound out;
    entity_.read(bound);
    out.is_outer = entity_.is("FACE_OUTER_BOUND");
    if (!out.is_outer && !entity_.is("FACE_BOUND")) entity_.fail("expected FACE_BOUND");
    const std::uint64_t loop = entity_.reference(entity_.attribute(1));
    const bool is_along = entity_.logical(entity_.attribute(2));
    if (!entity_.status().ok()) return entity_.status();
    entity_.read(loop);
    if (entity_.is("VERTEX_LOOP"))
      out.vertex = entity_.reference(entity_.attribute(1));
    else if (entity_.is("POLY_LOOP"))
      add_sides(entity_.references(entity_.attribute(1)), out);
    else if (entity_.is("EDGE_LOOP"))
      add_edges(entity_.references(entity_.attribute(1)), out);
    else
      entity_.fail("expected EDGE_LOOP, VERTEX_LOOP or POLY_LOOP");
    if (!entity_.status().ok()) return entity_.status();
    if (!is_along) reverse(out);
    return out;
  }

  static void reverse(RawBound& bound) {
    std::ranges::reverse(bound.uses);
    for (RawUse& use : bound.uses) use.reversed = !use.reversed;
  }

 private:
  static void add_sides(const std::vector<std::uint64_t>& points, RawBound& out) {
    for (std::size_t k = 0; k < points.size(); ++k) {
      const std::uint64_t a = points[k], b = points[(k + 1) % points.size()];
      if (a != b) out.uses.push_back({0, std::min(a, b), std::max(a, b), b < a});
    }
  }
  void add_edges(const std::vector<std::uint64_t>& edges, RawBound& out) {
    for (const std::uint64_t number : edges) {
      edge_.read(number);
      RawUse use{number, 0, 0, false};
      if (edge_.is("ORIENTED_EDGE")) {
        use.edge = edge_.reference(edge_.attribute(3));
        use.reversed = !edge_.logical(edge_.attribute(4));
      }
      if (!edge_.status().ok()) return entity_.fail(edge_.status().message());
      out.uses.push_back(use);
    }
  }

  StepEntity entity_, edge_;
};

/// How many edges the loops of all faces may list: faces may share loops, but a file must not grow by that.
class EdgeBudget {
 public:
  explicit EdgeBudget(const StepIndex& index) : most_(8 * index.instances().size() + 4096) {}
  bool take(std::size_t count) { return (taken_ += count) <= most_; }
  Status status() const {
    if (taken_ <= most_) return {};
    return {StatusCode::unsupported, "the loops of a part list more than " + std::to_string(most_) + " edges"};
  }

 private:
  std::size_t most_;
  std::atomic<std::size_t> taken_ = 0;
};

/// Completes a face; a fault stays in its status.
std::vector<RawBound> read_face(const StepIndex& index, StepFace& face, EdgeBudget& budget) {
  std::vector<RawBound> out;
  if (face.surface != 0) return out;  // a surface alone
  StepEntity entity(index, face.number);
  const bool has_parts = entity.has_parts();
  const std::size_t bounds = has_parts ? entity.attribute(entity.part("FACE"), 0) : entity.attribute(1);
  const std::vector<std::uint64_t> numbers = entity.references(bounds);
  const bool has_surface = has_parts ? entity.is("FACE_SURFACE") : !entity.is("FACE");
  const bool is_reversed = !face.agrees;  // by its shell
  if (has_surface) {
    const std::size_t part = has_parts ? entity.part("FACE_SURFACE") : 0, at = has_parts ? 0 : 2;
    face.surface = entity.reference(entity.attribute(part, at));
    face.agrees = is_reversed != entity.logical(entity.attribute(part, at + 1));
  }
  face.status = entity.status();
  LoopReader reader(index);
  for (const std::uint64_t number : numbers) {
    if (!face.status.ok()) break;
    Result<RawBound> bound = reader.read(number);
    if (!bound) {
      face.status = bound.status();
      break;
    }
    if (!budget.take(1 + bound->uses.size())) break;  // the part fails
    if (is_reversed) LoopReader::reverse(*bound);
    out.push_back(*std::move(bound));
  }
  const auto is_polygon = [](const RawBound& bound) {
    return std::ranges::all_of(bound.uses, [](const RawUse& use) { return use.edge == 0; }) && bound.vertex == 0;
  };
  face.is_polygon = !out.empty() && std::ranges::all_of(out, is_polygon);
  if (!has_surface && !face.is_polygon && face.status.ok())
    face.status = entity.error("has no surface", StatusCode::unsupported);
  if (!face.status.ok()) out.clear();
  return out;
}

/// Numbers edges and vertices as faces use them.
class Numbering {
 public:
  explicit Numbering(StepTopology& out) : out_(out) {}

  void add(StepFace& face, const std::vector<RawBound>& bounds) {
    for (const RawBound& raw : bounds) {
      StepBound& bound = face.bounds.emplace_back();
      bound.is_outer = raw.is_outer;
      if (raw.vertex != 0) bound.vertex = vertex(raw.vertex);
      for (const RawUse& use : raw.uses) bound.uses.push_back({edge(use), use.reversed});
    }
  }
  std::uint32_t vertex(std::uint64_t number) {
    const auto [place, is_new] = vertices_.try_emplace(number, static_cast<std::uint32_t>(out_.vertices.size()));
    if (is_new) out_.vertices.push_back(number);
    return place->second;
  }

 private:
  std::uint32_t edge(const RawUse& use) {
    const auto next = static_cast<std::uint32_t>(out_.edges.size());
    if (use.edge == 0) {
      const auto [place, is_new] = sides_.try_emplace({use.start, use.end}, next);
      if (is_new) out_.edges.push_back({0, 0, true, vertex(use.start), vertex(use.end), {}});
      return place->second;
    }
    const auto [place, is_new] = edges_.try_emplace(use.edge, next);
    if (is_new) out_.edges.push_back({use.edge, 0, true, no_id, no_id, {}});
    return place->second;
  }

  StepTopology& out_;
  std::unordered_map<std::uint64_t, std::uint32_t> edges_, vertices_;
  std::map<std::pair<std::uint64_t, std::uint64_t>, std::uint32_t> sides_;
};

/// Reads an edge, and its vertices as instances.
std::array<std::uint64_t, 2> read_edge(const StepIndex& index, StepEdge& edge) {
  StepEntity entity(index, edge.number);
  if (!entity.is("EDGE_CURVE")) entity.fail("expected EDGE_CURVE");
  const std::size_t part = entity.has_parts() ? entity.part("EDGE_CURVE") : 0, at = entity.has_parts() ? 0 : 3;
  const std::size_t ends = entity.has_parts() ? entity.part("EDGE") : 0, first = entity.has_parts() ? 0 : 1;
  const std::array<std::uint64_t, 2> out{entity.reference(entity.attribute(ends, first)),
                                         entity.reference(entity.attribute(ends, first + 1))};
  edge.curve = entity.reference(entity.attribute(part, at));
  edge.agrees = entity.logical(entity.attribute(part, at + 1));
  edge.status = entity.status();
  return out;
}

/// Replaces VERTEX_POINT by its CARTESIAN_POINT; what cannot be read remains.
std::uint64_t point_of(const StepIndex& index, std::uint64_t vertex) {
  StepEntity entity(index, vertex);
  if (!entity.is("VERTEX_POINT")) return vertex;
  const std::size_t at = entity.has_parts() ? entity.attribute(entity.part("VERTEX_POINT"), 0) : entity.attribute(1);
  const std::uint64_t point = entity.reference(at);
  return entity.status().ok() ? point : vertex;
}

}  // namespace

Result<StepTopology> StepTopology::make(const StepIndex& index, std::span<const std::uint64_t> items, bool is_mirrored,
                                        const Execution& execution) {
  StepTopology out;
  FaceWalk walk(index, out);
  for (const std::uint64_t item : items) walk.add_item(item, is_mirrored);
  constexpr std::size_t grain = 64;
  EdgeBudget budget(index);
  std::vector<std::vector<RawBound>> bounds(out.faces.size());
  const Execution quiet{.cancel = execution.cancel};
  Status status = parallel_for(out.faces.size(), grain, quiet, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) bounds[k] = read_face(index, out.faces[k], budget);
  });
  if (status.ok()) status = budget.status();
  if (!status.ok()) return status;
  Numbering numbering(out);
  for (std::size_t k = 0; k < out.faces.size(); ++k) numbering.add(out.faces[k], bounds[k]);
  std::vector<std::array<std::uint64_t, 2>> ends(out.edges.size());
  status = parallel_for(out.edges.size(), grain, quiet, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k)
      if (out.edges[k].number != 0) ends[k] = read_edge(index, out.edges[k]);
  });
  if (!status.ok()) return status;
  for (std::size_t k = 0; k < out.edges.size(); ++k) {
    StepEdge& edge = out.edges[k];
    if (edge.number == 0 || !edge.status.ok()) continue;
    edge.start = numbering.vertex(ends[k][0]);
    edge.end = numbering.vertex(ends[k][1]);
  }
  for (std::uint64_t& vertex : out.vertices) vertex = point_of(index, vertex);
  return out;
}

}}  // namespace tessera::abi_0_1
