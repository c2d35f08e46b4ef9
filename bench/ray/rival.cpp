#include "rival.h"

#include <tbb/parallel_for.h>
#include <xmmintrin.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <vector>

#include "base/impl_access.h"
#include "eval/uniform_grid.h"
#include "tessera/evaluate.h"

namespace tessera::bench {
namespace {

/// The floating-point mode that Embree recommends for speed.
class FlushDenormals {
 public:
  FlushDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | 0x8040); }
  ~FlushDenormals() { _mm_setcsr(saved_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned saved_;
};

RTCRay to_embree(const Ray& ray) {
  RTCRay out{};
  const auto narrow = [](double x) { return static_cast<float>(x); };
  out.org_x = narrow(ray.origin.x), out.org_y = narrow(ray.origin.y), out.org_z = narrow(ray.origin.z);
  out.dir_x = narrow(ray.direction.x), out.dir_y = narrow(ray.direction.y), out.dir_z = narrow(ray.direction.z);
  out.tnear = narrow(ray.tnear), out.tfar = narrow(ray.tfar);
  out.mask = ~0u;
  return out;
}

template <class Each>
void for_rays(std::size_t count, Each each) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 512), [&](const auto& range) {
    const FlushDenormals flush;
    for (std::size_t k = range.begin(); k < range.end(); ++k) each(k);
  });
}

}  // namespace

struct Rival::State {
  std::atomic<std::ptrdiff_t> bytes{0};
  RTCDevice device = nullptr;
  RTCGeometry geometry = nullptr;
  RTCScene scene = nullptr;
  std::vector<float> positions;
  std::vector<unsigned> indices, faces;

  ~State() {
    if (geometry) rtcReleaseGeometry(geometry);
    if (scene) rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }
};

void Rival::Release::operator()(State* state) const { delete state; }

Rival::Rival(Isa isa) : state_(new State) {
  state_->device = rtcNewDevice(("start_threads=0,set_affinity=0,isa=" + std::string(name(isa))).c_str());
  rtcSetDeviceMemoryMonitorFunction(
      state_->device,
      [](void* state, ssize_t bytes, bool) {
        static_cast<State*>(state)->bytes += bytes;
        return true;
      },
      state_.get());
}

/// Makes a geometry of the points of quads x quads cells per patch.
void Rival::evaluate(const PatchSet& set, int quads, Isa isa, RTCGeometryType type) {
  const UniformGrid grid = test::value_of(UniformGrid::make(set, quads, quads, isa));
  state_->positions.resize(3 * grid.capacity() + 1);
  const auto views = View3<float>::interleaved(std::span(state_->positions).first(3 * grid.capacity()));
  if (!grid.run(impl_of(set), QuantityViews<float>{.position = views, .du = {}, .dv = {}, .normal = {}}, {}).ok())
    std::abort();
  state_->geometry = rtcNewGeometry(state_->device, type);
  rtcSetSharedGeometryBuffer(state_->geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, state_->positions.data(),
                             0, 3 * sizeof(float), grid.capacity());
}

Rival Rival::triangles(const PatchSet& set, int quads, Isa isa) {
  Rival rival(isa);
  State& state = *rival.state_;
  const auto side = static_cast<unsigned>(quads) + 1, per_patch = side * side;
  for (unsigned patch = 0; patch < set.patch_count(); ++patch) {
    for (unsigned i = 0; i + 1 < side; ++i) {
      for (unsigned j = 0; j + 1 < side; ++j) {
        const unsigned a = patch * per_patch + i * side + j;
        for (const unsigned k : {a, a + 1, a + side, a + 1, a + side + 1, a + side}) state.indices.push_back(k);
      }
    }
  }
  rival.evaluate(set, quads, isa, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(state.geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, state.indices.data(), 0,
                             3 * sizeof(unsigned), state.indices.size() / 3);
  rival.build();
  return rival;
}

Rival Rival::grids(const PatchSet& set, int quads, Isa isa) {
  Rival rival(isa);
  rival.evaluate(set, quads, isa, RTC_GEOMETRY_TYPE_GRID);
  auto* out = static_cast<RTCGrid*>(rtcSetNewGeometryBuffer(rival.state_->geometry, RTC_BUFFER_TYPE_GRID, 0,
                                                            RTC_FORMAT_GRID, sizeof(RTCGrid), set.patch_count()));
  const auto side = static_cast<unsigned>(quads) + 1;
  for (unsigned patch = 0; patch < set.patch_count(); ++patch)
    out[patch] = {patch * side * side, side, static_cast<unsigned short>(side), static_cast<unsigned short>(side)};
  rival.build();
  return rival;
}

Rival Rival::subdivision(const test::Torus& torus, int rate, Isa isa) {
  Rival rival(isa);
  State& state = *rival.state_;
  const auto side = static_cast<unsigned>(torus.side());
  for (const Vec3& p : torus.points()) {
    for (const double x : {p.x, p.y, p.z}) state.positions.push_back(static_cast<float>(x));
  }
  state.positions.push_back(0);  // the last vertex is read as 16 bytes
  for (unsigned i = 0; i < side; ++i) {
    for (unsigned j = 0; j < side; ++j) {
      const unsigned next_i = (i + 1) % side, next_j = (j + 1) % side;
      for (const unsigned k : {i * side + j, i * side + next_j, next_i * side + next_j, next_i * side + j})
        state.indices.push_back(k);
      state.faces.push_back(4);
    }
  }
  state.geometry = rtcNewGeometry(state.device, RTC_GEOMETRY_TYPE_SUBDIVISION);
  rtcSetSharedGeometryBuffer(state.geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, state.positions.data(), 0,
                             3 * sizeof(float), torus.points().size());
  rtcSetSharedGeometryBuffer(state.geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, state.indices.data(), 0,
                             sizeof(unsigned), state.indices.size());
  rtcSetSharedGeometryBuffer(state.geometry, RTC_BUFFER_TYPE_FACE, 0, RTC_FORMAT_UINT, state.faces.data(), 0,
                             sizeof(unsigned), state.faces.size());
  rtcSetGeometryTessellationRate(state.geometry, static_cast<float>(rate));
  rival.build();
  return rival;
}

void Rival::build() {
  if (state_->scene) rtcReleaseScene(state_->scene);
  state_->scene = rtcNewScene(state_->device);
  rtcCommitGeometry(state_->geometry);
  rtcAttachGeometry(state_->scene, state_->geometry);
  rtcSetSceneFlags(state_->scene, RTC_SCENE_FLAG_ROBUST);
  rtcCommitScene(state_->scene);
}

std::size_t Rival::memory_bytes() const {
  return static_cast<std::size_t>(state_->bytes.load()) + state_->positions.size() * sizeof(float) +
         (state_->indices.size() + state_->faces.size()) * sizeof(unsigned);
}

void Rival::closest(std::span<const Ray> rays, std::span<float> t) const {
  for_rays(rays.size(), [&](std::size_t k) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{};
    query.ray = to_embree(rays[k]);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(state_->scene, &context, &query);
    t[k] = query.hit.geomID == RTC_INVALID_GEOMETRY_ID ? std::numeric_limits<float>::infinity() : query.ray.tfar;
  });
}

void Rival::closest_packets(std::span<const Ray> rays, std::span<float> t) const {
  constexpr std::size_t packet = 16;
  for_rays(rays.size() / packet, [&](std::size_t first) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    RTCRayHit16 query;
    alignas(64) int valid[packet];
    for (std::size_t k = 0; k < packet; ++k) {
      const RTCRay ray = to_embree(rays[packet * first + k]);
      query.ray.org_x[k] = ray.org_x, query.ray.org_y[k] = ray.org_y, query.ray.org_z[k] = ray.org_z;
      query.ray.dir_x[k] = ray.dir_x, query.ray.dir_y[k] = ray.dir_y, query.ray.dir_z[k] = ray.dir_z;
      query.ray.tnear[k] = ray.tnear, query.ray.tfar[k] = ray.tfar, query.ray.mask[k] = ray.mask;
      query.ray.time[k] = 0, query.ray.id[k] = 0, query.ray.flags[k] = 0;
      query.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID, query.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
      valid[k] = -1;
    }
    rtcIntersect16(valid, state_->scene, &context, &query);
    for (std::size_t k = 0; k < packet; ++k) {
      t[packet * first + k] =
          query.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID ? std::numeric_limits<float>::infinity() : query.ray.tfar[k];
    }
  });
}

void Rival::occluded(std::span<const Ray> rays, std::span<std::uint8_t> occluded) const {
  for_rays(rays.size(), [&](std::size_t k) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay query = to_embree(rays[k]);
    rtcOccluded1(state_->scene, &context, &query);
    occluded[k] = query.tfar < 0;
  });
}

}  // namespace tessera::bench
