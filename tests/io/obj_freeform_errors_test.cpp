// Free-form OBJ files that are wrong: their errors, and no other harm.

#include <algorithm>

#include "io/obj_samples.h"
#include "support/allocations.h"

namespace tessera { namespace {

using namespace test;

std::string freeform_error(std::string_view text) {
  const Result<Model> model = parse_obj_freeform(text, "m.obj");
  EXPECT_FALSE(model.ok()) << text;
  return model.status().message();
}

/// Four vertices, the bilinear patch, and `from` in it replaced by `to`.
std::string spoiled(const std::string& from, const std::string& to, std::string text = four_vertices + bilinear) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(ObjFreeformErrors, SyntaxIsNamedWithItsLine) {
  EXPECT_EQ(
      freeform_error(spoiled("v 1 0 0", "v 1 0")),
      "m.obj:2: expected 3 finite coordinates after v, perhaps a weight and a colour of 3, found the end of the line");
  EXPECT_EQ(
      freeform_error(spoiled("v 1 0 0", "v 1 0 0 1 1")),
      "m.obj:2: expected 3 finite coordinates after v, perhaps a weight and a colour of 3, found the end of the line");
  EXPECT_EQ(freeform_error(spoiled("v 1 0 0", "v 1 0 0 1 1 1 1 1")),
            "m.obj:2: expected the end of the line, found \"1\"");
  EXPECT_EQ(freeform_error(spoiled("v 1 0 0", "vp 1 2 3 4")), "m.obj:2: expected the end of the line, found \"4\"");
  EXPECT_EQ(freeform_error(spoiled("bezier", "rat nurbs")),
            "m.obj:5: expected bezier, bspline, cardinal, taylor or bmatrix after cstype, perhaps with rat before it, "
            "found \"nurbs\"");
  EXPECT_EQ(freeform_error(spoiled("deg 1 1", "deg 1.5 1")),
            "m.obj:6: expected 1 or 2 degrees after deg, found \"1.5\"");
  EXPECT_EQ(freeform_error(spoiled("deg 1 1", "step")),
            "m.obj:6: expected 1 or 2 steps after step, found the end of the line");
  EXPECT_EQ(freeform_error(spoiled("parm u 0 1", "parm w 0 1")), "m.obj:8: expected u or v after parm, found \"w\"");
  EXPECT_EQ(freeform_error(spoiled("parm u 0 1", "parm u 0 1,5")),
            "m.obj:8: expected finite numbers after parm u, found \"1,5\"");
  EXPECT_EQ(freeform_error(spoiled("parm u 0 1", "parm u")),
            "m.obj:8: expected numbers after parm u, found the end of the line");
  EXPECT_EQ(freeform_error(spoiled("surf 0 1 0 1 1 2 3 4", "surf 0 1 0")),
            "m.obj:7: expected 4 finite numbers after surf, the ranges of u and v, found the end of the line");
  EXPECT_EQ(freeform_error(spoiled("surf 0 1 0 1 1 2 3 4", "surf 0 1 0 1 1")),
            "m.obj:7: expected at least 2 control points, found the end of the line");
  // A malformed continuation, as the specification's own example of stech prints it.
  EXPECT_EQ(freeform_error(spoiled("1 2 3 4", "1 2 \\ 3 4")),
            "m.obj:7: expected an index of a control point, found \"\\\"");
  EXPECT_EQ(freeform_error(spoiled("deg 1 1", "1 1")),
            "m.obj:6: expected a statement (is the line above to be continued, without a \\ at its end?), found \"1\"");
  EXPECT_EQ(freeform_error(std::string("\0\x01v 1 2 3\n", 9)),
            "m.obj:1: expected a statement (is the line above to be continued, without a \\ at its end?), found "
            "\"\\x00\\x01v\"");
}

TEST(ObjFreeformErrors, ReferencesStayWithinWhatStandsAbove) {
  const std::string vertices = "an index into the vertices above, 1 to 4 or -4 to -1";
  for (const char* index : {"0", "5", "-5", "9223372036854775807", "-9223372036854775808"})
    EXPECT_EQ(freeform_error(spoiled("2 3 4", std::string("2 3 ") + index)),
              "m.obj:7: expected " + vertices + ", found \"" + index + "\"");
  for (const char* index : {"x", "1.0", "99999999999999999999", "/1"}) {
    const std::string message = freeform_error(spoiled("2 3 4", std::string("2 3 ") + index));
    EXPECT_EQ(message.rfind("m.obj:7: expected an index of a control point, found", 0), 0u) << message;
  }
  EXPECT_EQ(freeform_error(spoiled("2 3 4", "2 3 4/1")),
            "m.obj:7: expected no index, as there are no vt lines above, found \"1\"");
  EXPECT_EQ(freeform_error(spoiled("2 3 4", "2 3 4//1")),
            "m.obj:7: expected no index, as there are no vn lines above, found \"1\"");
  EXPECT_EQ(freeform_error(spoiled("2 3 4", "2 3 4/")),
            "m.obj:7: expected an index of a texture vertex, found the end of the line");
  EXPECT_EQ(freeform_error("cstype bezier\ndeg 1 1\n" + bilinear)
                .rfind("m.obj:5: expected no index, as there are no vertices", 0),
            0u);
}

TEST(ObjFreeformErrors, SurfacesThatDoNotFitAreNamed) {
  const auto surface = [](const std::string& from, const std::string& to) {
    return freeform_error("g a\n" + spoiled(from, to));
  };
  const std::string place = "m.obj:8: surface 0 (a): ";
  EXPECT_EQ(surface("cstype bezier", "#"), place + "there is no cstype above");
  EXPECT_EQ(surface("deg 1 1", "#"), place + "there is no deg for u above");
  EXPECT_EQ(surface("deg 1 1", "deg 1"), place + "there is no deg for v above");
  EXPECT_EQ(surface("deg 1 1", "deg 1 16"), place + "the degree along v is 16, it must be 1 to 15");
  EXPECT_EQ(surface("deg 1 1", "deg 0 1"), place + "the degree along u is 0, it must be 1 to 15");
  EXPECT_EQ(surface("deg 1 1", "deg 2 2"), place + "its parameters and degrees need 3 x 3 control points, found 4");
  EXPECT_EQ(surface("parm u 0 1", ""), "m.obj:8: surface 0 (a): parm u is missing");
  EXPECT_EQ(surface("parm v 0 1", ""), "m.obj:8: surface 0 (a): parm v is missing");
  EXPECT_EQ(surface("parm u 0 1", "parm u 1"), place + "parm u has 1 value, at least 2 are needed");
  EXPECT_EQ(surface("parm u 0 1", "parm u 1 1"), place + "parm u does not increase: 1 follows 1");
  EXPECT_EQ(surface("surf 0 1 0 1", "surf 1 1 0 1"), place + "the range from 1 to 1 along u is empty");
  EXPECT_EQ(surface("surf 0 1 0 1", "surf 0 1 0 1.5"),
            place + "the range from 0 to 1.5 along v exceeds parm v, which runs from 0 to 1");
  EXPECT_EQ(surface("cstype bezier", "cstype bspline"),
            place + "parm u has 2 values, a B-spline of degree 1 needs at least 4 knots");
  EXPECT_EQ(surface("cstype bezier", "cstype bmatrix"), place + "there is no step for u above");
  EXPECT_EQ(surface("cstype bezier", "cstype bmatrix\nstep 0 1"),
            "m.obj:9: surface 0 (a): the step along u is 0, it must be at least 1");
  EXPECT_EQ(surface("cstype bezier", "cstype bmatrix\nstep 1 1"), "m.obj:9: surface 0 (a): there is no bmat u above");
  EXPECT_EQ(surface("cstype bezier", "cstype bmatrix\nstep 1 1\nbmat u 1 2"),
            "m.obj:10: surface 0 (a): bmat u has 2 entries, degree 1 needs 4");
  EXPECT_EQ(surface("parm u 0 1", "parm u 0 1 2\ncstype bmatrix\nbmat u 1 0 0 1\nstep 9000000000000000000 1"),
            place +
                "parm u has 3 values and the step is 9000000000000000000: they need more than the 4 control points "
                "found");
}

TEST(ObjFreeformErrors, TheKindsOwnErrorsKeepTheirCode) {
  const auto code = [](const std::string& text) { return parse_obj_freeform(text, "m.obj").status(); };
  const std::string rational = spoiled("cstype", "cstype rat");
  for (const char* weight : {"0", "-1"}) {
    const Status status = code(spoiled("v 1 0 0", std::string("v 1 0 0 ") + weight, rational));
    EXPECT_EQ(status.code(), StatusCode::invalid_weight);
    EXPECT_EQ(status.message().rfind("m.obj:7: surface 0: ", 0), 0u) << status.message();
  }
  const std::string spline = spoiled("bezier", "bspline", spoiled("parm v 0 1", "parm v 0 0 1 1"));
  EXPECT_EQ(code(spoiled("parm u 0 1", "parm u 0 1 0 1", spline)).code(), StatusCode::invalid_argument);
  EXPECT_EQ(code(spoiled("parm u 0 1", "parm u 0 0 0 1", spline)).code(), StatusCode::invalid_argument);
  EXPECT_EQ(code(spoiled("parm u 0 1", "parm u 0 0 1 1", spoiled("surf 0 1", "surf 0 2", spline))).code(),
            StatusCode::invalid_argument);
  // One wrong element: no model at all.
  EXPECT_EQ(code(four_vertices + bilinear + spoiled("parm u 0 1", "parm u 2 1", bilinear)).index(), 1);
}

TEST(ObjFreeformErrors, BodiesAreClosedAndNothingBelongsNowhere) {
  EXPECT_EQ(freeform_error(spoiled("end\n", "")), "m.obj:7: the file ends within this surf: it has no end statement");
  EXPECT_EQ(freeform_error(spoiled("end\n", bilinear)),
            "m.obj:7: this surf has no end statement before the next element");
  EXPECT_EQ(freeform_error(four_vertices + "end\n"), "m.obj:5: this end has no surf, curv or curv2 above");
  EXPECT_EQ(freeform_error(four_vertices + "trim 0 1 1\n"), "m.obj:5: a trim belongs between a surf and its end");
  EXPECT_EQ(freeform_error(four_vertices + bilinear + "hole 0 1 1\n"),
            "m.obj:11: a hole belongs between a surf and its end");
}

TEST(ObjFreeformErrors, TrimsReferToCurvesAboveAndStayOnThem) {
  const std::string curve = "vp 0.2 0.2\nvp 0.8 0.2\nvp 3\ncstype bezier\ndeg 1\ncurv2 1 2\nparm u 0 1\nend\n";
  const auto trimmed = [&](const std::string& trim) {
    return freeform_error(four_vertices + curve + bilinear.substr(0, bilinear.size() - 4) + trim + "\nend\n");
  };
  EXPECT_EQ(trimmed("trim 0 1 2"),
            "m.obj:18: expected an index into the curv2 elements above, 1 to 1 or -1 to -1, found \"2\"");
  EXPECT_EQ(trimmed("trim 0 1"), "m.obj:18: expected an index of a curv2, found the end of the line");
  EXPECT_EQ(trimmed("trim"), "m.obj:18: expected the parameter where the curve begins, found the end of the line");
  EXPECT_EQ(trimmed("trim 0 nan 1"), "m.obj:18: expected the parameter where the curve ends, found \"nan\"");
  EXPECT_EQ(trimmed("trim 0 1 1 0 2 1"), "m.obj:18: curv2 1 runs from 0 to 1, it has no part from 0 to 2");
  EXPECT_EQ(trimmed("trim 0.5 0.5 1"), "m.obj:18: curv2 1 runs from 0 to 1, it has no part from 0.5 to 0.5");
  EXPECT_EQ(freeform_error(spoiled("curv2 1 2", "curv2 1 3", curve)),
            "m.obj:6: expected the index of a vp line with 2 coordinates, found \"3\"");
  EXPECT_EQ(freeform_error(spoiled("parm u 0 1", "parm u 0 1 2", curve)),
            "m.obj:6: curv2 1: its parameters and degree need 3 control points, found 2");
  EXPECT_EQ(freeform_error(spoiled("parm u 0 1", "", curve)), "m.obj:6: curv2 1: parm u is missing");
}

TEST(ObjFreeformErrors, NumbersThatAreNotFiniteAreErrorsWithTheirLine) {
  for (const char* bad : {"nan", "-nan", "inf", "-Infinity", "1e400", "-1e400", "0x1p3"}) {
    EXPECT_EQ(freeform_error(spoiled("v 1 0 0", std::string("v 1 0 ") + bad)).rfind("m.obj:2: expected 3 finite", 0),
              0u);
    EXPECT_EQ(freeform_error(spoiled("surf 0 1 0 1", std::string("surf 0 1 0 ") + bad))
                  .rfind("m.obj:7: expected 4 finite", 0),
              0u);
    EXPECT_EQ(
        freeform_error(spoiled("parm u 0 1", std::string("parm u 0 ") + bad)).rfind("m.obj:8: expected finite", 0), 0u);
  }
  const Model large = model_of(spoiled("v 1 1 1", "v 1e300 -1e300 1e300"));  // any finite number will do
  EXPECT_EQ(large.surfaces.size(), 1u);
}

TEST(ObjFreeformErrors, ATruncatedModelIsRefusedOrTheBeginOfIt) {
  for (const std::string& text : small_models()) {
    const std::size_t surfaces = model_of(text).surfaces.size();
    const std::size_t whole_at = text.rfind("end") == std::string::npos ? text.rfind("bzp") : text.rfind("end") + 3;
    for (std::size_t bytes = 0; bytes < text.size(); ++bytes) {
      const Result<Model> cut = parse_obj_freeform(std::string_view(text).substr(0, bytes), "m.obj");
      if (bytes < whole_at) {
        ASSERT_FALSE(cut.ok()) << text.substr(0, bytes);
      }
      if (cut.ok()) {
        EXPECT_EQ(cut->surfaces.size(), surfaces);
      }
    }
  }
}

TEST(ObjFreeformErrors, SpoiledBytesNeverCrash) {
  Random random(11);
  for (const std::string& text : small_models()) {
    for (int k = 0; k < 400; ++k) {
      std::string bytes = text;
      for (int n = 0; n < 3; ++n) bytes[random() % bytes.size()] = static_cast<char>(random());
      const Result<Model> model = parse_obj_freeform(bytes, "m.obj");
      if (model) {
        EXPECT_TRUE(std::ranges::all_of(model->surfaces, [](const ModelSurface& s) {
          const Domain d = domain(s.surface);
          return evaluate_jet(s.surface, d.u_at(0.5), d.v_at(0.5)).ok();
        }));
      } else {
        EXPECT_FALSE(model.status().message().empty());
      }
    }
  }
}

/// The most bytes that reading allocates.
std::size_t memory_of(const std::string& text, Result<Model> (*parse)(std::string_view, std::string_view)) {
  const std::size_t before = restart_peak();
  const Result<Model> model = parse(text, "m");
  EXPECT_TRUE(model.ok() || model.status().code() != StatusCode::out_of_memory);
  return peak_bytes() - before;
}

TEST(ObjFreeformErrors, SmallFilesCannotAskForMuchMemory) {
  const std::string many = " 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1";
  std::string points, parm, trims;
  for (int k = 0; k < 64; ++k) points += many;
  for (int k = 0; k < 1000; ++k) parm += " " + std::to_string(k);
  for (int k = 0; k < 2000; ++k) trims += " 0 1 1";
  std::string ones;
  for (int k = 0; k < 512; ++k) ones += " 1";
  const std::string matrix = "deg 15 15\nstep 1 1\nbmat u" + ones.substr(512) + ones.substr(512) + "\nbmat v" +
                             ones.substr(512) + ones.substr(512) + "\n";
  const std::vector<std::string> hostile{
      "v 0 0 0\ncstype bmatrix\n" + matrix + "surf 0 9 0 9" + points +
          "\nparm u 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17\n" +
          "parm v 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17\nend\n",
      "v 0 0 0\ncstype bspline\ndeg 3 3\nsurf 0 1 0 1 1 1\nparm u" + parm + "\nparm v" + parm + "\nend\n",
      four_vertices + "vp 0 0\ncstype bezier\ndeg 15\ncurv2" + points.substr(0, 2 * 1006) + "\nparm u" +
          parm.substr(0, 275) + "\nend\n" + bilinear.substr(0, bilinear.size() - 4) + "trim" + trims + "\nend\n",
      "99999999999\n1 1\n",
  };
  for (const std::string& text : hostile)
    for (const auto parse : {&parse_obj_freeform, &parse_bpt})
      EXPECT_LE(memory_of(text, parse), 2000 * text.size() + 100000) << text.substr(0, 60);
}

}}  // namespace tessera
