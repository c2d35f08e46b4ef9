// Solids, shells, polygons and sets of STEP texts, and units and places of parts.

#include <gtest/gtest.h>

#include "io_step/step_builder.h"

namespace tessera::test { namespace {

using std::numbers::pi;

TEST(StepShells, BoxesUseEdgesBothWays) {
  StepBuilder b;
  const Model model = expect_solid(b.file({b.solid(b.box_faces({1, 2, 3}, {3, 5, 7}))}), 52, 24);
  expect_outward(model, {2, 4, 5});
  EXPECT_EQ(model.shapes.at(0).edges.size(), 12u);
  EXPECT_EQ(model.shapes.at(0).vertices.size(), 8u);
}

TEST(StepShells, VoidsAreTakenAway) {
  for (const bool is_along : {true, false}) {
    StepBuilder b;
    const int outer = b.shell(b.box_faces({0, 0, 0}, {4, 4, 4}));
    const int ball = b.placed("SPHERICAL_SURFACE", b.axes({2, 2, 2}), {1});
    // The cavity's faces look outwards or inwards; the orientation says which.
    const int inner = b.shell({b.face(ball, {b.vertex_loop({2, 2, 3})}, !is_along)});
    const int used = b.add("ORIENTED_CLOSED_SHELL('',*," + b.ref_of(inner) + "," + b.flag(is_along) + ")");
    const int solid = b.add("BREP_WITH_VOIDS(''," + b.ref_of(outer) + "," + b.list({used}) + ")");
    const Model model = expect_solid(b.file({solid}), 96 + 4 * pi, 64 - 4 * pi / 3);
    EXPECT_EQ(model.shapes.at(0).shells.size(), 2u);
    EXPECT_EQ(model.shapes.at(0).solid_count, 1u);
    const ModelSurface& cavity = model.surfaces.at(6);
    const Domain d = domain(cavity.surface);
    const SurfaceJet jet = value_of(evaluate_jet(cavity, d.u_at(0.3), d.v_at(0.6)));
    EXPECT_LT(dot(cross(jet.du, jet.dv), jet.position - Vec3{2, 2, 2}), 0) << "the normal leaves the material";
  }
}

TEST(StepShells, FacetedSolidsHavePolygons) {
  StepBuilder b;
  const StepBuilder::Numbers p = b.points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}});
  StepBuilder::Numbers faces;
  const Vec3 slant{1, 1, 1};
  const auto side = [&](int a, int c, int d, const Vec3& at, const Vec3& normal, const Vec3& x) {
    const int loop = b.add("POLY_LOOP(''," + b.list({a, c, d}) + ")");
    faces.push_back(b.face(b.placed("PLANE", b.axes(at, normal, x)), {loop}));
  };
  side(p[0], p[2], p[1], {}, {0, 0, -1}, {1, 0, 0});
  side(p[0], p[1], p[3], {}, {0, -1, 0}, {1, 0, 0});
  side(p[0], p[3], p[2], {}, {-1, 0, 0}, {0, 1, 0});
  side(p[1], p[2], p[3], {1, 0, 0}, slant, {1, -1, 0});
  const int solid = b.add("FACETED_BREP(''," + b.ref_of(b.shell(faces)) + ")");
  const Model model = expect_solid(b.file({solid}), 1.5 + std::sqrt(3.0) / 2, 1.0 / 6);
  expect_outward(model, {0.1, 0.1, 0.1});
}

TEST(StepShells, SurfaceModelsHaveShellsWithoutSolids) {
  StepBuilder b;
  const StepBuilder::Numbers faces = b.box_faces({0, 0, 0}, {1, 1, 1});
  const int open = b.shell({faces[0], faces[1]}, "OPEN_SHELL");
  const int shells = b.add("SHELL_BASED_SURFACE_MODEL(''," + b.list({open}) + ")");
  const int more = b.add("FACE_BASED_SURFACE_MODEL(''," + b.list({b.shell({faces[2]}, "CONNECTED_FACE_SET")}) + ")");
  const Model model = expect_area(b.file({shells, more}), 3);
  EXPECT_EQ(model.shapes.at(0).shells.size(), 2u);
  EXPECT_EQ(model.shapes.at(0).solid_count, 0u);
  EXPECT_EQ(value_of(closed_shells(model.shapes[0])), (std::vector<bool>{false, false}));
}

TEST(StepShells, SetsOfGeometryHaveTrimmedSurfaces) {
  StepBuilder b;
  const int round = b.placed("CYLINDRICAL_SURFACE", b.axes({0, 0, 0}), {2});
  const int plane = b.placed("PLANE", b.axes({0, 0, 0}));
  const int trimmed = b.add("RECTANGULAR_TRIMMED_SURFACE(''," + b.ref_of(round) + ",0.5,2.,-1.,3.,.T.,.T.)");
  const int flat = b.add("RECTANGULAR_TRIMMED_SURFACE(''," + b.ref_of(plane) + ",0.,2.,-1.,3.,.T.,.T.)");
  const int ball = b.placed("SPHERICAL_SURFACE", b.axes({9, 0, 0}), {1});
  const int set = b.add("GEOMETRIC_SET(''," + b.list({trimmed, b.point({1, 1, 1}), flat, ball}) + ")");
  expect_area(b.file({set}), 12 + 8 + 4 * pi);
}

TEST(StepShells, OrientedFacesTurnNormals) {
  for (const bool is_along : {true, false}) {
    StepBuilder b;
    const int ball = b.face(b.placed("SPHERICAL_SURFACE", b.axes({0, 0, 0}), {1}), {b.vertex_loop({0, 0, 1})});
    const int used = b.add("ORIENTED_FACE('',*," + b.ref_of(ball) + "," + b.flag(is_along) + ")");
    const Model model = expect_area(b.file({b.shell({used})}), 4 * pi);
    const Domain d = domain(model.surfaces.at(0).surface);
    const SurfaceJet jet = value_of(evaluate_jet(model.surfaces[0], d.u_at(0.3), d.v_at(0.6)));
    EXPECT_EQ(dot(cross(jet.du, jet.dv), jet.position) > 0, is_along);
  }
}

/// Units of length in inches and of angle in degrees.
StepBuilder::Numbers inches_and_degrees(StepBuilder& b) {
  const int millimetre = b.add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))");
  const int radian = b.add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))");
  const int size = b.add("LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4)," + b.ref_of(millimetre) + ")");
  const int angle =
      b.add("PLANE_ANGLE_MEASURE_WITH_UNIT(PLANE_ANGLE_MEASURE(" + b.real(pi / 180) + ")," + b.ref_of(radian) + ")");
  return {b.add("(CONVERSION_BASED_UNIT('INCH'," + b.ref_of(size) + ")LENGTH_UNIT()NAMED_UNIT($))"),
          b.add("(CONVERSION_BASED_UNIT('DEGREE'," + b.ref_of(angle) + ")NAMED_UNIT($)PLANE_ANGLE_UNIT())")};
}

TEST(StepShells, InchesAndDegreesAreConverted) {
  StepBuilder b;
  const StepBuilder::Numbers units = inches_and_degrees(b);
  const int round = b.placed("CYLINDRICAL_SURFACE", b.axes({0, 0, 0}), {2});
  const int half = b.add("RECTANGULAR_TRIMMED_SURFACE(''," + b.ref_of(round) + ",0.,180.,0.,3.,.T.,.T.)");
  const int cone = b.placed("CONICAL_SURFACE", b.axes({0, 0, 0}), {0, 30});  // half angle 30 degrees
  const int part = b.add("RECTANGULAR_TRIMMED_SURFACE(''," + b.ref_of(cone) + ",90.,180.,0.,3.,.T.,.T.)");
  const int set = b.add("GEOMETRIC_SET(''," + b.list({half, part}) + ")");
  const double slanted = 3 / std::cos(pi / 6);
  const double quarter = 0.25 * pi * (3 * std::tan(pi / 6)) * slanted;
  expect_area(b.file({set}, units), 25.4 * 25.4 * (6 * pi + quarter));
}

TEST(StepShells, MirroredPlacesKeepNormalsOutside) {
  StepBuilder b;
  const int millimetre = b.add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))");
  const int context = b.add("(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT(" + b.list({millimetre}) +
                            ")REPRESENTATION_CONTEXT('',''))");
  const int solid = b.solid(b.box_faces({1, 2, 3}, {3, 5, 7})), origin = b.axes({0, 0, 0});
  const auto shape = [&](const StepBuilder::Numbers& items) {
    return b.add("SHAPE_REPRESENTATION(''," + b.list(items) + "," + b.ref_of(context) + ")");
  };
  const int map = b.add("REPRESENTATION_MAP(" + b.ref_of(origin) + "," + b.ref_of(shape({solid, origin})) + ")");
  const std::string x = b.ref_of(b.direction({-1, 0, 0})), y = b.ref_of(b.direction({0, 1, 0})),
                    z = b.ref_of(b.direction({0, 0, 1})), at = b.ref_of(b.point({10, 0, 0}));
  const int mirror = b.add("CARTESIAN_TRANSFORMATION_OPERATOR_3D('','',$," + x + "," + y + "," + at + ",2.," + z + ")");
  shape({b.add("MAPPED_ITEM(''," + b.ref_of(map) + "," + b.ref_of(mirror) + ")")});
  const Model model = expect_solid(b.whole(), 4 * 52, 8 * 24);
  EXPECT_LT(model.instances.at(0).placement->determinant(), 0);
  for (std::size_t k = 0; k < model.surfaces.size(); ++k) {
    const ModelSurface& face = model.surfaces[k];
    const Domain d = domain(face.surface);
    // The shape is turned inside out, so that the mapping, which mirrors, turns its normals outwards.
    const SurfaceJet jet = value_of(evaluate_jet(face.surface, d.u_at(0.4), d.v_at(0.4)));
    EXPECT_LT(dot(cross(jet.du, jet.dv), jet.position - Vec3{2, 4, 5}), 0) << "face " << k;
  }
}

}}  // namespace tessera::test
