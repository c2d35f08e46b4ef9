// Glazed porcelain on a floor, under a sun and a sky. For each sample: a shadow ray, a ray for ambient light, and on
// the model a mirrored ray with a shadow ray of its own.

#include <algorithm>
#include <cmath>

#include "render/random.h"
#include "render/tile.h"

namespace tessera::render {
namespace {

const Vec3 porcelain{0.76, 0.78, 0.78};
const Vec3 shaded_neighbour{0.34, 0.31, 0.28};  // stands for light from the model itself
constexpr double facet_distance = 1.5e-3;       // of the size: the height above the surface where secondary rays begin
constexpr double glaze_at_right_angle = 0.05;   // reflectance of a glaze of refractive index 1.6
constexpr double highlight_roughness = 0.12;

/// IEC 61966-2-1.
double to_linear(double x) { return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4); }

class LitTile {
 public:
  LitTile(const View& view, Workspace& work) : view_(view), world_(view.environment), work_(work) {}
  Status shade();

 private:
  /// Finds what a ray meets, a point of model or floor; false if nothing.
  bool meet(std::size_t sample, const Ray& ray, const Hit& hit, Point& point) const;
  Ray leave(const Point& point, const Vec3& direction) const;
  Point2 random(const Point& point, Purpose purpose) const;
  Status sunlight(const std::vector<Point>& points, Purpose purpose, std::vector<Vec3>& light);
  Status ambient(const std::vector<Point>& points, std::vector<Vec3>& light);
  Status reflections(const std::vector<Point>& points, std::vector<Vec3>& light);
  Status trace_mirrors(const std::vector<Point>& points);
  Status occluded();
  /// Reflected shares of the model's colour; a white face reflects a little more than porcelain.
  Vec3 albedo(const Hit& hit) const {
    const std::optional<Vec3> colour = srgb_colour(view_.settings, hit);
    constexpr double white = 0.8;
    return colour ? white * Vec3{to_linear(colour->x), to_linear(colour->y), to_linear(colour->z)} : porcelain;
  }

  const View& view_;
  const Environment& world_;
  Workspace& work_;
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
    point.normal = world_.up();
    point.albedo = world_.floor_colour();
    point.on_model = false;
    return true;
  }
  if (!met) return false;
  point.position = hit.position;
  const Vec3 normal = shading_normal(view_.settings, hit);
  point.normal = dot(normal, ray.direction) > 0 ? -normal : normal;
  if (normal == Vec3{}) point.normal = -ray.direction;
  point.albedo = albedo(hit);
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
  const Sample& sample = work_.samples[point.sample];
  return stratified(sample.pixel, sample.index, view_.settings.samples, purpose);
}

Status LitTile::occluded() {
  work_.occluded.resize(work_.secondary_rays.size());
  return view_.scene.occluded(work_.secondary_rays, work_.occluded, Execution{.cancel = view_.cancel, .progress = {}});
}

/// Adds diffuse light and highlight of the sun, each by a ray to one place on its disc.
Status LitTile::sunlight(const std::vector<Point>& points, Purpose purpose, std::vector<Vec3>& light) {
  work_.secondary_rays.clear();
  for (const Point& point : points) {
    work_.secondary_rays.push_back(
        leave(point, cone_direction(world_.sun_direction(), world_.sun_tangent(), random(point, purpose))));
  }
  if (Status status = occluded(); !status.ok()) return status;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Point& point = points[k];
    const double cosine = dot(point.normal, work_.secondary_rays[k].direction);
    if (work_.occluded[k] || cosine <= 0) continue;
    light[k] += cosine * multiply(point.albedo, world_.sun_light());
    if (point.on_model) {
      light[k] += highlight(point.normal, -point.direction, world_.sun_direction()) * world_.sun_light();
    }
  }
  return {};
}

/// Adds diffuse light from all else, by one direction per sample; in simple light without rays: a mean of
/// sky and floor by the normal, and a quarter from neighbours.
Status LitTile::ambient(const std::vector<Point>& points, std::vector<Vec3>& light) {
  if (view_.settings.simple_light) {
    const Vec3 above = world_.surroundings(world_.up()), below = world_.surroundings(-world_.up());
    for (std::size_t k = 0; k < points.size(); ++k) {
      const Vec3 around = mix(below, above, 0.5 + 0.5 * dot(points[k].normal, world_.up()));
      light[k] += multiply(points[k].albedo, mix(shaded_neighbour, around, 0.75));
    }
    return {};
  }
  work_.secondary_rays.clear();
  for (const Point& point : points) {
    work_.secondary_rays.push_back(leave(point, cosine_direction(point.normal, random(point, Purpose::ambient))));
  }
  if (Status status = occluded(); !status.ok()) return status;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Vec3 from = work_.occluded[k] ? shaded_neighbour : world_.surroundings(work_.secondary_rays[k].direction);
    light[k] += multiply(points[k].albedo, from);
  }
  return {};
}

/// Traces the mirrored rays of the points on the model.
Status LitTile::trace_mirrors(const std::vector<Point>& points) {
  work_.secondary_rays.clear();
  work_.mirrors.clear();
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Point& point = points[k];
    if (!point.on_model) continue;
    work_.mirrors.push_back(k);
    work_.secondary_rays.push_back(
        leave(point, point.direction - 2 * dot(point.normal, point.direction) * point.normal));
  }
  work_.secondary_hits.resize(work_.secondary_rays.size());
  Status status = view_.scene.closest(work_.secondary_rays, work_.secondary_hits,
                                      Execution{.cancel = view_.cancel, .progress = {}});
  work_.mirrored.assign(work_.mirrors.size(), {});
  work_.mirrored_points.clear();
  work_.mirrored_by.clear();
  for (std::size_t k = 0; k < work_.mirrors.size(); ++k) {
    Point point;
    if (meet(points[work_.mirrors[k]].sample, work_.secondary_rays[k], work_.secondary_hits[k], point)) {
      work_.mirrored_points.push_back(point);
      work_.mirrored_by.push_back(k);
    } else {
      work_.mirrored[k] = world_.sky(work_.secondary_rays[k].direction);
    }
  }
  return status;
}

/// Adds the reflection of the surroundings in the glaze. Reflected points are lit by the sun and by half of their
/// surroundings.
Status LitTile::reflections(const std::vector<Point>& points, std::vector<Vec3>& light) {
  if (Status status = trace_mirrors(points); !status.ok()) return status;
  const std::vector<Point>& met = work_.mirrored_points;
  work_.mirrored_light.assign(met.size(), {});
  if (Status status = sunlight(met, Purpose::bounce_sun, work_.mirrored_light); !status.ok()) return status;
  for (std::size_t k = 0; k < met.size(); ++k) {
    const Point& point = met[k];
    const Vec3 around = mix(shaded_neighbour, world_.surroundings(point.normal), 0.5);
    const Vec3 all = work_.mirrored_light[k] + multiply(point.albedo, around);
    work_.mirrored[work_.mirrored_by[k]] = point.on_model ? all : world_.in_haze(all, point.position, point.direction);
  }
  for (std::size_t k = 0; k < work_.mirrors.size(); ++k) {
    const Point& point = points[work_.mirrors[k]];
    Vec3& own = light[work_.mirrors[k]];
    own = mix(own, work_.mirrored[k], fresnel(-dot(point.normal, point.direction)));
  }
  return {};
}

Status LitTile::shade() {
  work_.colours.resize(work_.rays.size());
  work_.points.clear();
  for (std::size_t k = 0; k < work_.rays.size(); ++k) {
    Point point;
    if (meet(k, work_.rays[k], work_.hits[k], point)) {
      work_.points.push_back(point);
    } else {
      work_.colours[k] = world_.sky(work_.rays[k].direction);
    }
  }
  const std::vector<Point>& points = work_.points;
  std::vector<Vec3>& light = work_.light;
  light.assign(points.size(), {});
  if (Status status = ambient(points, light); !status.ok()) return status;
  if (Status status = sunlight(points, Purpose::sun, light); !status.ok()) return status;
  if (!view_.settings.simple_light) {
    if (Status status = reflections(points, light); !status.ok()) return status;
  }
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Point& point = points[k];
    work_.colours[point.sample] = point.on_model ? light[k] : world_.in_haze(light[k], point.position, point.direction);
  }
  return {};
}

}  // namespace

Status shade_lit(const View& view, Workspace& work) { return LitTile(view, work).shade(); }

}  // namespace tessera::render
