#include "occt/poly_checks.h"

#include <opencascade/BRepAdaptor_Surface.hxx>
#include <opencascade/BRepBndLib.hxx>
#include <opencascade/BRepTools.hxx>
#include <opencascade/BRep_Tool.hxx>
#include <opencascade/Bnd_Box.hxx>
#include <opencascade/Geom2d_Curve.hxx>
#include <opencascade/Geom_Curve.hxx>
#include <opencascade/Poly_PolygonOnTriangulation.hxx>
#include <opencascade/Poly_Triangulation.hxx>
#include <opencascade/StlAPI_Writer.hxx>
#include <opencascade/TopExp_Explorer.hxx>
#include <opencascade/TopoDS.hxx>
#include <opencascade/TopoDS_Edge.hxx>
#include <opencascade/TopoDS_Face.hxx>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "support/scratch_folder.h"

namespace tessera::test {
namespace {

using opencascade::handle;
using Side = std::pair<int, int>;

/// The polygon of an edge on one of its faces, in the space of the whole shape.
struct Line {
  std::vector<double> parameters;
  std::vector<gp_Pnt> points;
};

class Checker {
 public:
  Checker(const TopoDS_Shape& shape, const OcctMeshReport& report) : shape_(shape), report_(report) {
    size_ = size_of(shape);
  }

  PolyFacts run() {
    std::set<const void*> left_out, faulty, seen;
    for (const OcctMeshFault& one : report_.left_out) left_out.insert(one.part.TShape().get());
    for (const OcctMeshFault& one : report_.faults) faulty.insert(one.part.TShape().get());
    for (TopExp_Explorer at(shape_, TopAbs_FACE); at.More(); at.Next()) {
      const TopoDS_Face face = TopoDS::Face(at.Current().Oriented(TopAbs_FORWARD));
      if (!seen.insert(face.TShape().get()).second || left_out.contains(face.TShape().get())) continue;
      check(face, faulty.contains(face.TShape().get()));
    }
    return std::move(facts_);
  }

 private:
  void complain(const std::string& what) {
    ++facts_.violations;
    if (facts_.wrong.size() < 8) facts_.wrong.push_back("face " + std::to_string(facts_.faces) + ": " + what);
  }

  void check(const TopoDS_Face& face, bool is_faulty) {
    ++facts_.faces;
    TopLoc_Location place;
    const handle<Poly_Triangulation> mesh = BRep_Tool::Triangulation(face, place);
    if (mesh.IsNull() && is_faulty) return --facts_.faces, static_cast<void>(0);  // too thin
    if (mesh.IsNull()) return complain("it has no triangulation");
    facts_.nodes += static_cast<std::size_t>(mesh->NbNodes());
    facts_.triangles += static_cast<std::size_t>(mesh->NbTriangles());
    if (!mesh->HasUVNodes() || !mesh->HasNormals()) return complain("it has no parameters or normals");
    if (!(mesh->Deflection() > 0)) complain("it has no deflection");
    find_rectangle(face);
    check_nodes(face, *mesh);
    std::map<Side, int> sides;
    if (!check_triangles(*mesh, sides) || is_faulty) return;
    for (TopExp_Explorer at(face, TopAbs_EDGE); at.More(); at.Next())
      check_edge(TopoDS::Edge(at.Current()), face, mesh, place, sides);
    if (!leaves_surface_) check_border(face, *mesh, sides);
  }

  /// Finds the rectangle of the face's border. OpenCASCADE's own misses what a periodic spline has behind its seam.
  void find_rectangle(const TopoDS_Face& face) {
    BRepTools::UVBounds(face, rectangle_[0], rectangle_[1], rectangle_[2], rectangle_[3]);
    const BRepAdaptor_Surface whole(face, false);
    const double du = whole.UResolution(1e-7 * size_), dv = whole.VResolution(1e-7 * size_);
    constexpr int samples = 512;  // to within 1e-5 of the rectangle, where curves are smooth
    leaves_surface_ = false;
    for (TopExp_Explorer at(face, TopAbs_EDGE); at.More(); at.Next()) {
      double from = 0, to = 0;
      const handle<Geom2d_Curve> curve = BRep_Tool::CurveOnSurface(TopoDS::Edge(at.Current()), face, from, to);
      if (curve.IsNull()) continue;
      for (int k = 0; k <= samples; ++k) {
        const gp_Pnt2d point = curve->Value(from + (to - from) * k / samples);
        rectangle_ = {std::min(rectangle_[0], point.X()), std::max(rectangle_[1], point.X()),
                      std::min(rectangle_[2], point.Y()), std::max(rectangle_[3], point.Y())};
        leaves_surface_ = leaves_surface_ ||
                          (!whole.IsUPeriodic() &&
                           (point.X() < whole.FirstUParameter() - du || point.X() > whole.LastUParameter() + du)) ||
                          (!whole.IsVPeriodic() &&
                           (point.Y() < whole.FirstVParameter() - dv || point.Y() > whole.LastVParameter() + dv));
      }
    }
  }

  /// Each side has two triangles, or one and an edge, or edges alone where two run over each other. Lines that close
  /// the gaps between edges are no longer than the tolerances that the face's vertices state.
  void check_border(const TopoDS_Face& face, const Poly_Triangulation& mesh, const std::map<Side, int>& sides) {
    double gap = 0;
    for (TopExp_Explorer at(face, TopAbs_VERTEX); at.More(); at.Next())
      gap = std::max(gap, 2 * BRep_Tool::Tolerance(TopoDS::Vertex(at.Current())));
    std::size_t odd = 0;
    double longest = 0;
    for (const auto& [side, count] : sides) {
      if (count % 2 == 0) continue;
      const double length = mesh.Node(side.first).Distance(mesh.Node(side.second));
      if (length <= gap + 1e-6 * size_) continue;
      ++odd;
      longest = std::max(longest, length);
    }
    if (odd > 0)
      complain(std::to_string(odd) + " sides have neither two triangles nor a triangle and an edge, of length " +
               std::to_string(longest));
  }

  void check_nodes(const TopoDS_Face& face, const Poly_Triangulation& mesh) {
    const BRepAdaptor_Surface surface(face);
    const gp_Trsf place = face.Location().Transformation();
    const auto [u0, u1, v0, v1] = rectangle_;
    const double du = 1e-5 * (u1 - u0) + surface.UResolution(1e-4), dv = 1e-5 * (v1 - v0) + surface.VResolution(1e-4);
    is_pole_.assign(1, false);
    std::size_t outside = 0, far = 0, turned = 0;
    for (int k = 1; k <= mesh.NbNodes(); ++k) {
      const gp_Pnt2d at = mesh.UVNode(k);
      outside += !(at.X() >= u0 - du && at.X() <= u1 + du && at.Y() >= v0 - dv && at.Y() <= v1 + dv);
      gp_Pnt point;
      gp_Vec along_u, along_v;
      surface.D1(at.X(), at.Y(), point, along_u, along_v);
      const double distance = point.Distance(mesh.Node(k).Transformed(place));
      facts_.worst_node = std::max(facts_.worst_node, distance);
      far += !(distance <= report_.bound + report_.gap + 1e-6);
      const gp_Vec normal = along_u.Crossed(along_v);
      gp_Vec own(mesh.Normal(k));
      own.Transform(place);
      if (place.IsNegative()) own.Reverse();
      const bool is_pole =
          along_u.Magnitude() * (u1 - u0) < 1e-5 * size_ || along_v.Magnitude() * (v1 - v0) < 1e-5 * size_;
      is_pole_.push_back(is_pole);
      turned += !is_pole && normal.Magnitude() > 1e-3 * along_u.Magnitude() * along_v.Magnitude() &&
                !(own.Dot(normal) > 0.5 * normal.Magnitude());
    }
    if (outside > 0) complain(std::to_string(outside) + " nodes have parameters outside of the border's rectangle");
    if (far > 0) complain(std::to_string(far) + " nodes are far from the points of their parameters");
    if (turned > 0) complain(std::to_string(turned) + " normals are not those of the surface");
  }

  bool check_triangles(const Poly_Triangulation& mesh, std::map<Side, int>& sides) {
    const auto scaled = [&, u = rectangle_[1] - rectangle_[0], v = rectangle_[3] - rectangle_[2]](int from, int to) {
      const gp_Vec2d way(mesh.UVNode(from), mesh.UVNode(to));
      return gp_Vec2d(way.X() / u, way.Y() / v);
    };
    std::size_t turned = 0, flat = 0;
    find_places(mesh);
    for (int k = 1; k <= mesh.NbTriangles(); ++k) {
      std::array<int, 3> at{};
      mesh.Triangle(k).Get(at[0], at[1], at[2]);
      for (const int node : at)
        if (node < 1 || node > mesh.NbNodes()) return complain("a triangle has no such node"), false;
      const gp_Vec2d a = scaled(at[0], at[1]), b = scaled(at[0], at[2]);
      const bool has_pole = std::ranges::any_of(at, [&](int node) { return is_pole_[static_cast<std::size_t>(node)]; });
      turned += !has_pole && a.Crossed(b) < -2e-6 * (a.Magnitude() + b.Magnitude());  // above the rounding of floats
      for (int& node : at) node = places_[static_cast<std::size_t>(node)];
      if (at[0] == at[1] || at[1] == at[2] || at[2] == at[0]) ++flat;
      for (std::size_t c = 0; c < 3; ++c) ++sides[std::minmax(at[c], at[(c + 1) % 3])];
    }
    if (flat > 0) complain(std::to_string(flat) + " triangles have a place twice");
    if (turned > 0) complain(std::to_string(turned) + " triangles run clockwise in the parameters");
    return true;
  }

  /// Finds for each node the first one at its place.
  void find_places(const Poly_Triangulation& mesh) {
    std::map<std::array<double, 3>, int> first;
    places_.assign(static_cast<std::size_t>(mesh.NbNodes()) + 1, 0);
    for (int k = 1; k <= mesh.NbNodes(); ++k) {
      const gp_Pnt at = mesh.Node(k);
      places_[static_cast<std::size_t>(k)] = first.try_emplace({at.X(), at.Y(), at.Z()}, k).first->second;
    }
  }

  void check_edge(const TopoDS_Edge& edge, const TopoDS_Face& face, const handle<Poly_Triangulation>& mesh,
                  const TopLoc_Location& place, std::map<Side, int>& sides) {
    if (edge.Orientation() != TopAbs_FORWARD && edge.Orientation() != TopAbs_REVERSED) return;
    const handle<Poly_PolygonOnTriangulation> polygon = BRep_Tool::PolygonOnTriangulation(edge, mesh, place);
    if (polygon.IsNull() && BRep_Tool::Degenerated(edge)) return;
    if (polygon.IsNull()) return complain("an edge has no polygon");
    ++facts_.polygons;
    if (!polygon->HasParameters()) return complain("a polygon has no parameters");
    Line line;
    double from = 0, to = 0;
    BRep_Tool::Range(edge, from, to);
    const TopLoc_Location edge_place = place;
    const gp_Trsf move = place.Transformation();
    for (int k = 1; k <= polygon->NbNodes(); ++k) {
      const int node = polygon->Node(k);
      if (node < 1 || node > mesh->NbNodes()) return complain("a polygon has no such node");
      line.parameters.push_back(polygon->Parameter(k));
      line.points.push_back(mesh->Node(node).Transformed(move));
      if (k == 1) continue;
      const auto at = [&](int point) { return places_[static_cast<std::size_t>(polygon->Node(point))]; };
      if (at(k - 1) != at(k)) ++sides[std::minmax(at(k - 1), at(k))];
    }
    if (!std::ranges::is_sorted(line.parameters, std::less_equal())) complain("parameters of a polygon do not grow");
    const double slack = 1e-6 * (to - from);
    if (std::abs(line.parameters.front() - from) > slack || std::abs(line.parameters.back() - to) > slack)
      complain("a polygon runs from " + std::to_string(line.parameters.front()) + " to " +
               std::to_string(line.parameters.back()) + ", its edge from " + std::to_string(from) + " to " +
               std::to_string(to));
    check_places(edge, face, line);
  }

  void check_places(const TopoDS_Edge& edge, const TopoDS_Face& face, const Line& line) {
    const double tolerance = BRep_Tool::Tolerance(edge);
    double from = 0, to = 0;
    const handle<Geom_Curve> curve = BRep_Tool::Curve(edge, from, to);
    if (!curve.IsNull())
      for (std::size_t k = 0; k < line.points.size(); ++k) {
        const double distance = curve->Value(line.parameters[k]).Distance(line.points[k]);
        facts_.worst_edge = std::max(facts_.worst_edge, distance - tolerance);
      }
    const auto [known, is_new] = lines_.try_emplace({edge.TShape().get(), edge.Location().HashCode(1 << 30)}, line);
    if (is_new || BRep_Tool::Degenerated(edge)) return;
    const Line& other = known->second;
    if (other.parameters != line.parameters) return complain("two faces along an edge have other parameters");
    double apart = 0, size = 0;
    for (std::size_t k = 0; k < line.points.size(); ++k) {
      apart = std::max(apart, line.points[k].Distance(other.points[k]));
      size = std::max(size, line.points[k].XYZ().Modulus());
    }
    if (apart > 1e-12 * size) complain("two faces along an edge have nodes " + std::to_string(apart) + " apart");
    (void)face;
  }

  const TopoDS_Shape& shape_;
  const OcctMeshReport& report_;
  double size_ = 0;
  std::array<double, 4> rectangle_{};  ///< of the face's border: u from, to; v from, to
  bool leaves_surface_ = false;        ///< whether the border leaves the surface, so that a part of it is cut off
  std::vector<int> places_;            ///< by node of the face
  std::vector<bool> is_pole_;          ///< by node: parameters have no say there
  PolyFacts facts_;
  std::map<std::pair<const void*, int>, Line> lines_;
};

}  // namespace

double size_of(const TopoDS_Shape& shape) {
  Bnd_Box box;
  BRepBndLib::Add(shape, box, false);
  return box.IsVoid() ? 0 : std::sqrt(box.SquareExtent());
}

PolyFacts check_polys(const TopoDS_Shape& shape, const OcctMeshReport& report) { return Checker(shape, report).run(); }

StlFacts stl_facts(const TopoDS_Shape& shape) {
  const ScratchFolder folder;
  const std::string path = folder / "mesh.stl";
  StlAPI_Writer writer;
  writer.ASCIIMode() = false;
  if (!writer.Write(shape, path.c_str())) throw std::runtime_error("StlAPI_Writer writes no file");
  std::ifstream file(path, std::ios::binary);
  std::vector<char> bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  StlFacts facts;
  std::uint32_t count = 0;
  if (bytes.size() < 84) throw std::runtime_error("StlAPI_Writer writes a short file");
  std::memcpy(&count, &bytes[80], 4);
  facts.triangles = count;
  if (bytes.size() != 84 + 50 * std::size_t{count}) throw std::runtime_error("StlAPI_Writer writes another size");
  using Place = std::array<float, 3>;
  std::vector<std::pair<Place, Place>> sides;
  for (std::size_t k = 0; k < count; ++k) {
    std::array<Place, 3> corner{};
    std::memcpy(&corner, &bytes[84 + 50 * k + 12], 36);
    for (Place& place : corner)
      for (float& value : place) value += 0.0f;  // -0 is 0
    const auto at = [&](std::size_t c) {
      return gp_XYZ(double(corner[c][0]), double(corner[c][1]), double(corner[c][2]));
    };
    facts.volume += at(0).Dot(at(1).Crossed(at(2))) / 6;
    facts.area += (at(1) - at(0)).Crossed(at(2) - at(0)).Modulus() / 2;
    for (std::size_t c = 0; c < 3; ++c)
      if (corner[c] != corner[(c + 1) % 3]) sides.push_back(std::minmax(corner[c], corner[(c + 1) % 3]));
  }
  std::ranges::sort(sides);
  for (std::size_t k = 0, end = 0; k < sides.size(); k = end) {
    while (end < sides.size() && sides[end] == sides[k]) ++end;
    facts.open_sides += end - k == 1;
  }
  return facts;
}

std::vector<opencascade::handle<Poly_Triangulation>> triangulations_of(const TopoDS_Shape& shape) {
  std::vector<opencascade::handle<Poly_Triangulation>> all;
  TopLoc_Location place;
  for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next())
    all.push_back(BRep_Tool::Triangulation(TopoDS::Face(face.Current()), place));
  return all;
}

}  // namespace tessera::test
