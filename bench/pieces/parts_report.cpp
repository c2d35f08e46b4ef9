// A model meshed in parts, one after the other in this process, beside the model meshed whole: times, and the same
// bytes.
//
//   tessera_parts_report [SIDE] [TRIES]   a sheet of SIDE x SIDE patches (400), the best of TRIES (5)

#include <malloc.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <vector>

#include "support/synthetic_sets.h"
#include "tessera/part_mesh.h"

namespace tessera::bench { namespace {

using test::value_of;

/// FNV-1a of each attribute of a mesh, which may come in parts.
class Digest {
 public:
  void add(const Mesh& mesh) {
    add(mesh.positions, positions_), add(mesh.normals, normals_), add(mesh.parameters, parameters_);
    for (const std::uint32_t index : mesh.indices) add(index + vertices_, indices_);
    vertices_ += mesh.vertex_count();
  }
  bool operator==(const Digest&) const = default;

 private:
  static void add(std::uint64_t value, std::uint64_t& to) { (to ^= value) *= 0x100000001b3; }
  static void add(const std::vector<float>& values, std::uint64_t& to) {
    for (const float value : values) add(std::bit_cast<std::uint32_t>(value), to);
  }

  std::uint64_t positions_ = 0, normals_ = 0, parameters_ = 0, indices_ = 0, vertices_ = 0;
};

double seconds_of(const auto& run) {
  const auto begin = std::chrono::steady_clock::now();
  run();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

Mesh whole_mesh(const Model& model, const TessellationOptions& options) {
  const PatchSet set = value_of(make_patch_set(model));
  const Tessellation plan = value_of(Tessellation::make(set, options));
  Mesh mesh = value_of(plan.allocate());
  if (!plan.run(set, mesh.views()).ok()) std::abort();
  return mesh;
}

std::vector<Mesh> meshes_in_parts(const Model& model, std::size_t parts, const TessellationOptions& options,
                                  std::size_t& surfaces) {
  const SurfaceExtents extents = value_of(surface_extents(model));
  const double reach = part_reach(options, extents.box());
  std::vector<Mesh> meshes;
  surfaces = 0;
  for (std::size_t k = 0; k < parts; ++k) {
    const PartRun run = run_of_part(model.surfaces.size(), k, parts);
    const ModelPart part = value_of(part_of(model, extents, run.begin, run.end, reach));
    surfaces += part.surfaces.size();
    meshes.push_back(value_of(tessellate_part(part, options)).mesh);
  }
  return meshes;
}

int run(int argc, char** argv) {
  const int side = argc > 1 ? std::atoi(argv[1]) : 400, tries = argc > 2 ? std::atoi(argv[2]) : 5;
  if (argc > 3 || side < 1 || tries < 1) {
    std::fprintf(stderr, "tessera_parts_report: expected [SIDE] [TRIES], two whole numbers above 0\n");
    return 2;
  }
  // Freed memory stays: whether malloc() returns it to the system depends on sizes, and fresh pages of a coarse mesh
  // take longer than all else.
  ::mallopt(M_MMAP_MAX, 0), ::mallopt(M_TRIM_THRESHOLD, -1);
  Model model;
  for (const BezierPatch& patch : test::wavy_field(side, side)) model.surfaces.push_back({"", patch});
  std::printf("%zu patches, of the time of the whole; parts hold so many surfaces in all:\n", model.surfaces.size());
  bool same = true;
  for (const double tolerance : {1e-1, 1e-2, 1e-3})
    for (const std::size_t parts : {1u, 2u, 4u, 16u}) {
      const TessellationOptions options{.tolerance = tolerance};
      double whole = std::numeric_limits<double>::infinity(), split = whole;
      std::size_t surfaces = 0, triangles = 0;
      Digest expected, found;
      for (int k = 0; k < tries; ++k) {
        {
          Mesh mesh;
          whole = std::min(whole, seconds_of([&] { mesh = whole_mesh(model, options); }));
          if (k == 0) expected.add(mesh), triangles = mesh.triangle_count();
        }  // its memory is free again for the parts
        std::vector<Mesh> meshes;
        split = std::min(split, seconds_of([&] { meshes = meshes_in_parts(model, parts, options, surfaces); }));
        if (k > 0) continue;
        for (const Mesh& part : meshes) found.add(part);
      }
      same = same && expected == found;
      std::printf("%.0e %2zu parts: %.2f (%.0f and %.0f ms, %zu triangles), %.3f of the surfaces\n", tolerance, parts,
                  split / whole, 1e3 * split, 1e3 * whole, triangles, double(surfaces) / double(model.surfaces.size()));
      if (!same) std::printf("the parts have another mesh than the whole\n");
    }
  return same ? 0 : 1;
}

}}  // namespace tessera::bench

int main(int argc, char** argv) { return tessera::bench::run(argc, argv); }
