#include "compare/deviations.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "console/console.h"
#include "tessera/bezier_patch.h"

namespace tessera::cli {
namespace {

constexpr std::size_t points_per_chunk = std::size_t{1} << 15;
constexpr double anywhere = std::numeric_limits<double>::infinity();

Status too_far() { return {StatusCode::unsupported, "the mesh is too far away from the model to be compared with it"}; }

/// Calls chunk(first, end) for runs of `count` points, one after the other, until one fails. Errors: cancelled, and
/// what `chunk` returns.
template <class Chunk>
Status in_chunks(std::size_t count, const ShareDone& done, const Chunk& chunk) {
  for (std::size_t first = 0; first < count; first += points_per_chunk) {
    const std::size_t end = std::min(count, first + points_per_chunk);
    if (interrupted()) return {StatusCode::cancelled, "interrupted"};
    if (Status status = chunk(first, end); !status.ok()) return status;
    done(static_cast<double>(end) / static_cast<double>(count));
  }
  return {};
}

/// Adds up distances: those of vertices first, then those of points spread evenly. Sums have the order of the points.
class DeviationSums {
 public:
  DeviationSums(std::size_t vertices, std::size_t samples) {
    found_.vertices = vertices, found_.samples = samples;
    distances_.reserve(samples);
  }

  void add(const DeviationPlace& place) {
    if (count_ == 0 || place.distance > found_.largest.distance) found_.largest = place;
    found_.uncertified += !place.surface.flags.certified;
    if (count_++ < found_.vertices) return;
    distances_.push_back(place.distance);
    sum_ += place.distance;
    squares_ += place.distance * place.distance;
  }

  /// All figures. Call it once, last.
  Deviations take() {
    if (distances_.empty()) return found_;
    const auto count = static_cast<double>(distances_.size());
    found_.mean = sum_ / count;
    found_.rms = std::sqrt(squares_ / count);
    const auto within = static_cast<std::size_t>(std::ceil(0.99 * count)) - 1;
    const auto place = distances_.begin() + static_cast<std::ptrdiff_t>(within);
    std::nth_element(distances_.begin(), place, distances_.end());
    found_.percentile_99 = *place;
    return found_;
  }

 private:
  Deviations found_;
  std::size_t count_ = 0;
  double sum_ = 0, squares_ = 0;
  std::vector<double> distances_;  ///< of the points spread evenly
};

/// The vertices that triangles have, in rising order.
std::vector<std::uint32_t> vertices_of_triangles(const Mesh& mesh) {
  std::vector<bool> used(mesh.vertex_count());
  for (const std::uint32_t vertex : mesh.indices) used[vertex] = true;
  std::vector<std::uint32_t> vertices;
  for (std::size_t k = 0; k < used.size(); ++k)
    if (used[k]) vertices.push_back(static_cast<std::uint32_t>(k));
  return vertices;
}

/// The deviations of a mesh, run of points by run of points.
class MeshComparison {
 public:
  MeshComparison(const ComparedModel& model, const Mesh& mesh, std::size_t samples)
      : model_(model), mesh_(mesh), vertices_(vertices_of_triangles(mesh)), sums_(vertices_.size(), samples) {
    if (model.is_closed()) found_.to_sides.emplace();
    found_.of_vertices.resize(mesh.vertex_count());
  }

  Result<MeshDeviations> run(const EvenPoints& even, std::size_t samples, const ShareDone& done) {
    const std::size_t vertices = vertices_.size();
    const Status status = in_chunks(vertices + samples, done, [&](std::size_t first, std::size_t end) {
      points_.clear();
      for (std::size_t k = first; k < end; ++k)
        points_.push_back(k < vertices ? render::position_of(mesh_, vertices_[k])
                                       : place_of(mesh_, even.point(k - vertices, samples)));
      return compare(first);
    });
    if (!status.ok()) return status;
    found_.all = sums_.take();
    if (found_.to_sides && samples > 0) found_.to_sides->mean = signed_sum_ / static_cast<double>(samples);
    return std::move(found_);
  }

 private:
  Status compare(std::size_t first) {
    const Execution execution{.cancel = &interrupted()};
    nearest_.resize(points_.size()), sides_.resize(points_.size());
    if (Status status = model_.points().nearest(points_, nearest_, anywhere, execution); !status.ok()) return status;
    if (model_.is_closed())
      if (Status status = model_.solid().contains(points_, sides_, execution); !status.ok()) return status;
    for (std::size_t k = 0; k < points_.size(); ++k) {
      if (nearest_[k].kind != NearestKind::found) return too_far();
      sums_.add({nearest_[k].distance, points_[k], nearest_[k]});
      const double deviation = found_.to_sides ? add_side(nearest_[k], sides_[k]) : nearest_[k].distance;
      if (first + k < vertices_.size())
        found_.of_vertices[vertices_[first + k]] = static_cast<float>(deviation);
      else
        signed_sum_ += deviation;
    }
    return {};
  }

  /// Counts the side of a point, and returns its signed distance.
  double add_side(const NearestPoint& nearest, const Containment& found) {
    SignedDeviations& sides = *found_.to_sides;
    const bool is_inside = found.side == PointSide::inside;
    sides.unsure += !found.certified && nearest.distance > nearest.rounding;
    double& largest = is_inside ? sides.inside : sides.outside;
    largest = std::max(largest, nearest.distance);
    return is_inside ? -nearest.distance : nearest.distance;
  }

  const ComparedModel& model_;
  const Mesh& mesh_;
  std::vector<std::uint32_t> vertices_;
  DeviationSums sums_;
  MeshDeviations found_;
  double signed_sum_ = 0;
  std::vector<Vec3> points_;
  std::vector<NearestPoint> nearest_;
  std::vector<Containment> sides_;
};

/// The parameters of a vertex on its patch.
std::array<double, 2> parameters_of(const Mesh& mesh, std::size_t vertex) {
  return {mesh.parameters[2 * vertex], mesh.parameters[2 * vertex + 1]};
}

/// The point of the surface at a point of a triangle.
Vec3 surface_point(const PatchSet& set, const Mesh& drawn, const TrianglePoint& at) {
  const std::uint32_t* const corners = &drawn.indices[3 * at.triangle];
  const auto a = parameters_of(drawn, corners[0]), b = parameters_of(drawn, corners[1]),
             c = parameters_of(drawn, corners[2]);
  const auto mixed = [&](std::size_t d) {
    return std::clamp(a[d] + at.b * (b[d] - a[d]) + at.c * (c[d] - a[d]), 0.0, 1.0);
  };
  return de_casteljau(set.patch(drawn.patches[at.triangle]), mixed(0), mixed(1));
}

/// The corner of a triangle at each vertex that triangles have, in rising order of the vertices.
std::vector<TrianglePoint> corners_at_vertices(const Mesh& mesh) {
  const std::vector<std::uint32_t> vertices = vertices_of_triangles(mesh);
  std::vector<std::size_t> corners(mesh.vertex_count());
  for (std::size_t k = mesh.indices.size(); k-- > 0;) corners[mesh.indices[k]] = k;
  std::vector<TrianglePoint> points;
  points.reserve(vertices.size());
  for (const std::uint32_t vertex : vertices) {
    const std::size_t corner = corners[vertex];
    points.push_back({corner / 3, corner % 3 == 1 ? 1.0 : 0.0, corner % 3 == 2 ? 1.0 : 0.0});
  }
  return points;
}

}  // namespace

Result<ComparedModel> ComparedModel::make(const PatchSet& set,
                                          const std::function<Execution(const char* work)>& execution) {
  Result<PointScene> points = PointScene::make(set, execution("building the search for points"));
  if (!points) return points.status();
  ComparedModel made(set, *std::move(points));
  const auto ends = [](StatusCode code) { return code == StatusCode::cancelled || code == StatusCode::out_of_memory; };
  Result<RayScene> rays = RayScene::make(set, {}, execution("building the search for sides"));
  if (!rays) return ends(rays.status().code()) ? Result<ComparedModel>(rays.status()) : std::move(made);
  Result<Solid> solid = Solid::make(*rays, execution("finding sides"));
  if (!solid && ends(solid.status().code())) return solid.status();
  if (solid && solid->is_closed()) made.rays_ = *std::move(rays), made.solid_ = *std::move(solid);
  return made;
}

double ComparedModel::deviation(const Vec3& point) const {
  const double distance = points_.nearest(point).distance;
  return solid_ && solid_->contains(point).side == PointSide::inside ? -distance : distance;
}

Result<MeshDeviations> deviations_of_mesh(const ComparedModel& model, const Mesh& mesh, const EvenPoints& even,
                                          std::size_t samples, const ShareDone& done) {
  return MeshComparison(model, mesh, samples).run(even, samples, done);
}

Result<Deviations> deviations_of_model(const ComparedModel& model, const Mesh& drawn, const EvenPoints& even,
                                       std::size_t samples, const render::MeshDistance& mesh, const ShareDone& done) {
  const std::vector<TrianglePoint> corners = corners_at_vertices(drawn);
  DeviationSums sums(corners.size(), samples);
  std::vector<Vec3> points;
  std::vector<std::optional<Vec3>> on_mesh;
  std::vector<NearestPoint> kept;
  std::vector<DeviationPlace> places;
  const Status status = in_chunks(corners.size() + samples, done, [&](std::size_t first, std::size_t end) -> Status {
    points.resize(end - first), kept.resize(end - first), on_mesh.resize(end - first);
    tbb::parallel_for(first, end, [&](std::size_t k) {
      const TrianglePoint at = k < corners.size() ? corners[k] : even.point(k - corners.size(), samples);
      points[k - first] = surface_point(model.set(), drawn, at);
    });
    const Execution execution{.cancel = &interrupted()};
    if (Status found = model.points().nearest(points, kept, anywhere, execution); !found.ok()) return found;
    tbb::parallel_for(std::size_t{0}, end - first,
                      [&](std::size_t k) { on_mesh[k] = mesh.nearest(kept[k].position, anywhere); });
    for (std::size_t k = 0; k < end - first; ++k) {
      if (!on_mesh[k]) return too_far();
      sums.add({length(*on_mesh[k] - kept[k].position), *on_mesh[k], kept[k]});
    }
    return {};
  });
  if (!status.ok()) return status;
  return sums.take();
}

}  // namespace tessera::cli
