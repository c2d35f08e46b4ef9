// Vertices have parameters of their surfaces: each vertex lies where the surface has its parameters, everywhere.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "support/synthetic_sets.h"
#include "tess_trim/closed_shape.h"
#include "tess_trim/trimmed_face.h"
#include "tessera/tessellation.h"

namespace tessera::test { namespace {

using Kind = VertexParameters;

struct Textured {
  Tessellation plan;
  Mesh mesh;
};

Textured textured(const PatchSet& set, const TessellationOptions& options) {
  Tessellation plan = value_of(Tessellation::make(set, options));
  Mesh mesh = value_of(plan.allocate());
  const Status status = plan.run(set, mesh.views());
  EXPECT_TRUE(status.ok()) << status.message();
  return {std::move(plan), std::move(mesh)};
}

/// Calls visit(patch, corners) for each triangle and each quad.
template <class Visit>
void for_textured_faces(const Mesh& mesh, Visit visit) {
  for (std::size_t k = 0; k < mesh.triangle_count(); ++k)
    visit(mesh.patches[k], std::span(mesh.indices).subspan(3 * k, 3));
  for (std::size_t k = 0; k < mesh.quad_count(); ++k)
    visit(mesh.quad_patches[k], std::span(mesh.quads).subspan(4 * k, 4));
}

Vec3 textured_position(const Mesh& mesh, std::size_t vertex) {
  const float* p = &mesh.positions[3 * vertex];
  return mesh.origin + Vec3{double(p[0]), double(p[1]), double(p[2])};
}

/// Checks that each corner of a face lies within its patch's rectangle of parameters, and where the patch is there.
void expect_right(const PatchSet& set, const Mesh& mesh, double near, const std::string& name) {
  ASSERT_EQ(mesh.parameters.size(), 2 * mesh.vertex_count()) << name;
  double farthest = 0, outside = 0;
  for_textured_faces(mesh, [&](std::uint32_t patch, std::span<const std::uint32_t> corners) {
    const Domain& d = set.source(patch).domain;
    for (const std::uint32_t corner : corners) {
      const double u = d.local_u(mesh.parameters[2 * corner]), v = d.local_v(mesh.parameters[2 * corner + 1]);
      outside = std::max({outside, -u, u - 1, -v, v - 1});
      const SurfaceJet jet = evaluate_jet(set.patch(patch), std::clamp(u, 0.0, 1.0), std::clamp(v, 0.0, 1.0));
      farthest = std::max(farthest, length(jet.position - textured_position(mesh, corner)));
    }
  });
  EXPECT_LE(outside, 1e-5) << name;
  EXPECT_LE(farthest, near) << name;
}

std::vector<std::pair<std::string, BSplineSurface>> textured_surfaces() {
  return {{"wavy", wavy()},
          {"sphere", value_of(make_nurbs_sphere({}, 2))},
          {"torus", value_of(make_nurbs_torus({}, 3, 1))},
          {"cylinder", value_of(make_nurbs_cylinder({}, 1, 2))},
          {"cone", value_of(make_nurbs_cone({}, 1, 0, 2))}};
}

TEST(VertexParameters, AreThoseOfTheSurfaceByDefault) {
  for (const auto& [name, surface] : textured_surfaces()) {
    const PatchSet set = value_of(make_patch_set(Model{.name = {}, .surfaces = {{.name = name, .surface = surface}}}));
    for (const bool quads : {false, true})
      for (const TessellationOptions& options :
           {TessellationOptions{.rates = UniformRates{3, 5}, .quads = quads},
            TessellationOptions{.tolerance = 0.01, .quads = quads},
            TessellationOptions{.tolerance = 0.01, .angle = 0.2, .quads = quads},
            TessellationOptions{.tolerance = 0.01, .quads = quads, .precision = Precision::double_precision}})
        expect_right(set, textured(set, options).mesh, 2e-6, name);
  }
}

TEST(VertexParameters, OfUnitsReachFromSideToSide) {
  for (const auto& [name, surface] : textured_surfaces()) {
    Model model{.name = {}, .surfaces = {{.name = name, .surface = surface}, {.name = name, .surface = plane()}}};
    const PatchSet set = value_of(make_patch_set(model));
    for (const TessellationOptions& options :
         {TessellationOptions{.rates = UniformRates{3, 5}, .parameters = Kind::unit},
          TessellationOptions{.tolerance = 0.01, .parameters = Kind::unit}}) {
      const Mesh mesh = textured(set, options).mesh, own = [&] {
        TessellationOptions other = options;
        other.parameters = Kind::surface;
        return textured(set, other).mesh;
      }();
      EXPECT_EQ(*std::ranges::min_element(mesh.parameters), 0) << name;
      EXPECT_EQ(*std::ranges::max_element(mesh.parameters), 1) << name;
      EXPECT_EQ(mesh.indices, own.indices);
      const auto check = [&](std::uint32_t patch, std::span<const std::uint32_t> corners) {
        const Domain d = set.source(patch).surface == 0 ? value_of(to_bezier(surface)).domain() : Domain{0, 4, 0, 3};
        for (const std::uint32_t k : corners) {
          EXPECT_NEAR(mesh.parameters[2 * k], d.local_u(own.parameters[2 * k]), 1e-6) << name;
          EXPECT_NEAR(mesh.parameters[2 * k + 1], d.local_v(own.parameters[2 * k + 1]), 1e-6) << name;
        }
      };
      for_textured_faces(mesh, check);
    }
  }
}

/// The unit is that of the surface, not of what its loops keep.
TEST(VertexParameters, OfUnitsKnowWhatLoopsCutAway) {
  Face face(plane(), {circle_loop(3.2, 2.3, 0.5, false)});
  const Mesh mesh = face.mesh({.tolerance = 1e-3, .parameters = Kind::unit});
  for (std::size_t k = 0; k < mesh.vertex_count(); ++k) {
    const Vec3 p = textured_position(mesh, k);
    EXPECT_NEAR(mesh.parameters[2 * k], p.x / 4, 1e-6);
    EXPECT_NEAR(mesh.parameters[2 * k + 1], p.y / 3, 1e-6);
  }
}

TEST(VertexParameters, OfPatchesAreThoseOfEachPatch) {
  const PatchSet set = value_of(make_patch_set(Model{.name = {}, .surfaces = {{.name = {}, .surface = wavy()}}}));
  const PatchSet patches = value_of(PatchSet::make([&] {
    std::vector<BezierPatch> all;
    for (std::size_t k = 0; k < set.patch_count(); ++k) all.push_back(set.patch(k));
    return all;
  }()));
  const TessellationOptions options{.tolerance = 0.01, .parameters = Kind::patch};
  EXPECT_EQ(textured(set, options).mesh.parameters, textured(patches, options).mesh.parameters);
}

/// Shared vertices: right in every triangle, shared within a surface, apart at its seams.
TEST(VertexParameters, OfSharedVerticesAreRightEverywhere) {
  for (const auto& [name, surface] : textured_surfaces()) {
    const PatchSet set = value_of(make_patch_set(
        Model{.name = {}, .surfaces = {{.name = name, .surface = surface}, {.name = name, .surface = surface}}}));
    for (const std::optional<double> crease : {std::optional<double>(), std::optional(0.1)}) {
      TessellationOptions options{.tolerance = 0.01, .joining = {.crease_angle = crease, .share_vertices = true}};
      const Textured all = textured(set, options);
      EXPECT_TRUE(all.mesh.parameters.empty());
      Mesh with = all.mesh;
      with.parameters.resize(2 * with.vertex_count());
      EXPECT_EQ(all.plan.run(set, with.views()).code(), StatusCode::invalid_argument);
      options.parameters = Kind::surface;
      const Mesh split = textured(set, options).mesh;
      expect_right(set, split, 2e-6, name);
      options.joining.share_vertices = false;
      const Textured own = textured(set, options);
      const Mesh& apart = own.mesh;
      EXPECT_LT(split.vertex_count(), apart.vertex_count()) << name;
      EXPECT_GE(split.vertex_count(), all.mesh.vertex_count()) << name;
      std::set<std::array<float, 5>> distinct[2];  // by surface: what could be shared at most
      for (std::size_t patch = 0; patch < set.patch_count(); ++patch)
        for (std::size_t k = own.plan.before(patch).vertices; k < own.plan.before(patch + 1).vertices; ++k)
          distinct[set.source(patch).surface].insert({apart.positions[3 * k], apart.positions[3 * k + 1],
                                                      apart.positions[3 * k + 2], apart.parameters[2 * k],
                                                      apart.parameters[2 * k + 1]});
      EXPECT_EQ(split.vertex_count(), distinct[0].size() + distinct[1].size()) << name;
    }
  }
}

TEST(VertexParameters, OfTrimmedAndClosedFacesAreRight) {
  const Shape shape = value_of(joined_shape(drilled_plate(), 1e-6));
  const PatchSet set = value_of(make_patch_set(shape));
  for (const std::optional<double> crease : {std::optional<double>(), std::optional(0.1)}) {
    TessellationOptions options{.tolerance = 1e-3, .joining = {.crease_angle = crease}};
    const Mesh apart = textured(set, options).mesh;
    expect_right(set, apart, 1e-4, "apart");
    options.joining.share_vertices = true;
    const Mesh all = textured(set, options).mesh;
    EXPECT_TRUE(all.parameters.empty());
    options.parameters = Kind::surface;
    const Mesh split = textured(set, options).mesh;
    expect_right(set, split, 1e-4, "shared");
    EXPECT_LE(split.vertex_count(), apart.vertex_count());
    EXPECT_GT(split.vertex_count(), all.vertex_count());
  }
}

TEST(VertexParameters, OfPatchesAreNotForSharedVertices) {
  const PatchSet set = value_of(make_patch_set(Model{.name = {}, .surfaces = {{.name = {}, .surface = wavy()}}}));
  const Status status =
      Tessellation::make(set, {.tolerance = 0.01, .joining = {.share_vertices = true}, .parameters = Kind::patch})
          .status();
  EXPECT_EQ(status.code(), StatusCode::invalid_argument);
  EXPECT_NE(status.message().find("parameters of patches"), std::string::npos) << status.message();
}

}}  // namespace tessera::test
