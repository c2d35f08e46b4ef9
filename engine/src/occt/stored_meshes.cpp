#include "occt/stored_meshes.h"

#include <opencascade/BRep_ListOfCurveRepresentation.hxx>
#include <opencascade/BRep_PolygonOnClosedTriangulation.hxx>
#include <opencascade/BRep_PolygonOnTriangulation.hxx>
#include <opencascade/BRep_TEdge.hxx>
#include <opencascade/BRep_TFace.hxx>
#include <opencascade/TopExp_Explorer.hxx>

#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "occt/relative_place.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

using opencascade::handle;

class Storing {
 public:
  Storing(const OcctShape& sources, std::span<const handle<Poly_Triangulation>> made)
      : faces_(sources.faces), edges_(sources.edges), made_(made) {}

  /// Takes the edges whose polygons on older triangulations go.
  Status prepare_faces() {
    for (std::size_t k = 0; k < faces_.size(); ++k) {
      const TopoDS_Face& face = faces_[k].face;
      const handle<BRep_TFace> own = handle<BRep_TFace>::DownCast(face.TShape());
      if (own.IsNull()) return Status(StatusCode::internal, "a face is no BRep face");
      if (own->Locked())
        return Status(StatusCode::invalid_argument, "face " + std::to_string(k) + " is locked: unlock it first",
                      static_cast<std::int64_t>(k));
      faces_of_.push_back({own, made_[k], own->Triangulations(), own->ActiveTriangulation()});
      for (const handle<Poly_Triangulation>& one : own->Triangulations()) replaced_.insert(one.get());
      if (own->Triangulations().IsEmpty()) continue;
      for (TopExp_Explorer edge(face, TopAbs_EDGE); edge.More(); edge.Next())
        if (Status status = take(edge.Current()); !status.ok()) return status;
    }
    return {};
  }

  Status prepare(std::span<const EdgePolygon> polygons) {
    for (const EdgePolygon& polygon : polygons)
      if (Status status = take(edges_[polygon.edge].edge); !status.ok()) return status;
    for (auto& [key, edge] : curves_of_)
      for (const handle<BRep_CurveRepresentation>& curve : edge.own->Curves())
        if (!curve->IsPolygonOnTriangulation() || !replaced_.contains(curve->Triangulation().get()))
          edge.next.Append(curve);
    for (const EdgePolygon& polygon : polygons) add(polygon);
    return {};
  }

  void commit() {
    std::size_t done = 0;
    try {
      for (; done < faces_of_.size(); ++done) put(faces_of_[done]);
    } catch (...) {
      for (std::size_t k = 0; k <= done && k < faces_of_.size(); ++k)
        faces_of_[k].own->Triangulations(faces_of_[k].before, faces_of_[k].active);
      throw;
    }
    for (const OfFace& face : faces_of_) face.own->Modified(true);
    for (auto& [key, edge] : curves_of_) {  // moves nodes of lists, which does not fail
      edge.own->ChangeCurves().Clear();
      edge.own->ChangeCurves().Append(edge.next);
      edge.own->Modified(true);
    }
  }

 private:
  struct OfFace {
    handle<BRep_TFace> own;
    handle<Poly_Triangulation> next;
    Poly_ListOfTriangulation before;
    handle<Poly_Triangulation> active;
  };
  struct OfEdge {
    handle<BRep_TEdge> own;
    BRep_ListOfCurveRepresentation next = {};
  };

  static void put(const OfFace& face) { face.own->Triangulation(face.next, true); }

  Status take(const TopoDS_Shape& edge) {
    const handle<BRep_TEdge> own = handle<BRep_TEdge>::DownCast(edge.TShape());
    if (own.IsNull()) return Status(StatusCode::internal, "an edge is no BRep edge");
    if (own->Locked()) return Status(StatusCode::invalid_argument, "an edge is locked: unlock it first");
    curves_of_.try_emplace(own.get(), OfEdge{own});
    return {};
  }

  void add(const EdgePolygon& polygon) {
    const TopoDS_Edge& edge = edges_[polygon.edge].edge;
    const TopLoc_Location place = relative_place(faces_[polygon.face].face.Location(), edge.Location());
    const handle<Poly_Triangulation>& on = made_[polygon.face];
    handle<BRep_CurveRepresentation> curve;
    if (polygon.second.IsNull())
      curve = new BRep_PolygonOnTriangulation(polygon.first, on, place);
    else
      curve = new BRep_PolygonOnClosedTriangulation(polygon.first, polygon.second, on, place);
    curves_of_.at(edge.TShape().get()).next.Append(curve);
  }

  std::span<const OcctFace> faces_;
  std::span<const OcctEdge> edges_;
  std::span<const handle<Poly_Triangulation>> made_;
  std::vector<OfFace> faces_of_;
  std::unordered_set<const void*> replaced_;
  std::unordered_map<const void*, OfEdge> curves_of_;
};

}  // namespace

Status store(const OcctShape& sources, std::span<const handle<Poly_Triangulation>> made,
             std::span<const EdgePolygon> polygons) {
  Storing storing(sources, made);
  if (Status status = storing.prepare_faces(); !status.ok()) return status;
  if (Status status = storing.prepare(polygons); !status.ok()) return status;
  storing.commit();
  return {};
}

}}  // namespace tessera::abi_0_1
