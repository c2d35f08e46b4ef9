#include "io/step/step_shell_sides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>
#include <vector>

#include "exact/spline_jets.h"
#include "exact/transposed.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Nodes and weights of Gauss's rule of 5 points on [-1, 1].
constexpr std::array<double, 5> gauss_nodes{-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831,
                                            0.9061798459386640};
constexpr std::array<double, 5> gauss_weights{0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                              0.4786286704993665, 0.2369268850561891};

/// The flux through a face of a field whose divergence is 1, by Green's theorem: an integral over its loops of the
/// integrals across them.
class FaceFlux {
 public:
  FaceFlux(const BSplineSurface& surface, const Vec3& centre)
      : at_(surface), domain_(surface.domain()), centre_(centre) {}

  double of(const std::vector<TrimLoop>& loops) {
    double turns_u = 0, turns_v = 0;
    for (const TrimLoop& loop : loops) {
      const Vec3 way = loop.curves.back().points().back() - loop.curves.front().points().front();
      turns_u += std::round(way.x / (domain_.u1 - domain_.u0)),
          turns_v += std::round(way.y / (domain_.v1 - domain_.v0));
      goes_around_v_ = goes_around_v_ || std::abs(way.y) > 0.5 * (domain_.v1 - domain_.v0);
    }
    // A face that ends with the surface on one side has no loop there, and is integrated from that side.
    from_ = goes_around_v_ ? (turns_v < 0 ? domain_.u1 : domain_.u0) : (turns_u > 0 ? domain_.v1 : domain_.v0);
    double flux = 0;
    for (const TrimLoop& loop : loops)
      for (const Curve& curve : loop.curves) flux += along(curve);
    return flux;
  }

 private:
  double density(double u, double v) const {
    const SurfacePlace place = at_(u, v);
    return dot(place.point - centre_, cross(place.du, place.dv)) / 3;
  }

  /// The integral from the side of the domain to a point of a loop.
  double across(const Vec3& p) const {
    const double to = goes_around_v_ ? p.x : p.y, half = 0.5 * (to - from_), middle = 0.5 * (to + from_);
    double sum = 0;
    for (std::size_t k = 0; k < 5; ++k) {
      const double there = middle + half * gauss_nodes[k];
      sum += gauss_weights[k] * (goes_around_v_ ? density(there, p.y) : density(p.x, there));
    }
    return half * sum;
  }

  double along(const Curve& curve) const {
    const FastCurve point(curve);
    const Interval d = curve.domain();
    double sum = 0, before = d.from;
    for (const double knot : curve.knots()) {
      const double next = std::min(knot, d.to);
      if (!(next > before)) continue;
      const double half = 0.5 * (next - before), middle = 0.5 * (next + before);
      for (std::size_t k = 0; k < 5; ++k) {
        const CurvePlace place = point(middle + half * gauss_nodes[k]);
        sum += half * gauss_weights[k] * across(place.point) * (goes_around_v_ ? place.slope.y : -place.slope.x);
      }
      before = next;
    }
    return sum;
  }

  FastSurface at_;
  Domain domain_;
  Vec3 centre_;
  bool goes_around_v_ = false;
  double from_ = 0;
};

const std::vector<TrimLoop>& loops_of(const ShapeFace& face) {
  return face.trims->empty() ? *face.outline : *face.trims;
}

/// The box of the control points of a shell.
Box3 box_of(const Shape& shape, const Shell& shell) {
  Box3 box;
  for (const std::uint32_t k : shell.faces)
    for (const Vec3& p : std::get<BSplineSurface>(shape.faces[k].surface).points()) box.extend(p);
  return box;
}

double enclosed_volume(const Shape& shape, const Shell& shell) {
  const Box3 box = box_of(shape, shell);
  double volume = 0;
  for (const std::uint32_t k : shell.faces) {
    const ShapeFace& face = shape.faces[k];
    if (!loops_of(face).empty())
      volume += FaceFlux(std::get<BSplineSurface>(face.surface), box.centre()).of(loops_of(face));
  }
  return volume;
}

Status turn_face(ShapeFace& face) {
  BSplineSurface surface = std::get<BSplineSurface>(face.surface);
  const bool is_whole = face.trims->empty();
  std::vector<TrimLoop> loops = loops_of(face);
  if (Status status = turn_around(surface, loops); !status.ok()) return status;
  face.surface = std::move(surface);
  (is_whole ? face.outline : face.trims) = std::move(loops);
  return {};
}

}  // namespace

Result<std::size_t> settle_shell_sides(Shape& shape) {
  std::size_t turned = 0;
  std::vector<std::vector<std::size_t>> shells_of(shape.solid_count);
  for (std::size_t k = 0; k < shape.shells.size(); ++k)
    if (shape.shells[k].solid != no_id) shells_of[shape.shells[k].solid].push_back(k);
  for (const std::vector<std::size_t>& shells : shells_of) {
    if (shells.size() < 2) continue;
    std::vector<double> volumes;
    for (const std::size_t k : shells) volumes.push_back(enclosed_volume(shape, shape.shells[k]));
    const auto skin = std::ranges::max_element(volumes, {}, [](double volume) { return std::abs(volume); });
    const Box3 around = box_of(shape, shape.shells[shells[static_cast<std::size_t>(skin - volumes.begin())]]);
    for (std::size_t k = 0; k < shells.size(); ++k) {
      const bool is_skin = volumes.begin() + static_cast<std::ptrdiff_t>(k) == skin;
      const bool is_void = !is_skin && around.contains(box_of(shape, shape.shells[shells[k]]));
      if (volumes[k] == 0 || (volumes[k] > 0) != is_void) continue;
      ++turned;
      for (const std::uint32_t face : shape.shells[shells[k]].faces)
        if (Status status = turn_face(shape.faces[face]); !status.ok()) return status;
    }
  }
  return turned;
}

}}  // namespace tessera::abi_0_1
