#include "io/step/step_shape.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include "exact/usable_edges.h"
#include "io/step/step_face.h"
#include "io/step/step_shell_sides.h"
#include "io/step/step_topology.h"
#include "parallel/call_progress.h"
#include "parallel/parallel_for.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Points that are nearer to each other are one: what the file states, within reason for a part of this size.
double tolerance_of(double uncertainty, const Box3& box) {
  if (box.empty()) return uncertainty > 0 ? uncertainty : 1e-7;
  const double size = box.diagonal();
  const double least = std::max(1e-12 * std::max(max_abs(box.lower), max_abs(box.upper)), 1e-9 * size);
  const double stated = uncertainty > 0 ? uncertainty : 1e-6 * size;
  return std::clamp(stated, std::max(least, 1e-100), std::max({least, 1e-3 * size, 1e-100}));
}

/// Makes one part.
class ShapeMaker {
 public:
  ShapeMaker(const StepIndex& index, const StepShapeInput& input, StepShapeFaults& faults, const Execution& execution)
      : geometry_(index, input.units), input_(input), faults_(faults), index_(index), progress_(execution, loop_ends) {}

  Result<Shape> make() {
    Result<StepTopology> topology = StepTopology::make(index_, input_.items, input_.is_mirrored, progress_.loops());
    if (!topology) return topology.status();
    topology_ = *std::move(topology);
    for (std::string& sentence : topology_.unread) faults_.left_out.push_back(std::move(sentence));
    if (Status status = make_vertices(); !status.ok()) return status;
    if (Status status = make_edges(); !status.ok()) return status;
    if (Status status = make_faces(); !status.ok()) return status;
    shape_.name = input_.name;
    shape_.solid_count = topology_.solid_count;
    for (const std::uint32_t solid : topology_.shells) shape_.shells.push_back({{}, solid});
    for (std::size_t k = 0; k < results_.size(); ++k) add_face(k);
    const Result<std::size_t> turned = settle_shell_sides(shape_);
    if (!turned) return turned.status();
    for (const UnusableEdges& one : drop_unusable_edges(shape_))
      faults_.changed.push_back(words(kept_[one.face]) + " is read without shared edges: " + one.reason);
    return std::move(shape_);
  }

 private:
  static constexpr std::size_t grain = 16;
  static constexpr std::array loop_ends{0.02, 0.2, 1.0};  // of the loops over vertices, edges and faces

  Status make_vertices() {
    shape_.vertices.resize(topology_.vertices.size());
    std::vector<Status> faults(shape_.vertices.size());
    Status status =
        parallel_for(shape_.vertices.size(), 256, progress_.loops(), [&](std::size_t begin, std::size_t end) {
          for (std::size_t k = begin; k < end; ++k) {
            const Result<Vec3> p = geometry_.point(topology_.vertices[k]);
            if (p)
              shape_.vertices[k].position = *p;
            else
              faults[k] = p.status();
          }
        });
    if (!status.ok()) return status;
    Box3 box;
    for (std::size_t k = 0; k < faults.size(); ++k)
      if (faults[k].ok()) box.extend(shape_.vertices[k].position);
    extend_by_round_edges(faults, box);
    tolerance_ = tolerance_of(input_.uncertainty, box);
    for (BrepVertex& vertex : shape_.vertices) vertex.tolerance = tolerance_;
    for (StepEdge& edge : topology_.edges)
      for (const std::uint32_t vertex : {edge.start, edge.end})
        if (edge.status.ok() && !faults[vertex].ok()) edge.status = faults[vertex];
    for (StepFace& face : topology_.faces)
      for (const StepBound& bound : face.bounds)
        if (bound.vertex != no_id && face.status.ok()) face.status = faults[bound.vertex];
    return {};
  }

  /// Extends the box by edges that begin and end at one vertex: the vertices of a small part may be all at one place.
  void extend_by_round_edges(const std::vector<Status>& faults, Box3& box) const {
    constexpr std::size_t few = 16;
    constexpr double everything = std::numeric_limits<double>::max();  // all of each curve
    if (shape_.vertices.size() > few) return;
    for (const StepEdge& edge : topology_.edges) {
      if (!edge.status.ok() || edge.start != edge.end || !faults[edge.start].ok()) continue;
      const Vec3 end = shape_.vertices[edge.start].position;
      const Result<StepEdgeCurve> made = geometry_.edge_curve(edge.curve, {end, end}, edge.agrees, everything);
      constexpr double farthest = 1e150;  // as for points
      for (const Vec3& p : made ? made->curve.points() : std::span<const Vec3>())
        if (max_abs(p) <= farthest) box.extend(p);
    }
  }

  Status make_edges() {
    shape_.edges.resize(topology_.edges.size());
    std::vector<char> reversed(shape_.edges.size());
    Status status =
        parallel_for(shape_.edges.size(), grain, progress_.loops(), [&](std::size_t begin, std::size_t end) {
          for (std::size_t k = begin; k < end; ++k) reversed[k] = make_edge(topology_.edges[k], shape_.edges[k]);
        });
    reversed_.assign(reversed.begin(), reversed.end());
    return status;
  }

  /// Makes an edge, which runs along its curve. Returns whether that is against the file's edge.
  bool make_edge(StepEdge& edge, BrepEdge& out) const {
    if (!edge.status.ok()) return false;
    Result<StepEdgeCurve> curve = curve_of(edge);
    if (!curve) {
      edge.status = curve.status();
      return false;
    }
    out.start = curve->reversed ? edge.end : edge.start;
    out.end = curve->reversed ? edge.start : edge.end;
    out.range = curve->curve.domain();
    out.curve = std::move(curve->curve);
    out.tolerance = tolerance_;
    out.same_parameter = true;
    return curve->reversed;
  }

  Result<StepEdgeCurve> curve_of(const StepEdge& edge) const {
    const std::array<Vec3, 2> ends{shape_.vertices[edge.start].position, shape_.vertices[edge.end].position};
    if (edge.number != 0) return geometry_.edge_curve(edge.curve, ends, edge.agrees, tolerance_);
    const std::array<double, 4> knots{0, 0, 1, 1};
    Result<Curve> line = Curve::b_spline(1, ends, knots);
    if (!line) return line.status();
    return StepEdgeCurve{*std::move(line), false};
  }

  Status make_faces() {
    results_.resize(topology_.faces.size());
    const StepFaceContext context{geometry_, shape_.edges, reversed_, shape_.vertices, tolerance_};
    for (StepFace& face : topology_.faces)
      for (const StepBound& bound : face.bounds)
        for (const StepEdgeUse& use : bound.uses)
          if (face.status.ok()) face.status = topology_.edges[use.edge].status;
    // Each face has a copy of its surface, but a file must not grow by that. Fits have a limit of their own.
    const std::size_t max_points = 64 * index_.instances().size() + (std::size_t{1} << 22);
    std::atomic<std::size_t> points = 0;
    Status status = parallel_for(topology_.faces.size(), 4, progress_.loops(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end && points <= max_points; ++k) {
        StepFace& face = topology_.faces[k];
        if (!face.status.ok()) continue;
        Result<StepFaceResult> made = step_face(face, context);
        if (!made) {
          face.status = made.status();
          continue;
        }
        if (made->fit_error == 0) points += made->surface.points().size();
        results_[k] = *std::move(made);
      }
    });
    if (status.ok() && points > max_points)
      return {StatusCode::unsupported,
              "the surfaces of a part have more than " + std::to_string(max_points) + " control points"};
    return status;
  }

  /// "face #51 (nut)".
  std::string words(std::size_t face) const {
    return "face #" + std::to_string(topology_.faces[face].number) +
           (input_.name.empty() ? "" : " (" + input_.name + ")");
  }

  void add_face(std::size_t k) {
    const StepFace& face = topology_.faces[k];
    if (!results_[k]) {
      if (faults_.left_out.empty()) faults_.first_code = face.status.code();
      return faults_.left_out.push_back(words(k) + " is left out: " + face.status.message());
    }
    StepFaceResult& made = *results_[k];
    if (made.fit_error > 0) ++faults_.fitted, faults_.worst_fit = std::max(faults_.worst_fit, made.fit_error);
    if (made.is_rough)
      faults_.changed.push_back(words(k) + " has a border that curves follow only roughly: see the gaps of its edges");
    for (StepOwnEdge& own : made.own_edges) {
      for (const StepOwnEdge::Use& use : own.uses)
        made.loops[use.loop].coedges[use.curve].edge = static_cast<std::uint32_t>(shape_.edges.size());
      own.edge.tolerance = tolerance_;
      shape_.edges.push_back(std::move(own.edge));
    }
    for (TrimLoop& loop : made.loops)
      if (std::ranges::any_of(loop.coedges, [](const Coedge& coedge) { return coedge.edge == no_id; })) {
        loop.coedges.clear();
        faults_.changed.push_back(words(k) + " is read without shared edges: a curve of its border turns back");
      }
    const auto index = static_cast<std::uint32_t>(shape_.faces.size());
    ShapeFace& out = shape_.faces.emplace_back(ShapeFace{{input_.name, std::move(made.surface), {}}});
    (made.whole ? out.outline : out.trims) = std::move(made.loops);
    kept_.push_back(k);
    out.colour = colour_of(face);
    for (std::uint32_t whole = face.whole; whole != no_id; whole = topology_.wholes[whole].above)
      if (const std::uint32_t shell = topology_.wholes[whole].shell; shell != no_id) {
        shape_.shells[shell].faces.push_back(index);
        break;
      }
  }

  std::optional<Colour> colour_of(const StepFace& face) const {
    if (!input_.colours) return {};
    const Colour* found = input_.colours->find(face.number);
    for (std::uint32_t whole = face.whole; whole != no_id && !found; whole = topology_.wholes[whole].above)
      found = input_.colours->find(topology_.wholes[whole].number);
    if (!found) found = input_.colours->find(input_.representation);
    return found ? std::optional<Colour>(*found) : std::nullopt;
  }

  StepGeometry geometry_;
  const StepShapeInput& input_;
  StepShapeFaults& faults_;
  const StepIndex& index_;
  CallProgress progress_;
  StepTopology topology_;
  Shape shape_;
  std::vector<bool> reversed_;
  std::vector<std::optional<StepFaceResult>> results_;
  std::vector<std::size_t> kept_;  ///< of each face of the shape, its place in the topology
  double tolerance_ = 0;
};

}  // namespace

Result<Shape> step_shape(const StepIndex& index, const StepShapeInput& input, StepShapeFaults& faults,
                         const Execution& execution) {
  return ShapeMaker(index, input, faults, execution).make();
}

}}  // namespace tessera::abi_0_1
