#pragma once
// Assemblies of meshes that no mesh and no file can hold, and some that are odd.

#include <functional>
#include <string>

#include "robustness/bad_input.h"
#include "tessera/mesh_assembly.h"

namespace tessera::test {

/// A triangle that stands in two places.
inline MeshAssembly sound_assembly() {
  Mesh mesh;
  mesh.positions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  mesh.normals = {0, 0, 1, 0, 0, 1, 0, 0, 1};
  mesh.indices = {0, 1, 2};
  return {.name = "assembly",
          .shapes = {{"triangle", mesh}},
          .instances = {{.name = "left"}, {.name = "right", .placement = Affine::translated({2, 0, 0})}}};
}

/// Calls use(input, code, assembly) for each assembly that must be refused.
inline void bad_assemblies(const std::function<void(const std::string&, StatusCode, const MeshAssembly&)>& use) {
  using enum StatusCode;
  const auto row = [&](const std::string& input, StatusCode code, const std::function<void(MeshAssembly&)>& change) {
    MeshAssembly assembly = sound_assembly();
    change(assembly);
    use(input, code, assembly);
  };
  row("an instance of shape 1 of 1", invalid_argument, [](MeshAssembly& a) { a.instances[1].shape = 1; });
  row("no shapes", invalid_argument, [](MeshAssembly& a) { a.shapes.clear(); });
  row("a placement at NaN", non_finite, [](MeshAssembly& a) { a.instances[1].placement.translation.y = not_a_number; });
  row("a placement that scales by infinity", non_finite,
      [](MeshAssembly& a) { a.instances[1].placement.columns[2].z = infinity; });
  row("a placement that scales by 1e300", non_finite, [](MeshAssembly& a) {
    a.instances[1].placement = Affine::scaled({1e300, 1e300, 1e300});
  });
  row("a placement at 1e300", non_finite, [](MeshAssembly& a) {
    a.instances[1].placement = Affine::translated({1e300, 0, 0});
  });
  row("a vertex index that is out of range", invalid_argument,
      [](MeshAssembly& a) { a.shapes[0].mesh.indices[1] = 3; });
  row("eight position numbers", count_mismatch, [](MeshAssembly& a) { a.shapes[0].mesh.positions.pop_back(); });
  row("NaN in a position", non_finite,
      [](MeshAssembly& a) { a.shapes[0].mesh.positions[4] = static_cast<float>(not_a_number); });
  row("a part that is out of range", invalid_argument, [](MeshAssembly& a) { a.shapes[0].mesh.parts = {{"a", 0, 9}}; });
}

/// Calls use(input, assembly) for each assembly that is odd, and has a mesh.
inline void odd_placements(const std::function<void(const std::string&, const MeshAssembly&)>& use) {
  const auto row = [&](const std::string& input, const Affine& placement) {
    MeshAssembly assembly = sound_assembly();
    assembly.instances[1].placement = placement;
    use(input, assembly);
  };
  row("a placement that maps all to a point", Affine::scaled({0, 0, 0}));
  row("a placement that maps all to a plane", Affine::scaled({1, 0, 1}));
  row("a placement that scales by 1e-300", Affine::scaled({1e-300, 1e-300, 1e-300}));
  row("a placement that scales by 1e30 across", Affine::scaled({1, 1, 1e30}));
  row("a placement that mirrors", Affine::scaled({-1, 1, 1}));
}

}  // namespace tessera::test
