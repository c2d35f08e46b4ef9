// Glazed porcelain on a floor, under a sun and a sky. For each sample: a shadow ray, a ray for ambient light, and on the
// model a mirrored ray with a shadow ray of its own.

#include <algorithm>
#include <array>
#include <cmath>

#include "render/random.h"
#include "render/tile.h"

namespace tessera::render {
namespace {

const Vec3 porcelain{0.76, 0.78, 0.78};
const Vec3 shaded_neighbour{0.34, 0.31, 0.28};  // stands for light that comes from the model itself
constexpr double facet_distance = 1.5e-3;       // of the size: how far above the surface secondary rays begin
constexpr double glaze_at_right_angle = 0.05;   // reflectance of a glaze of refractive index 1.6
constexpr double highlight_roughness = 0.12;

/// A point to be lit.
struct Point {
  std::size_t sample = 0;  ///< in the tile
  Vec3 position;
  Vec3 normal;             ///< towards the viewer
  Vec3 direction;          ///< of the ray that came here
  bool on_model = false;
};

class LitTile {
 public:
  LitTile(const View& view, const TracedTile& traced) : view_(view), world_(view.environment), traced_(traced) {}
  Status shade(std::vector<Vec3>& colours);

 private:
  /// What a ray meets: a point of model or floor, or nothing.
  bool meet(std::size_t sample, const Ray& ray, const Hit& hit, Point& point) const;
  Ray leave(const Point& point, const Vec3& direction) const;
  Point2 random(const Point& point, Purpose purpose) const;
  Status sunlight(const std::vector<Point>& points, Purpose purpose, std::vector<Vec3>& light);
  Status ambient(const std::vector<Point>& points, std::vector<Vec3>& light);
  Status reflections(const std::vector<Point>& points, std::vector<Vec3>& light);
  Status occluded();
  Vec3 albedo(const Point& point) const { return point.on_model ? porcelain : world_.floor_colour(); }

  const View& view_;
  const Environment& world_;
  const TracedTile& traced_;
  std::vector<Ray> rays_;                 // secondary ones, reused
  std::vector<std::uint8_t> occluded_;
  std::vector<double> highlights_;
};

/// Schlick, An inexpensive BRDF model for physically-based rendering, 1994.
double fresnel(double cosine) {
  return glaze_at_right_angle + (1 - glaze_at_right_angle) * std::pow(1 - std::clamp(cosine, 0.0, 1.0), 5);
}

/// The GGX lobe (Walter et al., Microfacet models for refraction, EGSR 2007, eq. 33), scaled for a picture.
double highlight(const Vec3& normal, const Vec3& view, const Vec3& light) {
  const double cosine = std::max(dot(normal, normalized(view + light)), 0.0);
  constexpr double a2 = highlight_roughness * highlight_roughness;
  const double q = cosine * cosine * (a2 - 1) + 1;
  return 0.018 * a2 / (q * q) / a2;
}

bool LitTile::meet(std::size_t sample, const Ray& ray, const Hit& hit, Point& point) const {
  const bool met = hit.kind == HitKind::hit;
  const double farthest = met ? hit.t : std::numeric_limits<double>::infinity();
  point.sample = sample;
  point.direction = ray.direction;
  if (const auto t = world_.floor(ray.origin, ray.direction, farthest)) {
    point.position = ray.origin + *t * ray.direction;
    point.normal = {0, 0, 1};
    point.on_model = false;
    return true;
  }
  if (!met) return false;
  point.position = hit.position;
  point.normal = dot(hit.normal, ray.direction) > 0 ? -hit.normal : hit.normal;
  if (hit.normal == Vec3{}) point.normal = -ray.direction;
  point.on_model = true;
  return true;
}

Ray LitTile::leave(const Point& point, const Vec3& direction) const {
  Ray ray;
  ray.origin = point.position + facet_distance * view_.size * point.normal;
  ray.direction = direction;
  return ray;
}

Point2 LitTile::random(const Point& point, Purpose purpose) const {
  const Sample& sample = traced_.samples[point.sample];
  return stratified(sample.pixel, sample.index, view_.settings.samples, purpose);
}

Status LitTile::occluded() {
  occluded_.resize(rays_.size());
  return view_.scene.occluded(rays_, occluded_, Execution{.cancel = view_.cancel, .progress = {}});
}

/// Adds diffuse light and highlight of the sun, each with a ray to one place on its disc.
Status LitTile::sunlight(const std::vector<Point>& points, Purpose purpose, std::vector<Vec3>& light) {
  rays_.clear();
  for (const Point& point : points) {
    rays_.push_back(leave(point, cone_direction(world_.sun_direction(), world_.sun_tangent(), random(point, purpose))));
  }
  if (Status status = occluded(); !status.ok()) return status;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Point& point = points[k];
    const double cosine = dot(point.normal, rays_[k].direction);
    if (occluded_[k] || cosine <= 0) continue;
    light[k] += cosine * multiply(albedo(point), world_.sun_light());
    if (point.on_model) {
      light[k] += highlight(point.normal, -point.direction, world_.sun_direction()) * world_.sun_light();
    }
  }
  return {};
}

/// Adds diffuse light of everything else, from one direction a sample.
Status LitTile::ambient(const std::vector<Point>& points, std::vector<Vec3>& light) {
  rays_.clear();
  for (const Point& point : points) {
    rays_.push_back(leave(point, cosine_direction(point.normal, random(point, Purpose::ambient))));
  }
  if (Status status = occluded(); !status.ok()) return status;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vec3 from = occluded_[k] ? shaded_neighbour : world_.surroundings(rays_[k].direction);
    light[k] += multiply(albedo(points[k]), from);
  }
  return {};
}

/// Mirrors the surroundings in the glaze.
Status LitTile::reflections(const std::vector<Point>& points, std::vector<Vec3>& light) {
  rays_.clear();
  std::vector<std::size_t> owners;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Point& point = points[k];
    if (!point.on_model) continue;
    owners.push_back(k);
    rays_.push_back(leave(point, point.direction - 2 * dot(point.normal, point.direction) * point.normal));
  }
  std::vector<Hit> hits(rays_.size());
  Status status = view_.scene.closest(rays_, hits, Execution{.cancel = view_.cancel, .progress = {}});
  if (!status.ok()) return status;

  std::vector<Point> met;
  std::vector<std::size_t> met_by;
  std::vector<Vec3> mirrored(owners.size());
  for (std::size_t k = 0; k < owners.size(); ++k) {
    Point point;
    if (meet(points[owners[k]].sample, rays_[k], hits[k], point)) {
      met.push_back(point);
      met_by.push_back(k);
    } else {
      mirrored[k] = world_.sky(rays_[k].direction);
    }
  }
  std::vector<Vec3> met_light(met.size());
  if (status = sunlight(met, Purpose::bounce_sun, met_light); !status.ok()) return status;
  for (std::size_t k = 0; k < met.size(); ++k) {
    const Point& point = met[k];
    const Vec3 all = met_light[k] + multiply(albedo(point), mix(shaded_neighbour, world_.surroundings(point.normal), 0.5));
    mirrored[met_by[k]] = point.on_model ? all : world_.in_haze(all, point.position, point.direction);
  }
  for (std::size_t k = 0; k < owners.size(); ++k) {
    const Point& point = points[owners[k]];
    const double share = fresnel(-dot(point.normal, point.direction));
    light[owners[k]] = mix(light[owners[k]], mirrored[k], share);
  }
  return {};
}

Status LitTile::shade(std::vector<Vec3>& colours) {
  colours.resize(traced_.rays.size());
  std::vector<Point> points;
  for (std::size_t k = 0; k < traced_.rays.size(); ++k) {
    Point point;
    if (meet(k, traced_.rays[k], traced_.hits[k], point)) {
      points.push_back(point);
    } else {
      colours[k] = world_.sky(traced_.rays[k].direction);
    }
  }
  std::vector<Vec3> light(points.size());
  if (Status status = ambient(points, light); !status.ok()) return status;
  if (Status status = sunlight(points, Purpose::sun, light); !status.ok()) return status;
  if (Status status = reflections(points, light); !status.ok()) return status;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Point& point = points[k];
    colours[point.sample] = point.on_model ? light[k] : world_.in_haze(light[k], point.position, point.direction);
  }
  return {};
}

}  // namespace

Status shade_lit(const View& view, const TracedTile& traced, std::vector<Vec3>& colours) {
  return LitTile(view, traced).shade(colours);
}

}  // namespace tessera::render
