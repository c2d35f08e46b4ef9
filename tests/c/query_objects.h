#pragma once
// Handles, memory and surfaces for the tests of queries through C.

#include <array>
#include <cmath>
#include <cstring>

#include "c/c_objects.h"
#include "support/errors.h"
#include "tessera/nearest_points.h"
#include "tessera/sections.h"
#include "tessera/tessera_c_queries.h"

namespace tessera::test {

/// The six faces of the cube [0,2]^3, with normals in various directions; the fifth lies in z = 0.
inline std::vector<BezierPatch> cube() {
  std::vector<BezierPatch> patches;
  for (int face = 0; face < 6; ++face) {
    std::vector<Vec3> points;
    for (int corner = 0; corner < 4; ++corner) {
      std::array<double, 3> at{};
      at[face / 2] = 2 * (face % 2);
      at[(face / 2 + 1) % 3] = 2 * (corner / 2), at[(face / 2 + 2) % 3] = 2 * (corner % 2);
      points.push_back({at[0], at[1], at[2]});
    }
    patches.push_back(value_of(BezierPatch::polynomial(1, 1, points)));
  }
  return patches;
}

inline Handle<tsr_point_scene> point_scene_of(const tsr_set* set) {
  tsr_point_scene* scene = nullptr;
  EXPECT_C(tsr_point_scene_new(&scene, set, nullptr));
  return Handle<tsr_point_scene>(scene);
}
inline Handle<tsr_solid> solid_of(const tsr_scene* scene) {
  tsr_solid* solid = nullptr;
  EXPECT_C(tsr_solid_new(&solid, scene, nullptr));
  return Handle<tsr_solid>(solid);
}
inline Handle<tsr_measures> measures_of(const tsr_model* model) {
  tsr_measures* measures = nullptr;
  EXPECT_C(tsr_measures_new(&measures, model, nullptr, nullptr));
  return Handle<tsr_measures>(measures);
}
inline Handle<tsr_sections> sections_of(const tsr_set* set, const double* normal, const std::vector<double>& offsets,
                                        double tolerance) {
  tsr_section_options options;
  tsr_section_defaults(&options);
  options.tolerance = tolerance;
  tsr_sections* sections = nullptr;
  EXPECT_C(tsr_sections_new(&sections, set, normal, offsets.data(), offsets.size(), &options, nullptr));
  return Handle<tsr_sections>(sections);
}

template <class T>
struct PointMemory {
  explicit PointMemory(const std::vector<Vec3>& points) {
    for (const Vec3& point : points)
      position.insert(position.end(), {static_cast<T>(point.x), static_cast<T>(point.y), static_cast<T>(point.z)});
  }
  tsr_query_points points() const {
    tsr_query_points made = sized<tsr_query_points>();
    made.is_double = sizeof(T) == 8;
    made.position = in_of(position, 3);
    return made;
  }
  std::vector<T> position;
};

template <class T>
struct NearestMemory {
  explicit NearestMemory(std::size_t count)
      : kind(count, 77),
        flags(count, 77),
        surface(count),
        patch(count),
        distance(count),
        uv(2 * count),
        patch_uv(2 * count),
        position(3 * count),
        normal(3 * count) {}
  tsr_nearest_out out() {
    tsr_nearest_out made = sized<tsr_nearest_out>();
    made.is_double = sizeof(T) == 8;
    made.kind = out_of(kind, 1), made.flags = out_of(flags, 1);
    made.surface = out_of(surface, 1), made.patch = out_of(patch, 1);
    made.distance = out_of(distance, 1), made.uv = out_of(uv, 2), made.patch_uv = out_of(patch_uv, 2);
    made.position = out_of(position, 3), made.normal = out_of(normal, 3);
    return made;
  }
  std::vector<std::uint8_t> kind, flags;
  std::vector<std::uint32_t> surface, patch;
  std::vector<T> distance, uv, patch_uv, position, normal;
};

}  // namespace tessera::test
