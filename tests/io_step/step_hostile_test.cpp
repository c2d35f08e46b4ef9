// STEP texts that are malformed, endless, enormous or tiny: each ends soon, as an error or as a model whose warnings
// name the instance and its line.

#include <gtest/gtest.h>

#include <chrono>

#include "io_step/step_builder.h"
#include "support/errors.h"

namespace tessera::test { namespace {

/// The outcome of a text: the error, or all warnings of the model.
struct Ending {
  bool is_model = false;
  std::string words;
  std::size_t surfaces = 0;
};

Ending ending_of(const std::string& text, double most_seconds = 5) {
  const auto start = std::chrono::steady_clock::now();
  const Result<Model> model = read_step(text, "part");
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  EXPECT_LT(seconds, most_seconds) << text.substr(0, 2000);
  Ending out;
  if (!model) {
    EXPECT_NE(model.status().code(), StatusCode::internal) << model.status().message();
    EXPECT_NE(model.status().code(), StatusCode::out_of_memory) << model.status().message();
    out.words = model.status().message();
    return out;
  }
  out.is_model = true, out.surfaces = model->surfaces.size();
  for (const std::string& warning : model->warnings) out.words += warning + "\n";
  const Status topology = check_topology(*model);
  EXPECT_TRUE(topology.ok()) << topology.message();
  for (const ModelSurface& surface : model->surfaces) {
    const Domain d = domain(surface.surface);
    const Result<SurfaceJet> jet = evaluate_jet(surface, d.u_at(0.5), d.v_at(0.5));
    EXPECT_TRUE(jet && is_finite(jet->position)) << text.substr(0, 2000);
  }
  return out;
}

/// A ball and what else: the ball is read, and a warning has these words; or all fails with them.
void expect_fault(StepBuilder b, const StepBuilder::Numbers& items, const std::string& words) {
  const Ending alone = ending_of(StepBuilder(b).file(items));
  EXPECT_FALSE(alone.is_model) << words;
  EXPECT_NE(alone.words.find(words), std::string::npos) << alone.words;
  StepBuilder::Numbers all = items;
  all.push_back(b.solid({b.face(b.placed("SPHERICAL_SURFACE", b.axes({50, 0, 0}), {1}), {b.vertex_loop({50, 0, 1})})}));
  const Ending beside = ending_of(b.file(all));
  EXPECT_TRUE(beside.is_model) << words;
  EXPECT_EQ(beside.surfaces, 1u);
  EXPECT_NE(beside.words.find(words), std::string::npos) << beside.words;
}

/// A face with a circle of radius 2 about z as its only loop, on this surface.
int disc_on(StepBuilder& b, int surface, double radius = 2) {
  const Vec3 start{radius, 0, 0};
  return b.face(surface, {b.loop({b.edge(start, start, b.placed("CIRCLE", b.axes({0, 0, 0}), {radius}))})});
}

TEST(StepHostile, BadNumbersOfSurfacesAreNamed) {
  struct Case {
    std::string kind;
    std::vector<double> numbers;
    std::string words;
  };
  for (const Case& c : {Case{"SPHERICAL_SURFACE", {0}, "SPHERICAL_SURFACE in line 7"},
                        Case{"SPHERICAL_SURFACE", {-1}, "SPHERICAL_SURFACE in line 7"},
                        Case{"CYLINDRICAL_SURFACE", {0}, "expected a number above 0"},
                        Case{"CYLINDRICAL_SURFACE", {-3}, "expected a number above 0"},
                        Case{"CONICAL_SURFACE", {1, 2}, "expected less than a right angle"},
                        Case{"CONICAL_SURFACE", {-1, 0.5}, "expected 0 or more"},
                        Case{"TOROIDAL_SURFACE", {5, 0}, "TOROIDAL_SURFACE in line"},
                        Case{"TOROIDAL_SURFACE", {0, 1}, "TOROIDAL_SURFACE in line"},
                        Case{"CYLINDRICAL_SURFACE", {}, "CYLINDRICAL_SURFACE in line"}}) {
    StepBuilder b;
    const int origin = b.add("CARTESIAN_POINT('',(0.,0.,0.))"), axes = b.add("AXIS2_PLACEMENT_3D('',#1,$,$)");
    EXPECT_EQ(origin, 1);
    b.add("DIRECTION('',(0.,0.,1.))");
    SCOPED_TRACE(c.kind);
    expect_fault(b, {b.shell({disc_on(b, b.placed(c.kind, axes, c.numbers))})},
                 c.words.ends_with('7') ? c.words.substr(0, c.words.size() - 1) : c.words);
  }
}

TEST(StepHostile, WrongTypesAndMissingInstancesAreNamed) {
  // Each attribute of a disc's instances refers to nothing, or to an instance of another kind.
  StepBuilder b;
  const int face = disc_on(b, b.placed("PLANE", b.axes({0, 0, 0})));
  const std::string text = StepBuilder(b).file({b.shell({face})});
  std::size_t models = 0, cases = 0;
  for (std::size_t at = text.find("DATA;"); (at = text.find('#', at + 1)) != std::string::npos;) {
    if (text[at - 1] == '\n') continue;
    const std::size_t end = text.find_first_not_of("0123456789", at + 1);
    for (const std::string by : {"#9999", "#1", "#4", "#5", "$", "*", "7", "(#1)", "'x'", ".T."}) {
      std::string changed = text;
      changed.replace(at, end - at, by);
      const Ending ending = ending_of(changed);
      models += ending.is_model, ++cases;
      EXPECT_TRUE(ending.is_model || ending.words.starts_with("part: ")) << ending.words;
    }
  }
  EXPECT_GT(cases, 100u);
  EXPECT_LT(models, cases / 2);
}

TEST(StepHostile, NumbersBeyondReasonEnd) {
  StepBuilder b;
  StepBuilder::Numbers faces = b.box_faces({0, 0, 0}, {1, 2, 3});
  faces.push_back(disc_on(b, b.placed("SPHERICAL_SURFACE", b.axes({0, 0, 0.5}), {2.0615528128088303})));
  faces.push_back(disc_on(b, b.placed("CYLINDRICAL_SURFACE", b.axes({0, 0, 0}), {2})));
  faces.push_back(disc_on(b, b.placed("CONICAL_SURFACE", b.axes({0, 0, 0}), {2, 0.5})));
  faces.push_back(disc_on(b, b.placed("TOROIDAL_SURFACE", b.axes({0, 0, 0}), {1.5, 0.5})));
  const std::string text = b.file({b.shell(faces)});
  const std::string digits = "0123456789.-+eE";
  std::size_t cases = 0;
  for (std::size_t at = text.find("DATA;"); (at = text.find('.', at + 1)) != std::string::npos; ++cases) {
    const std::size_t from = text.find_last_not_of(digits, at) + 1, to = text.find_first_not_of(digits, at);
    if (from >= at) continue;  // a flag
    for (const std::string by : {"0.", "-1.", "1.E308", "-1.E308", "1.E150", "1.E-150", "1.E-308", "1.E16", "1.E400"}) {
      std::string changed = text;
      changed.replace(from, to - from, by);
      ending_of(changed, 2);
    }
    at = to;
  }
  EXPECT_GT(cases, 100u);
}

TEST(StepHostile, PartsOfAnySizeAreRead) {
  for (const double size : {1e150, 1e100, 1e30, 1e-30, 1e-90, 1e-150, 1e-300}) {
    StepBuilder b;
    StepBuilder::Numbers faces = b.box_faces({0, 0, 0}, {size, 2 * size, 3 * size});
    faces.push_back(disc_on(b, b.placed("CYLINDRICAL_SURFACE", b.axes({0, 0, 0}), {size}), size));
    faces.push_back(b.face(b.placed("SPHERICAL_SURFACE", b.axes({0, 0, 0}), {size}), {b.vertex_loop({0, 0, size})}));
    const Ending ending = ending_of(b.file({b.shell(faces)}));
    const bool is_moderate = size > 1e-99 && size < 1e99;
    EXPECT_TRUE(!is_moderate || ending.surfaces >= 7) << size << ": " << ending.words;
    EXPECT_TRUE(ending.is_model || !ending.words.empty());
  }
}

TEST(StepHostile, CyclesOfEachKindAreNamed) {
  struct Case {
    std::string record, words;
  };
  // #1 is what refers to itself; it is an item, or what an item is made of.
  for (const Case& c :
       {Case{"CLOSED_SHELL('',(#1))", "of itself"}, Case{"MANIFOLD_SOLID_BREP('',#1)", "of itself"},
        Case{"BREP_WITH_VOIDS('',#1,(#1,#1,#1))", ""}, Case{"SHELL_BASED_SURFACE_MODEL('',(#1,#1,#1,#1,#1,#1,#1))", ""},
        Case{"FACE_BASED_SURFACE_MODEL('',(#1,#1,#1,#1,#1,#1,#1,#1,#1,#1,#1,#1))", ""},
        Case{"GEOMETRIC_SET('',(#1,#1))", "no surfaces"}, Case{"ORIENTED_CLOSED_SHELL('',*,#1,.T.)", "of itself"},
        Case{"ORIENTED_FACE('',*,#1,.F.)", "of itself"}, Case{"ADVANCED_FACE('',(#1),#1,.T.)", "expected FACE_BOUND"},
        Case{"OPEN_SHELL('',(#1,#1,#1,#1,#1,#1,#1,#1,#1,#1))", ""}}) {
    StepBuilder b;
    b.add(c.record);
    const Ending ending = ending_of(b.file({1}));
    EXPECT_FALSE(ending.is_model) << c.record;
    EXPECT_NE(ending.words.find(c.words), std::string::npos) << ending.words;
  }
  for (const std::string record :
       {"RECTANGULAR_TRIMMED_SURFACE('',#1,0.,1.,0.,1.,.T.,.T.)",
        "OFFSET_SURFACE('',#1,1.,.F.)",
        "SURFACE_OF_REVOLUTION('',#1,#1)",
        "SURFACE_OF_LINEAR_EXTRUSION('',#1,#1)",
        "PLANE('',#1)",
        "TRIMMED_CURVE('',#1,(#1),(#1),.T.,.CARTESIAN.)",
        "SURFACE_CURVE('',#1,(#1),.CURVE_3D.)",
        "SEAM_CURVE('',#1,(#1,#1),.CURVE_3D.)",
        "CIRCLE('',#1,2.)",
        "LINE('',#1,#1)",
        "VECTOR('',#1,1.)",
        "AXIS2_PLACEMENT_3D('',#1,#1,#1)",
        "POLYLINE('',(#1,#1))",
        "B_SPLINE_CURVE_WITH_KNOTS('',1,(#1,#1),.UNSPECIFIED.,.F.,.F.,(2,2),(0.,1.),.UNSPECIFIED.)",
        "VERTEX_POINT('',#1)",
        "EDGE_CURVE('',#1,#1,#1,.T.)",
        "ORIENTED_EDGE('',*,*,#1,.T.)",
        "EDGE_LOOP('',(#1))",
        "VERTEX_LOOP('',#1)",
        "POLY_LOOP('',(#1,#1,#1))",
        "FACE_BOUND('',#1,.T.)",
        "DIRECTION('',(#1))",
        "CARTESIAN_POINT('',(#1))"}) {
    // It stands for the surface, the curve, the edge, the loop, the bound and the vertex of a face.
    for (int role = 0; role < 6; ++role) {
      StepBuilder b;
      b.add(record);
      const int plane = role == 0 ? 1 : b.placed("PLANE", b.axes({0, 0, 0}));
      const int curve = role == 1 ? 1 : b.placed("CIRCLE", b.axes({0, 0, 0}), {2});
      const std::string vertex = b.ref_of(role == 5 ? 1 : b.vertex({2, 0, 0}));
      const int edge =
          role == 2 ? 1 : b.add("EDGE_CURVE(''," + vertex + "," + vertex + "," + b.ref_of(curve) + ",.T.)");
      const int loop = role == 3 ? 1 : b.loop({edge}), bound = role == 4 ? 1 : b.bound(loop);
      const Ending ending = ending_of(b.file({b.shell({b.face_of(plane, {bound})})}));
      EXPECT_FALSE(ending.is_model && ending.words.empty()) << record << " as " << role;
    }
  }
}

TEST(StepHostile, WholesInWholesDoNotGrow) {
  // Twelve levels of models, each of which lists the next one 40 times; and a shell that is used 100,000 times.
  StepBuilder b;
  const int level = 40;
  int below = b.shell(b.box_faces({0, 0, 0}, {1, 1, 1}));
  for (int k = 0; k < 12; ++k)
    below = b.add("SHELL_BASED_SURFACE_MODEL(''," + b.list(StepBuilder::Numbers(level, below)) + ")");
  const Ending deep = ending_of(b.file({below}));
  EXPECT_NE(deep.words.find("holds the same faces too often"), std::string::npos) << deep.words;
  EXPECT_LT(deep.surfaces, 1000u);
  StepBuilder c;
  const int shell = c.shell(c.box_faces({0, 0, 0}, {1, 1, 1}));
  const int model = c.add("SHELL_BASED_SURFACE_MODEL(''," + c.list(StepBuilder::Numbers(100000, shell)) + ")");
  const Ending wide = ending_of(c.file({model}));
  EXPECT_NE(wide.words.find("holds the same faces too often"), std::string::npos) << wide.words;
  EXPECT_LT(wide.surfaces, 1000u);
}

TEST(StepHostile, SharedLoopsAndSurfacesDoNotGrow) {
  // 1000 faces with one loop of 1000 edges.
  StepBuilder b;
  std::vector<Vec3> corners;
  for (int k = 0; k < 1000; ++k) corners.push_back({std::cos(0.006 * k), std::sin(0.006 * k), 0});
  const int loop = b.bound(b.polygon_loop(corners)), plane = b.placed("PLANE", b.axes({0, 0, 0}));
  StepBuilder::Numbers faces;
  for (int k = 0; k < 1000; ++k) faces.push_back(b.face_of(plane, {loop}));
  expect_refused(read_step(b.file({b.shell(faces)}), "part"), StatusCode::unsupported, Status::no_index,
                 "part: the loops of a part list more than");
  // 2000 faces without bounds on one surface of 3600 control points.
  StepBuilder c;
  std::string rows;
  for (int i = 0; i < 60; ++i) {
    StepBuilder::Numbers row;
    for (int j = 0; j < 60; ++j) row.push_back(c.point({1.0 * i, 1.0 * j, 0.1 * (i * j % 7)}));
    rows += (rows.empty() ? "(" : ",") + c.list(row);
  }
  const int surface = c.add("UNIFORM_SURFACE('',1,1," + rows + "),.UNSPECIFIED.,.F.,.F.,.F.)");
  StepBuilder::Numbers bare;
  for (int k = 0; k < 2000; ++k) bare.push_back(c.face_of(surface, {}));
  expect_refused(read_step(c.file({c.shell(bare)}), "part"), StatusCode::unsupported, Status::no_index,
                 "part: the surfaces of a part have more than");
}

TEST(StepHostile, OneShapeInManyPartsDoesNotGrow) {
  // 300 representations of one box, which each has 100 times.
  StepBuilder b;
  const int context = b.add("GEOMETRIC_REPRESENTATION_CONTEXT('','',3)"),
            shell = b.shell(b.box_faces({0, 0, 0}, {1, 1, 1}));
  const int shells = b.add("SHELL_BASED_SURFACE_MODEL(''," + b.list(StepBuilder::Numbers(100, shell)) + ")");
  for (int k = 0; k < 300; ++k) {
    const std::string shape =
        b.ref_of(b.add("SHAPE_REPRESENTATION(''," + b.list({shells}) + "," + b.ref_of(context) + ")"));
    const int product = b.add("PRODUCT_DEFINITION('','',$,$)");
    const int whole = b.add("PRODUCT_DEFINITION_SHAPE('',''," + b.ref_of(product) + ")");
    b.add("SHAPE_DEFINITION_REPRESENTATION(" + b.ref_of(whole) + "," + shape + ")");
  }
  expect_refused(read_step(b.whole(), "part"), StatusCode::unsupported, Status::no_index,
                 "but its parts have more than");
}

TEST(StepHostile, CountsAndDepthsBeyondReasonEnd) {
  for (const std::string knots :
       {"(1000000000,1000000000),(0.,1.)", "(2147483648,2),(0.,1.)", "(-2,6),(0.,1.)", "(2,2),(1.,0.)", "(2,2),(0.,0.)",
        "(2,2),(0.)", "(2,2),()", "(1,3),(0.,1.)", "(2,2),(0.,1.E308)", "(2,2),(-1.E308,1.E308)", "(0,4),(0.,1.)"}) {
    StepBuilder b;
    const int curve = b.add("B_SPLINE_CURVE_WITH_KNOTS('',1," + b.list(b.points({{0, 0, 0}, {1, 0, 0}})) +
                            ",.UNSPECIFIED.,.F.,.F.," + knots + ",.UNSPECIFIED.)");
    const int edge = b.edge({0, 0, 0}, {1, 0, 0}, curve);
    const int back = b.straight({1, 0, 0}, {0, 1, 0}), last = b.straight({0, 1, 0}, {0, 0, 0});
    const Ending ending =
        ending_of(b.file({b.shell({b.flat({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {b.loop({edge, back, last})})})}));
    EXPECT_TRUE(!ending.words.empty() || knots.find("E308") != std::string::npos) << knots;
  }
  for (const std::size_t depth : {std::size_t{100000}, std::size_t{1000000}}) {
    StepBuilder b;
    b.add("PLANE(''," + std::string(depth, '(') + std::string(depth, ')') + ")");
    b.add("PLANE(''," + std::string(depth, '('));
    EXPECT_FALSE(ending_of(b.file({b.shell({b.face(1, {})}), b.shell({b.face(2, {})})})).is_model);
  }
  // 100,000 trimmed curves, each of the next one.
  StepBuilder b;
  for (int k = 1; k < 100000; ++k)
    b.add("TRIMMED_CURVE('',#" + std::to_string(k + 1) +
          ",(PARAMETER_VALUE(0.)),(PARAMETER_VALUE(1.)),.T.,.PARAMETER.)");
  b.placed("CIRCLE", b.axes({0, 0, 0}), {2});
  const int edge = b.edge({2, 0, 0}, {2, 0, 0}, 1);
  const Ending ending = ending_of(b.file({b.shell({b.flat({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {b.loop({edge})})})}));
  EXPECT_FALSE(ending.is_model);
  EXPECT_NE(ending.words.find(" in line "), std::string::npos) << ending.words;
}

TEST(StepHostile, LoopsThatAreNoneAreNamed) {
  StepBuilder b;
  const auto flat = [&](int loop) { return b.shell({b.flat({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {loop})}); };
  ending_of(StepBuilder(b).file({flat(b.add("EDGE_LOOP('',())"))}));
  const Vec3 o{0, 0, 0}, x{1, 0, 0}, y{0, 1, 0};
  // Loops that do not close, or go on and back; edges far from their curves.
  const int open = b.loop({b.straight(o, x), b.straight(x, y)}), back = b.loop({b.straight(o, x), -b.straight(o, x)});
  const int far = b.loop({b.edge({100, 100, 100}, {-100, 50, 7}, b.placed("CIRCLE", b.axes({0, 0, 0}), {1})),
                          b.edge({-100, 50, 7}, {100, 100, 100}, b.line(o, x))});
  for (const int loop : {open, back, far}) {
    const Ending ending = ending_of(StepBuilder(b).file({flat(loop)}));
    EXPECT_FALSE(ending.words.empty()) << loop;
  }
  for (const std::string kind : {"SPHERICAL_SURFACE", "CYLINDRICAL_SURFACE"})
    for (const int loop : {open, back, far}) {
      StepBuilder part = b;
      const int face = part.face(part.placed(kind, part.axes(o), {1}), {loop});
      ending_of(part.file({part.shell({face})}));
    }
}

TEST(StepHostile, UnitsOfNothingAreNamed) {
  for (const std::string size : {"0.", "-1.", "1.E400", "1.E308", "1.E-320", "$", "'x'"}) {
    StepBuilder b;
    const int metre = b.add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT($,.METRE.))");
    const int measure = b.add("LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(" + size + ")," + b.ref_of(metre) + ")");
    const int unit = b.add("(CONVERSION_BASED_UNIT('X'," + b.ref_of(measure) + ")LENGTH_UNIT()NAMED_UNIT($))");
    const int solid = b.solid(b.box_faces({0, 0, 0}, {1, 1, 1}));
    const Ending ending = ending_of(b.file({solid}, {unit}));
    EXPECT_FALSE(ending.is_model && ending.words.empty()) << size;
  }
}

TEST(StepHostile, TruncatedTextsEnd) {
  StepBuilder b;
  StepBuilder::Numbers faces = b.box_faces({0, 0, 0}, {1, 2, 3});
  faces.push_back(disc_on(b, b.placed("SPHERICAL_SURFACE", b.axes({0, 0, 0}), {2})));
  const std::string text = b.file({b.shell(faces)});
  for (std::size_t length = 0; length < text.size(); length += 97) ending_of(text.substr(0, length));
}

}}  // namespace tessera::test
