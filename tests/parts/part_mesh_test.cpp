// Meshes of models in parts are those of the whole, bit for bit.

#include "tessera/part_mesh.h"

#include <gtest/gtest.h>

#include <mutex>
#include <random>

#include "parts/joined_parts.h"
#include "support/random_patches.h"
#include "tess_trim/closed_shape.h"
#include "tessera/topology.h"

namespace tessera::test { namespace {

Model model_of(const std::vector<BezierPatch>& patches) {
  Model model;
  for (const BezierPatch& patch : patches) model.surfaces.push_back({"", patch});
  return model;
}

/// A sheet whose middle bends a lot, with patches apart by less than the default weld, and a body beside it.
Model sheet(int nu, int nv, double gap = 0) {
  std::vector<BezierPatch> patches = wavy_field(nu, nv);
  for (std::size_t k = 0; k < patches.size(); ++k)
    if (k % 5 == 2) patches[k] = placed({patches[k]}, 1, {0, 0, gap}).front();
  const std::vector<BezierPatch> other = placed(wavy_field(3, 2), 0.25, {double(nu) + 2, 0, 3});
  patches.insert(patches.end(), other.begin(), other.end());
  return model_of(patches);
}

Model shuffled(Model model, Random& random) {
  std::ranges::shuffle(model.surfaces, random);
  return model;
}

/// Random ends of `parts` runs, some of them empty.
std::vector<std::size_t> random_ends(std::size_t count, std::size_t parts, Random& random) {
  std::vector<std::size_t> ends{count};
  while (ends.size() < parts) ends.push_back(std::uniform_int_distribution<std::size_t>(0, count)(random));
  std::ranges::sort(ends);
  return ends;
}

Model drilled() {
  Model model;
  model.shapes = {joined(drilled_plate(), 1e-6), joined(cube(1, {0.5, 0.5, 1}), 1e-6)};
  const Affine side = Affine::translated({4, 0, 0});
  model.instances = {{.shape = 0}, {.shape = 1}, {.shape = 0, .placement = side}, {.shape = 1, .placement = side}};
  std::size_t first = 0;
  for (Instance& instance : model.instances) {
    instance.first_surface = first;
    first += model.shapes[instance.shape].faces.size();
  }
  model.surfaces = value_of(placed_faces(model.shapes, model.instances));
  return model;
}

void expect_same(const Model& model, const TessellationOptions& options, const char* what, Random& random) {
  const Mesh whole = value_of(whole_mesh(model, options));
  const std::size_t count = model.surfaces.size();
  for (const std::size_t parts :
       {std::size_t{1}, std::size_t{2}, std::size_t{3}, std::size_t{4}, std::size_t{7}, count}) {
    std::vector<std::size_t> ends = random_ends(count, parts, random);
    if (parts == count)
      for (std::size_t k = 0; k < count; ++k) ends[k] = k + 1;
    const Result<Mesh> mesh = mesh_in_parts(model, ends, options);
    ASSERT_TRUE(mesh) << what << ": " << mesh.status().message();
    EXPECT_EQ(difference(whole, *mesh), "") << what << " in " << parts << " parts";
  }
}

TEST(PartMesh, OfPatchesIsTheWholes) {
  Random random(1);
  const View view{.eye = {-4, -6, 8}, .target = {4, 4, 0}};
  for (const double tolerance : {1e-1, 1e-2, 1e-3}) {
    for (const double gap : {0.0, 0.05 * tolerance, 0.12 * tolerance}) {
      const Model model = shuffled(sheet(6, 5, gap), random);
      expect_same(model, {.tolerance = tolerance}, "a tolerance", random);
      expect_same(model, {.tolerance = tolerance, .quads = true}, "quads", random);
      expect_same(model, {.tolerance = tolerance / 8, .relative = true}, "a share", random);
      expect_same(model, {.tolerance = tolerance, .angle = 0.2}, "an angle", random);
      expect_same(model, {.pixels = PixelTolerance{200 * tolerance, view}}, "pixels", random);
      expect_same(model, {.tolerance = tolerance, .joining = {.weld = 0.2 * tolerance}}, "a weld", random);
      expect_same(model, {.tolerance = tolerance, .precision = Precision::double_precision}, "doubles", random);
    }
  }
  expect_same(sheet(4, 4), {.rates = UniformRates{5, 3}}, "rates", random);
}

TEST(PartMesh, OfPatchesFarFromTheOriginIsTheWholes) {
  Random random(2);
  std::vector<BezierPatch> patches = wavy_field(4, 4);
  const std::vector<BezierPatch> far = placed(wavy_field(4, 4), 1, {3e4, 0, 0});
  patches.insert(patches.end(), far.begin(), far.end());
  for (const double tolerance : {0.02, 0.01, 0.006})
    expect_same(model_of(patches), {.tolerance = tolerance}, "far", random);
}

TEST(PartMesh, OfTrimmedShapesIsTheWholes) {
  Random random(3);
  const Model model = drilled();
  for (const double tolerance : {0.3, 0.05, 1e-3, 1e-4}) {
    expect_same(model, {.tolerance = tolerance}, "instances", random);
    expect_same(model, {.tolerance = tolerance, .angle = 0.3, .quads = true}, "an angle and quads", random);
    expect_same(model, {.tolerance = tolerance, .joining = {.close_edges = false}}, "open edges", random);
  }
}

/// Meshes a model that parts read run by run.
Result<Mesh> read_in_parts(const Model& model, std::size_t parts, const TessellationOptions& options,
                           std::uint64_t& bytes) {
  const SurfaceSource source{model.surfaces.size(), [&](std::uint64_t first, std::uint64_t end) -> Result<Model> {
                               Model read;
                               read.surfaces.assign(model.surfaces.begin() + static_cast<std::ptrdiff_t>(first),
                                                    model.surfaces.begin() + static_cast<std::ptrdiff_t>(end));
                               return read;
                             }};
  std::vector<Mesh> meshes(parts);
  std::vector<PartSums> sums(parts);
  std::mutex mutex;
  const Status status = run_parts(parts, [&](Transport& transport) -> Status {
    const std::size_t k = transport.part();
    const Result<PartOutline> outline = find_part(source, run_of_part(source.count, k, parts), options, transport);
    if (!outline) return outline.status();
    const Result<ModelPart> part = load_part(source, *outline);
    const Result<PartMesh> own = part ? tessellate_part(*part, options) : part.status();
    const Result<PartSums> sum = sum_parts(own, options, transport);
    if (!sum) return sum.status();
    meshes[k] = own->mesh, sums[k] = *sum;
    const std::lock_guard lock(mutex);
    bytes += transport.bytes_sent();
    return {};
  });
  if (!status.ok()) return status;
  Mesh mesh;
  for (std::size_t k = 0; k < parts; ++k) {
    EXPECT_EQ(sums[k].before.vertices, mesh.vertex_count());
    EXPECT_EQ(sums[k].before.triangles, mesh.triangle_count());
    append(meshes[k], static_cast<std::uint32_t>(sums[k].before.patches), mesh);
    EXPECT_EQ(sums[k].bound, sums[0].bound);
  }
  EXPECT_EQ(sums[0].all.vertices, mesh.vertex_count());
  EXPECT_EQ(sums[0].all.triangles, mesh.triangle_count());
  return mesh;
}

TEST(PartMesh, OfPartsThatTakeTurnsIsTheWholes) {
  const Model model = sheet(20, 20, 0.0005);
  const TessellationOptions options{.tolerance = 1e-2};
  const Mesh whole = value_of(whole_mesh(model, options));
  for (const std::size_t parts : {1u, 2u, 3u, 4u, 7u, 500u}) {
    std::uint64_t bytes = 0;
    const Result<Mesh> mesh = read_in_parts(model, parts, options, bytes);
    ASSERT_TRUE(mesh) << mesh.status().message();
    EXPECT_EQ(difference(whole, *mesh), "") << parts << " parts";
    const std::uint64_t most = parts * parts * 400 + (parts - 1) * 2 * 2 * 25 * 104;  // of rows of 20 patches
    if (parts <= 7) {
      EXPECT_LT(bytes, most);
    }
  }
}

TEST(PartMesh, TellsWhatItCannotDo) {
  const Model model = sheet(3, 3);
  const SurfaceExtents extents = value_of(surface_extents(model));
  const std::size_t count = model.surfaces.size();
  EXPECT_EQ(part_of(model, extents, 3, count + 1, 0).status().code(), StatusCode::invalid_argument);
  EXPECT_EQ(part_of(model, extents, 3, 2, 0).status().code(), StatusCode::invalid_argument);
  EXPECT_EQ(part_of(model, extents, 0, 2, -1).status().code(), StatusCode::invalid_argument);
  EXPECT_EQ(part_of(model, extents, 0, 2, std::nan("")).status().code(), StatusCode::invalid_argument);
  EXPECT_EQ(part_of(model, {}, 0, 2, 0).status().code(), StatusCode::count_mismatch);
  const ModelPart part = value_of(part_of(model, extents, 0, 2, 0));
  for (const TessellationOptions& options : {TessellationOptions{.tolerance = 0.1, .joining = {.share_vertices = true}},
                                             {.tolerance = 0.1, .joining = {.crease_angle = 0.1}},
                                             {.budget = 1000},
                                             {.surface_tolerances = {0.1}},
                                             {.tolerance = 0.1, .fewest = true}})
    EXPECT_EQ(tessellate_part(part, options).status().code(), StatusCode::unsupported);
  EXPECT_EQ(tessellate_part(part, {.tolerance = -1}).status().code(), StatusCode::invalid_argument);
}

TEST(PartMesh, EndsInAllPartsWhereOneFails) {
  const Model model = sheet(6, 6);
  const TessellationOptions options{.tolerance = 1e-2};
  std::vector<std::string> messages(3);
  const SurfaceSource source{model.surfaces.size(), [&](std::uint64_t first, std::uint64_t) -> Result<Model> {
                               if (first > 5) return Status(StatusCode::io_error, "the disk is gone");
                               Model read;
                               read.surfaces.assign(14, model.surfaces[0]);
                               return read;
                             }};
  const Status status = run_parts(3, [&](Transport& transport) -> Status {
    const auto outline = find_part(source, run_of_part(source.count, transport.part(), 3), options, transport);
    messages[transport.part()] = outline.status().message();
    return outline.status();
  });
  EXPECT_EQ(status.code(), StatusCode::io_error) << status.message();
  for (const std::string& message : messages) EXPECT_EQ(message, "part 1: the disk is gone");
}

TEST(PartMesh, RefusesRunsThatAreNotTheWhole) {
  const SurfaceSource source{6, [&](std::uint64_t first, std::uint64_t end) -> Result<Model> {
                               Model read = sheet(2, 3);
                               read.surfaces.erase(read.surfaces.begin(),
                                                   read.surfaces.end() - static_cast<std::ptrdiff_t>(end - first));
                               return read;
                             }};
  for (const std::vector<PartRun>& runs :
       {std::vector<PartRun>{{0, 2}, {3, 6}}, {{0, 3}, {2, 6}}, {{0, 3}, {3, 5}}, {{0, 3}, {3, 7}}}) {
    const Status status = run_parts(2, [&](Transport& transport) -> Status {
      return find_part(source, runs[transport.part()], {.tolerance = 0.1}, transport).status();
    });
    EXPECT_EQ(status.code(), StatusCode::invalid_argument) << status.message();
  }
}

}}  // namespace tessera::test
