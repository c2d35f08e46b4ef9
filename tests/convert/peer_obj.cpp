#include "convert/peer_obj.h"

#include <array>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "support/synthetic_sets.h"

namespace tessera::test {
namespace {

/// The statements of the file about one direction.
struct Direction {
  int degree = 0;
  int step = 0;  ///< for bases by a matrix: control points from one segment to the next
  std::vector<double> matrix, parameters;

  std::size_t segments() const { return parameters.size() - 1; }
};

struct ObjSurface {
  std::string type;
  std::array<Direction, 2> directions;
  std::vector<Vec3> points;  ///< u runs fastest
};

std::vector<double> numbers(std::istream& in) {
  std::vector<double> values;
  for (double value; in >> value;) values.push_back(value);
  return values;
}

ObjSurface parse(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("no file " + path.string());
  ObjSurface surface;
  auto& [u, v] = surface.directions;
  std::vector<Vec3> vertices;
  for (std::string line; std::getline(file, line);) {
    std::istringstream in(line);
    std::string key, which;
    in >> key;
    if (key == "v") {
      Vec3 p;
      in >> p.x >> p.y >> p.z;
      vertices.push_back(p);
    } else if (key == "cstype") {
      in >> surface.type;
    } else if (key == "deg") {
      in >> u.degree >> v.degree;
    } else if (key == "step") {
      in >> u.step >> v.step;
    } else if (key == "bmat") {
      in >> which;
      (which == "u" ? u : v).matrix = numbers(in);
    } else if (key == "parm") {
      in >> which;
      (which == "u" ? u : v).parameters = numbers(in);
    } else if (key == "surf") {
      double end;
      for (int k = 0; k < 4; ++k) in >> end;
      for (std::string reference; in >> reference;) {
        const int index = std::stoi(reference);  // what follows a slash is texture
        surface.points.push_back(index > 0 ? vertices.at(static_cast<std::size_t>(index) - 1)
                                           : vertices.at(vertices.size() - static_cast<std::size_t>(-index)));
      }
    }
  }
  return surface;
}

/// The points [i][j], i along u; the file has rows along u of `count_u` points.
std::vector<Vec3> ordered(const std::vector<Vec3>& points, std::size_t count_u) {
  std::vector<Vec3> result;
  for (std::size_t i = 0; i < count_u; ++i)
    for (std::size_t k = i; k < points.size(); k += count_u) result.push_back(points[k]);
  return result;
}

/// The knots: `bezier` parameters are breakpoints, each a knot of full multiplicity; `bspline` parameters are the
/// knots.
std::vector<double> knots(const ObjSurface& surface, const Direction& direction) {
  const std::vector<double>& parameters = direction.parameters;
  if (surface.type == "bspline") return parameters;
  std::vector<double> all{parameters.front()};
  for (const double t : parameters) all.insert(all.end(), static_cast<std::size_t>(direction.degree), t);
  all.push_back(parameters.back());
  return all;
}

/// Row i of `bmat` holds the coefficients of blending function i by powers of the segment's local parameter: the
/// transpose of M.
BasisMatrix basis_of(const ObjSurface& surface, const Direction& direction) {
  if (surface.type == "cardinal" && direction.degree == 3) return value_of(BasisMatrix::catmull_rom());
  if (surface.type == "taylor") return value_of(BasisMatrix::power(direction.degree));
  if (surface.type != "bmatrix") throw std::runtime_error("a surface of type " + surface.type);
  const std::size_t size = static_cast<std::size_t>(direction.degree) + 1;
  std::vector<double> transposed;
  for (std::size_t k = 0; k < size; ++k)
    for (std::size_t i = 0; i < size; ++i) transposed.push_back(direction.matrix.at(i * size + k));
  return value_of(BasisMatrix::custom(direction.degree, transposed));
}

int step_of(const ObjSurface& surface, const Direction& direction) {
  if (surface.type == "cardinal") return 1;
  if (surface.type == "taylor") {
    // Its powers are of the global parameter.
    if (direction.parameters != std::vector<double>{0, 1}) throw std::runtime_error("taylor beyond [0, 1]");
    return direction.degree + 1;
  }
  if (direction.step < 1) throw std::runtime_error("no step");
  return direction.step;
}

/// Segment (a, b) uses the points from (a step_u, b step_v) on.
std::vector<TensorPatch> pieces_of(const ObjSurface& surface) {
  const auto& [u, v] = surface.directions;
  const BasisMatrix basis_u = basis_of(surface, u), basis_v = basis_of(surface, v);
  const std::size_t step_u = static_cast<std::size_t>(step_of(surface, u)),
                    step_v = static_cast<std::size_t>(step_of(surface, v));
  const std::size_t m = static_cast<std::size_t>(u.degree), n = static_cast<std::size_t>(v.degree);
  const std::size_t count_u = (u.segments() - 1) * step_u + m + 1, count_v = (v.segments() - 1) * step_v + n + 1;
  if (count_u * count_v != surface.points.size()) throw std::runtime_error("control points do not fit the parameters");
  const std::vector<Vec3> points = ordered(surface.points, count_u);
  std::vector<TensorPatch> pieces;
  for (std::size_t a = 0; a < u.segments(); ++a)
    for (std::size_t b = 0; b < v.segments(); ++b) {
      std::vector<Vec3> geometry;
      for (std::size_t i = 0; i <= m; ++i)
        for (std::size_t j = 0; j <= n; ++j) geometry.push_back(points[(a * step_u + i) * count_v + b * step_v + j]);
      const Domain domain{u.parameters[a], u.parameters[a + 1], v.parameters[b], v.parameters[b + 1]};
      pieces.push_back(value_of(TensorPatch::make(basis_u, basis_v, geometry, domain)));
    }
  return pieces;
}

}  // namespace

PeerSurface read_obj_surface(const std::filesystem::path& path) {
  const ObjSurface parsed = parse(path);
  PeerSurface surface;
  surface.name = path.stem();
  if (parsed.type != "bezier" && parsed.type != "bspline") {
    surface.add(pieces_of(parsed));
    return surface;
  }
  const auto& [u, v] = parsed.directions;
  const std::vector<double> knots_u = knots(parsed, u), knots_v = knots(parsed, v);
  const std::size_t count_u = knots_u.size() - static_cast<std::size_t>(u.degree) - 1;
  surface.add(BSplineSurface::polynomial(u.degree, knots_u, v.degree, knots_v, ordered(parsed.points, count_u)));
  return surface;
}

}  // namespace tessera::test
