#include "occt/stored_meshes.h"

#include <opencascade/BRep_ListOfCurveRepresentation.hxx>
#include <opencascade/BRep_TEdge.hxx>
#include <opencascade/BRep_TFace.hxx>

#include <algorithm>
#include <string>
#include <vector>

#include "occt/kind_of.h"
#include "occt/shape_numbers.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

using opencascade::handle;

class Storing {
 public:
  Storing(const OcctShape& sources, std::span<const handle<Poly_Triangulation>> made)
      : faces_(sources.faces), edges_(sources.edges), made_(made) {}

  Status prepare_faces() {
    faces_of_.reserve(faces_.size());
    for (std::size_t k = 0; k < faces_.size(); ++k) {
      auto* const own = kind_of<BRep_TFace>(faces_[k].face.TShape());
      if (!own) return Status(StatusCode::internal, "a face is no BRep face");
      if (own->Locked())
        return Status(StatusCode::invalid_argument, "face " + std::to_string(k) + " is locked: unlock it first",
                      static_cast<std::int64_t>(k));
      faces_of_.push_back({own, made_[k], {}, own->ActiveTriangulation()});
      // The list of a face that has at most one triangulation, its active one, follows from that.
      const int before = own->NbTriangulations();
      if (before > (faces_of_.back().active.IsNull() ? 0 : 1)) faces_of_.back().before = own->Triangulations();
      if (before > 0)
        for (const handle<Poly_Triangulation>& one : own->Triangulations()) replaced_.push_back(one.get());
    }
    std::ranges::sort(replaced_);
    return {};
  }

  /// Finds the edges whose polygons on older triangulations go, and makes the new ones.
  Status prepare_edges(std::span<const EdgePolygon> polygons) {
    shapes_.reserve(edges_.size()), number_of_.reserve(edges_.size()), edges_of_.reserve(edges_.size());
    for (const OcctEdge& edge : edges_) {
      number_of_.push_back(shapes_.add(edge.edge));
      if (shapes_.size() == edges_of_.size()) continue;
      auto* const own = kind_of<BRep_TEdge>(edge.edge.TShape());
      if (!own) return Status(StatusCode::internal, "an edge is no BRep edge");
      edges_of_.push_back({own, has_replaced(*own)});
    }
    for (const EdgePolygon& polygon : polygons) edges_of_[number_of_[polygon.edge]].changes = true;
    for (const OfEdge& edge : edges_of_)
      if (edge.changes && edge.own->Locked())
        return Status(StatusCode::invalid_argument, "an edge is locked: unlock it first");
    for (const EdgePolygon& polygon : polygons)
      edges_of_[number_of_[polygon.edge]].added.Append(polygon.representation);
    return {};
  }

  void commit() {
    std::size_t done = 0;
    try {
      for (; done < faces_of_.size(); ++done) put(faces_of_[done]);
    } catch (...) {
      for (std::size_t k = 0; k <= done && k < faces_of_.size(); ++k) put_back(faces_of_[k]);
      throw;
    }
    for (const OfFace& face : faces_of_) face.own->Modified(true);
    for (OfEdge& edge : edges_of_) {  // removes and moves nodes of lists, which does not fail
      if (!edge.changes) continue;
      drop_replaced(edge.own->ChangeCurves());
      edge.own->ChangeCurves().Append(edge.added);
      edge.own->Modified(true);
    }
  }

 private:
  struct OfFace {
    BRep_TFace* own;
    handle<Poly_Triangulation> next;
    Poly_ListOfTriangulation before;
    handle<Poly_Triangulation> active;
  };
  struct OfEdge {
    BRep_TEdge* own;
    bool changes;
    BRep_ListOfCurveRepresentation added = {};
  };

  /// Takes the place of an active triangulation that is the only one, without memory.
  static void put(const OfFace& face) {
    const bool is_only = face.before.IsEmpty() && !face.active.IsNull() && !face.next.IsNull();
    face.own->Triangulation(face.next, !is_only);
  }
  static void put_back(const OfFace& face) {
    if (face.before.IsEmpty())
      face.own->Triangulation(face.active, face.active.IsNull());
    else
      face.own->Triangulations(face.before, face.active);
  }

  bool is_replaced(const handle<BRep_CurveRepresentation>& curve) const {
    return curve->IsPolygonOnTriangulation() &&
           std::ranges::binary_search(replaced_, static_cast<const void*>(curve->Triangulation().get()));
  }
  bool has_replaced(const BRep_TEdge& edge) const {
    return !replaced_.empty() && std::any_of(edge.Curves().begin(), edge.Curves().end(),
                                             [&](const auto& curve) { return is_replaced(curve); });
  }
  void drop_replaced(BRep_ListOfCurveRepresentation& curves) const {
    for (BRep_ListOfCurveRepresentation::Iterator at(curves); at.More();)
      if (is_replaced(at.Value()))
        curves.Remove(at);
      else
        at.Next();
  }

  std::span<const OcctFace> faces_;
  std::span<const OcctEdge> edges_;
  std::span<const handle<Poly_Triangulation>> made_;
  std::vector<OfFace> faces_of_;
  std::vector<const void*> replaced_;  ///< triangulations, in order
  ShapeNumbers shapes_{ShapeNumbers::Places::count_as_one};
  std::vector<std::uint32_t> number_of_;  ///< of each edge, its shape
  std::vector<OfEdge> edges_of_;          ///< by shape
};

}  // namespace

Status store(const OcctShape& sources, std::span<const handle<Poly_Triangulation>> made,
             std::span<const EdgePolygon> polygons) {
  Storing storing(sources, made);
  if (Status status = storing.prepare_faces(); !status.ok()) return status;
  if (Status status = storing.prepare_edges(polygons); !status.ok()) return status;
  storing.commit();
  return {};
}

}}  // namespace tessera::abi_0_1
