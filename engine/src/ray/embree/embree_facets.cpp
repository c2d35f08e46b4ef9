// Grids, triangles and quads as geometries of Embree.

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "ray/embree/embree_device.h"
#include "ray/embree/embree_trees.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

RTCRay to_embree(const FacetRay& ray) {
  RTCRay out{};
  out.org_x = ray.origin[0], out.org_y = ray.origin[1], out.org_z = ray.origin[2];
  out.dir_x = ray.direction[0], out.dir_y = ray.direction[1], out.dir_z = ray.direction[2];
  out.tnear = ray.tnear, out.tfar = ray.tfar;
  out.mask = ~0u;
  return out;
}

constexpr unsigned quad_geometry = 1;  // triangles and grids: 0

using Lanes = std::array<int, FacetTree::packet>;  // -1: active, 0: not

/// Fills the lanes of a packet and returns which are active. Idle lanes repeat the first ray.
Lanes to_embree(std::span<const FacetRay> rays, RTCRay16& out) {
  Lanes valid{};
  for (std::size_t k = 0; k < FacetTree::packet; ++k) {
    const FacetRay& ray = rays[k < rays.size() ? k : 0];
    valid[k] = k < rays.size() ? -1 : 0;
    out.org_x[k] = ray.origin[0], out.org_y[k] = ray.origin[1], out.org_z[k] = ray.origin[2];
    out.dir_x[k] = ray.direction[0], out.dir_y[k] = ray.direction[1], out.dir_z[k] = ray.direction[2];
    out.tnear[k] = ray.tnear, out.tfar[k] = ray.tfar;
    out.time[k] = 0, out.mask[k] = ~0u, out.id[k] = 0, out.flags[k] = 0;
  }
  return valid;
}

struct FacetState {
  EmbreeMonitor monitor;        // outlives the device, which calls it
  std::vector<RTCGrid> grids;   // borrowed by the geometry
  std::uint32_t triangles = 0;  // come before quads
  Owned<RTCDevice, DeviceRelease> device;
  Owned<RTCScene, SceneRelease> scene;

  std::uint32_t facet(unsigned geometry, unsigned primitive) const {
    return geometry == quad_geometry ? triangles + primitive : primitive;
  }
};

/// Owns device, scene and geometry.
class EmbreeFacets final : public FacetTree {
 public:
  Status start();
  Status build(const GridVertices& vertices, const Execution& execution) override;
  Status build(const FacetVertices& facets, const Execution& execution) override;
  FacetHit closest(const FacetRay& ray) const override;
  bool occluded(const FacetRay& ray) const override;
  void closest(std::span<const FacetRay> rays, std::span<FacetHit> hits) const override;
  void occluded(std::span<const FacetRay> rays, std::span<std::uint8_t> occluded) const override;
  Box3 box() const override;
  /// Returns the bytes that Embree has allocated, and those of the grids.
  std::size_t memory_bytes() const override {
    return state_.monitor.bytes() + state_.grids.capacity() * sizeof(RTCGrid);
  }

 private:
  FacetState state_;
};

Status EmbreeFacets::start() { return make_device(state_.monitor, state_.device); }

Status EmbreeFacets::build(const GridVertices& vertices, const Execution& execution) {
  FacetState& state = state_;
  state.scene.reset();
  if (Status status = check_size(vertices); !status.ok()) return status;
  const std::size_t per_grid = static_cast<std::size_t>(vertices.height) * static_cast<std::size_t>(vertices.width);
  state.grids.resize(vertices.grids);
  for (std::size_t k = 0; k < vertices.grids; ++k) {
    state.grids[k] = {static_cast<unsigned>(k * per_grid), static_cast<unsigned>(vertices.width),
                      static_cast<unsigned short>(vertices.width), static_cast<unsigned short>(vertices.height)};
  }

  RTCDevice device = state.device.get();
  const Owned<RTCGeometry, GeometryRelease> geometry(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_GRID));
  Owned<RTCScene, SceneRelease> scene(rtcNewScene(device));
  if (!geometry || !scene) return state.monitor.take();
  rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_GRID, 0, RTC_FORMAT_GRID, state.grids.data(), 0,
                             sizeof(RTCGrid), state.grids.size());
  rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, vertices.data, 0,
                             3 * sizeof(float), vertices.grids * per_grid);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometry(scene.get(), geometry.get());
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
  if (Status status = commit(scene.get(), state.monitor, execution); !status.ok()) return status;
  state.scene = std::move(scene);
  return {};
}

Status EmbreeFacets::build(const FacetVertices& facets, const Execution& execution) {
  FacetState& state = state_;
  state.scene.reset();
  constexpr std::size_t most = FacetHit::nothing;
  const std::size_t triangles = facets.triangles.size() / 3, quads = facets.quads.size() / 4;
  if (facets.vertices > most || triangles + quads >= most)
    return Status(StatusCode::unsupported, "more than the 2^32 vertices or faces of one ray scene");
  state.grids = {};
  state.triangles = static_cast<std::uint32_t>(triangles);
  RTCDevice device = state.device.get();
  Owned<RTCScene, SceneRelease> scene(rtcNewScene(device));
  if (!scene) return state.monitor.take();
  const auto attach = [&](RTCGeometryType type, RTCFormat format, std::span<const std::uint32_t> indices,
                          std::size_t corners, unsigned id) {
    const Owned<RTCGeometry, GeometryRelease> geometry(rtcNewGeometry(device, type));
    if (!geometry) return;
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_INDEX, 0, format, indices.data(), 0,
                               corners * sizeof(std::uint32_t), indices.size() / corners);
    rtcSetSharedGeometryBuffer(geometry.get(), RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, facets.data, 0,
                               3 * sizeof(float), facets.vertices);
    rtcCommitGeometry(geometry.get());
    rtcAttachGeometryByID(scene.get(), geometry.get(), id);
  };
  if (triangles > 0) attach(RTC_GEOMETRY_TYPE_TRIANGLE, RTC_FORMAT_UINT3, facets.triangles, 3, 0);
  if (quads > 0) attach(RTC_GEOMETRY_TYPE_QUAD, RTC_FORMAT_UINT4, facets.quads, 4, quad_geometry);
  rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
  if (Status status = commit(scene.get(), state.monitor, execution); !status.ok()) return status;
  state.scene = std::move(scene);
  return {};
}

FacetHit EmbreeFacets::closest(const FacetRay& ray) const {
  EmbreeContext context = embree_context();
  RTCRayHit query{};
  query.ray = to_embree(ray);
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  intersect(state_.scene.get(), context, Coherence::incoherent, query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
  return {state_.facet(query.hit.geomID, query.hit.primID), query.ray.tfar, query.hit.v,
          query.hit.u};  // Embree's u runs along the width
}

bool EmbreeFacets::occluded(const FacetRay& ray) const {
  EmbreeContext context = embree_context();
  RTCRay query = to_embree(ray);
  tessera::occluded(state_.scene.get(), context, Coherence::incoherent, query);
  return query.tfar < 0;  // -infinity where something was hit
}

void EmbreeFacets::closest(std::span<const FacetRay> rays, std::span<FacetHit> hits) const {
  EmbreeContext context = embree_context();
  RTCRayHit16 query;
  alignas(64) const Lanes valid = to_embree(rays, query.ray);
  std::fill(std::begin(query.hit.geomID), std::end(query.hit.geomID), RTC_INVALID_GEOMETRY_ID);
  std::fill(std::begin(query.hit.instID[0]), std::end(query.hit.instID[0]), RTC_INVALID_GEOMETRY_ID);
  intersect(state_.scene.get(), context, Coherence::coherent, valid.data(), query);
  for (std::size_t k = 0; k < rays.size(); ++k) {
    hits[k] = {};
    if (query.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID) continue;
    hits[k] = {state_.facet(query.hit.geomID[k], query.hit.primID[k]), query.ray.tfar[k], query.hit.v[k],
               query.hit.u[k]};
  }
}

void EmbreeFacets::occluded(std::span<const FacetRay> rays, std::span<std::uint8_t> occluded) const {
  EmbreeContext context = embree_context();
  RTCRay16 query;
  alignas(64) const Lanes valid = to_embree(rays, query);
  tessera::occluded(state_.scene.get(), context, Coherence::coherent, valid.data(), query);
  for (std::size_t k = 0; k < rays.size(); ++k) occluded[k] = query.tfar[k] < 0;
}

Box3 EmbreeFacets::box() const {
  if (!state_.scene) return {};
  RTCBounds bounds;
  rtcGetSceneBounds(state_.scene.get(), &bounds);
  return {{bounds.lower_x, bounds.lower_y, bounds.lower_z}, {bounds.upper_x, bounds.upper_y, bounds.upper_z}};
}

}  // namespace

Result<std::unique_ptr<FacetTree>> make_embree_facets(Isa) {
  auto tree = std::make_unique<EmbreeFacets>();
  if (Status status = tree->start(); !status.ok()) return status;
  return std::unique_ptr<FacetTree>(std::move(tree));
}

}}  // namespace tessera::abi_0_1
