// From a model to the faces and edges that it is made of.

#include <opencascade/TopoDS.hxx>

#include <algorithm>
#include <iterator>
#include <utility>

#include "exact/arcs.h"
#include "occt/part_tree.h"
#include "tessera/occt.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The instance that has a surface; null if there is none.
const Instance* instance_of(const Model& model, std::size_t surface) {
  if (surface >= model.surfaces.size()) return nullptr;
  const auto after =
      std::upper_bound(model.instances.begin(), model.instances.end(), surface,
                       [](std::size_t value, const Instance& instance) { return value < instance.first_surface; });
  return after == model.instances.begin() ? nullptr : &*std::prev(after);
}

/// A surface's place in the maps.
struct PlacedFace {
  const OcctFace* face = nullptr;  ///< null: there is no such surface
  std::size_t instance = 0;
};

PlacedFace placed_face(const OcctModel& all, std::size_t surface) {
  const Instance* const instance = instance_of(all.model, surface);
  if (!instance || instance->shape >= all.shapes.size()) return {};
  const std::vector<OcctFace>& faces = all.shapes[instance->shape].faces;
  const std::size_t face = surface - instance->first_surface;
  const auto k = static_cast<std::size_t>(instance - all.model.instances.data());
  if (face >= faces.size() || k >= all.locations.size()) return {};
  return {&faces[face], k};
}

TopoDS_Face face_in_place(const OcctModel& all, const PlacedFace& placed) {
  return TopoDS::Face(moved(placed.face->face, all.locations[placed.instance]));
}

}  // namespace

double OcctParameter::to_occt(double parameter) const {
  return arcs ? Arcs(arcs->from, arcs->to).angle(parameter) : parameter;
}

double OcctParameter::from_occt(double parameter) const {
  return arcs ? Arcs(arcs->from, arcs->to).parameter(parameter) : parameter;
}

std::array<double, 2> OcctFace::to_occt(double u, double v) const {
  if (is_turned) std::swap(u, v);
  return {along_u.to_occt(u), along_v.to_occt(v)};
}

std::array<double, 2> OcctFace::from_occt(double u, double v) const {
  const double ours_u = along_u.from_occt(u), ours_v = along_v.from_occt(v);
  return is_turned ? std::array{ours_v, ours_u} : std::array{ours_u, ours_v};
}

TopoDS_Face OcctModel::face(std::size_t surface) const {
  const PlacedFace placed = placed_face(*this, surface);
  return placed.face ? face_in_place(*this, placed) : TopoDS_Face();
}

TopoDS_Edge OcctModel::edge(std::size_t instance, std::size_t edge) const {
  if (instance >= std::min(model.instances.size(), locations.size())) return {};
  const std::uint32_t shape = model.instances[instance].shape;
  if (shape >= shapes.size() || edge >= shapes[shape].edges.size()) return {};
  return TopoDS::Edge(moved(shapes[shape].edges[edge].edge, locations[instance]));
}

OcctPoint OcctModel::at(std::size_t surface, double u, double v) const {
  const PlacedFace placed = placed_face(*this, surface);
  if (!placed.face) return {};
  const std::array<double, 2> theirs = placed.face->to_occt(u, v);
  return {face_in_place(*this, placed), theirs[0], theirs[1]};
}

}}  // namespace tessera::abi_0_1
