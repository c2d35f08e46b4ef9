// Errors of the reader of .json models: the file, the line, the place, what it found and what it expected.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <random>

#include "io/model_text.h"
#include "support/scratch_folder.h"

namespace tessera::test { namespace {

std::string json_error(std::string_view text, StatusCode code = StatusCode::parse_error) {
  const Result<Model> model = parse_json_model(text, "m.json");
  EXPECT_FALSE(model.ok()) << text.substr(0, 300);
  if (model.ok()) return {};
  EXPECT_EQ(model.status().code(), code) << model.status().message();
  return model.status().message();
}
/// The error of a model of this one surface, which stands on line 2.
std::string error_in(const std::string& surface, StatusCode code = StatusCode::parse_error) {
  return json_error(json_with(surface), code);
}
void expect_begin(const std::string& message, const std::string& begin) {
  EXPECT_EQ(message.substr(0, begin.size()), begin) << message;
}
void expect_words(const std::string& message, const std::string& words) {
  EXPECT_NE(message.find(words), std::string::npos) << message;
}

const std::string json_square = R"("points": [[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]])";

TEST(JsonErrors, TextsThatAreNoJson) {
  expect_begin(json_error(""), "m.json:1: ");
  expect_words(json_error(""), "unexpected end of input");
  expect_begin(json_error(" \n\n"), "m.json:2: ");
  expect_begin(json_error("{\n\"format\": \"tessera\",\n\"version\" 1}"), "m.json:3: ");
  expect_words(json_error("{\n\"a\": 1,\n}"), "m.json:3: ");
  expect_words(json_error("{\"a\": [1, 2}"), "unexpected '}'");
  expect_words(json_error("{\"a\": nan}"), "last read: \"");
  expect_words(json_error("{} {}"), "m.json:1: ");
  expect_words(json_error("{\"a\":\n1e400}"), "m.json:2: number overflow");
  expect_words(json_error("{\"a\": \"\xff\"}"), "ill-formed UTF-8");
  expect_words(json_error("{\"a\": \"tab\t\"}"), "control character");
  expect_words(json_error("// no comments\n{}"), "m.json:1: ");
  for (const char c : json_error("{\"\x01\xfe\": 1}")) EXPECT_TRUE(c >= 0x20 && c < 0x7f);
}

TEST(JsonErrors, TextsThatAreNoModels) {
  EXPECT_EQ(json_error("[1, 2]"), "m.json:1: expected an object, found an array of 2");
  EXPECT_EQ(json_error("null"), "m.json:1: expected an object, found null");
  EXPECT_EQ(json_error("{}"), "m.json:1: \"format\" is missing");
  EXPECT_EQ(json_error("{\"format\":\n\"other\", \"version\": 1, \"surfaces\": []}"),
            "m.json:2: /format: expected \"tessera\", found \"other\"");
  EXPECT_EQ(json_error(R"({"format": "tessera", "surfaces": []})"), "m.json:1: \"version\" is missing");
  EXPECT_EQ(json_error(R"({"format": "tessera", "version": 2, "surfaces": []})", StatusCode::unsupported),
            "m.json:1: /version: found version 2, this reader knows version 1");
  EXPECT_EQ(json_error(R"({"format": "tessera", "version": "1", "surfaces": []})"),
            "m.json:1: /version: expected an integer from 1 to 1048576, found \"1\"");
  EXPECT_EQ(json_error(R"({"format": "tessera", "version": 1, "surfaces": []})"),
            "m.json:1: /surfaces: expected an array of surfaces, found an empty array");
  EXPECT_EQ(json_error(R"({"format": "tessera", "version": 1, "surface": []})"),
            "m.json:1: unknown key \"surface\"; known keys are format, version, description, surfaces");
  EXPECT_EQ(error_in("3"), "m.json:2: /surfaces/0: expected a surface, found 3");
  EXPECT_EQ(error_in("{}"), "m.json:2: /surfaces/0: \"kind\" is missing");
  expect_begin(error_in(R"({"kind": "bezir"})"), "m.json:2: /surfaces/0/kind: expected one of bezier, tensor, ");
  expect_words(error_in(R"({"kind": "bezir"})"), ", parametric, found \"bezir\"");
}

TEST(JsonErrors, LinesArePlacesOfTheValue) {
  // A number ends at the byte behind it, even if that ends the line.
  const std::string head = "{\"format\": \"tessera\",\n\"version\": 1,\n\"surfaces\": [\n";
  EXPECT_EQ(json_error(head + "7\n\n\n]}"), "m.json:4: /surfaces/0: expected a surface, found 7");
  EXPECT_EQ(json_error(head + "\n7]}"), "m.json:5: /surfaces/0: expected a surface, found 7");
  EXPECT_EQ(json_error(head + "true\n]}"), "m.json:4: /surfaces/0: expected a surface, found true");
  EXPECT_EQ(json_error(head + "\"x\"\n]}"), "m.json:4: /surfaces/0: expected a surface, found \"x\"");
  EXPECT_EQ(json_error(head + "[\n]\n]}"), "m.json:4: /surfaces/0: expected a surface, found an empty array");
  EXPECT_EQ(json_error(head + "{\"kind\": \"bezier\", \"points\": [[[0,0,0],\n[0,1,\nnull]],\n[[1,0,0],[1,1,0]]]}]}"),
            "m.json:6: /surfaces/0/points/0/1/2: expected a number, found null");
}

TEST(JsonErrors, KeysAreKnownAndStandOnce) {
  EXPECT_EQ(error_in(surface_of("bezier", json_square + R"(, "wieghts": [])")),
            "m.json:2: /surfaces/0: unknown key \"wieghts\"; known keys are kind, name, description, placement, trims, "
            "degree, points, weights");
  EXPECT_EQ(json_error("{\"version\": 1,\n\"format\": 2,\n\"version\": 3}"),
            "m.json:3: the key \"version\" occurs twice in one object");
  expect_words(error_in(surface_of("bezier", json_square + ",\n" + json_square)),
               "m.json:3: the key \"points\" occurs twice");
  expect_words(error_in(surface_of("sphere", R"("radius": 1, "axis": {"dir": [0,0,1]})")),
               "/surfaces/0/axis: unknown key \"dir\"; known keys are origin, direction, zero");
}

TEST(JsonErrors, ShapesOfNets) {
  EXPECT_EQ(error_in(surface_of("bezier", "")), "m.json:2: /surfaces/0: \"points\" is missing");
  EXPECT_EQ(error_in(surface_of("bezier", R"("points": [[[0,0,0],[0,1,0]],[[1,0,0]]])")),
            "m.json:2: /surfaces/0/points/1: row 1 has 1 points, row 0 has 2");
  EXPECT_EQ(error_in(surface_of("bezier", R"("points": [[[0,0,0],[0,1]],[[1,0,0],[1,1,0]]])")),
            "m.json:2: /surfaces/0/points/0/1: expected 3 numbers [x, y, z], found an array of 2");
  EXPECT_EQ(error_in(surface_of("bezier", R"("points": [[[0,0,0],[0,1,0]],[]])")),
            "m.json:2: /surfaces/0/points/1: expected a row of points, found an empty array");
  EXPECT_EQ(error_in(surface_of("bezier", R"("points": {"a": 1})")),
            "m.json:2: /surfaces/0/points: expected rows of points, found an object");
  EXPECT_EQ(error_in(surface_of("bezier", json_square + R"(, "weights": [[1,1]])")),
            "m.json:2: /surfaces/0/weights: expected 2 x 2, one per point, found 1 x 2");
  EXPECT_EQ(error_in(surface_of("bezier", json_square + R"(, "degree": [1, 2])")),
            "m.json:2: /surfaces/0/degree/1: the net is one of degree [1, 1]");
  expect_begin(error_in(surface_of("bezier", R"("points": [[[0,0,0],[0,1,0]]])"), StatusCode::unsupported_degree),
               "m.json:2: /surfaces/0: ");
  expect_words(error_in(surface_of("hermite", R"("geometry": [[[0,0,0]]])")), "expected 4 x 4");
  expect_words(error_in(surface_of("ferguson", R"("corners": [[{"position": [0,0,0], "du": [1,0,0]}]])")),
               "/surfaces/0/corners/0/0: \"dv\" is missing");
  expect_words(error_in(surface_of("tensor", R"("basis": [[1,0,0],[0,1,0]], "geometry": [[[0,0,0],[1,0,0]]])")),
               "/surfaces/0/basis: expected 1 x 1");
}

TEST(JsonErrors, WhatTheKindsRefuseHasItsPlace) {
  expect_begin(
      error_in(surface_of("bezier", json_square + R"(, "weights": [[1,1],[0,1]])"), StatusCode::invalid_weight),
      "m.json:2: /surfaces/0: ");
  expect_begin(error_in(surface_of("sphere", R"("radius": -1)"), StatusCode::invalid_argument),
               "m.json:2: /surfaces/0: ");
  expect_words(
      error_in(surface_of("b_spline", R"("degree": 1, "knots_u": [0,0,1,1], "knots_v": [0,0,1], )" + json_square)),
      "/surfaces/0/knots_v: expected 4 knots, for 2 columns of points and degree 1, found 3");
  expect_begin(
      error_in(surface_of("b_spline", R"("degree": 1, "knots_u": [0,1,0,1], "knots_v": "clamped", )" + json_square),
               StatusCode::invalid_argument),
      "m.json:2: /surfaces/0: ");
  expect_words(
      error_in(surface_of("b_spline", R"("degree": 3, "knots_u": "clamped", "knots_v": "clamped", )" + json_square)),
      "/surfaces/0/knots_u: degree 3 needs 4 points or more, found 2");
  expect_words(error_in(surface_of("b_spline", R"("degree": 16, "knots_u": [], "knots_v": [], )" + json_square)),
               "/surfaces/0/degree: expected an integer from 1 to 15, found 16");
  expect_words(error_in(surface_of("b_spline", R"("degree": 1.5, "knots_u": [], "knots_v": [], )" + json_square)),
               "found 1.5");
  expect_words(
      error_in(surface_of("nurbs", R"("degree": 1, "knots_u": "clamped", "knots_v": "clamped", )" + json_square)),
      "\"weights\" is missing");
  expect_words(
      error_in(surface_of("quadric", R"("coefficients": {"a": 1, "b": 1, "c": 1, "k": 1}, "range": [[0,1],[0,1]])"),
               StatusCode::unsupported),
      "m.json:2: /surfaces/0: ");
  expect_words(error_in(surface_of("parametric", R"("x": "u", "y": "v", "z": "0", "domain": [[0,1],[1,1]])")),
               "/surfaces/0/domain/1: the interval is empty or reversed");
  expect_words(
      error_in(surface_of("parametric", R"("x": "u", "y": "v", "z": "0", "domain": [[0,1],[0,1]], "disc": {})")),
      "not both");
  expect_words(error_in(surface_of("parametric", R"("x": "u", "y": "v", "z": "0", "disc": {"radius": 0})")),
               "/surfaces/0/disc: the radius is not positive");
}

TEST(JsonErrors, BordersAndBlends) {
  const auto line = [](const char* from, const char* to) {
    return std::string(R"({"kind": "bezier", "points": [)") + from + "," + to + "]}";
  };
  const auto coons = [&](const char* corner, const std::string& more) {
    return surface_of("coons", "\"c1\": " + line("[0,0,0]", "[1,0,0]") + ", \"c2\": " + line("[0,1,0]", corner) +
                                   ", \"d1\": " + line("[0,0,0]", "[0,1,0]") +
                                   ", \"d2\": " + line("[1,0,0]", "[1,1,0]") + more);
  };
  EXPECT_TRUE(parse_json_model(json_with(coons("[1,1,0]", "")), "m.json").ok());
  expect_begin(error_in(coons("[1,1,0.5]", ""), StatusCode::invalid_argument), "m.json:2: /surfaces/0: ");
  expect_words(error_in(coons("[1,1,0.5]", ""), StatusCode::invalid_argument), "0.5");
  expect_words(error_in(coons("[1,1,0]", R"(, "f": "quintic")")),
               "/surfaces/0/f: expected one of linear, cubic, found \"quintic\"");
  expect_words(error_in(coons("[1,1,0]", R"(, "g": {"coefficients": [[1,-1],[0,2]]})"), StatusCode::invalid_argument),
               "m.json:2: /surfaces/0/g: ");
  expect_words(error_in(coons("[1,1,0]", R"(, "g": {"expressions": ["1-t","u"]})")),
               "/surfaces/0/g/expressions/1: \"u\": ");
  expect_words(error_in(coons("[1,1,0]", R"(, "g": {"coefficients": [[1,-1]]})")), "/surfaces/0/g/coefficients: ");
  const std::string other = R"({"kind": "bezier", "points": [[0,0,0],[1,0,0]], "domain": [0, 2]})";
  expect_begin(error_in(surface_of("ruled", "\"first\": " + line("[0,0,0]", "[1,0,0]") + ", \"second\": " + other),
                        StatusCode::invalid_argument),
               "m.json:2: /surfaces/0: ");
  expect_words(error_in(surface_of("ruled", R"("first": {"kind": "arc"}, "second": 1)")),
               "/surfaces/0/first/kind: expected one of bezier, b_spline, nurbs, circle, parametric, found \"arc\"");
  expect_words(error_in(surface_of("revolution", R"("profile": {"kind": "parametric"})")),
               "/surfaces/0/profile/kind: expected one of bezier, b_spline, nurbs, circle, found \"parametric\"");
}

TEST(JsonErrors, ExpressionsNameCoordinateAndPlace) {
  const auto parametric = [](const char* z, const char* more = "") {
    return surface_of("parametric", std::string(R"("x": "u", "y": "v",)") + "\n\"z\": \"" + z + "\"" + more);
  };
  expect_begin(error_in(parametric("sin(u")), "m.json:3: /surfaces/0/z: \"sin(u\": Missing parenthesis");
  expect_begin(error_in(parametric("u + t")), "m.json:3: /surfaces/0/z: \"u + t\": ");
  EXPECT_EQ(error_in(parametric("sqrt(0.5-u)"), StatusCode::non_finite),
            "m.json:3: /surfaces/0/z: \"sqrt(0.5-u)\" is NaN at u = 0.625, v = 0");
  EXPECT_EQ(error_in(parametric("1/u", R"(, "domain": [[0, 1], [2, 3]])"), StatusCode::non_finite),
            "m.json:3: /surfaces/0/z: \"1/u\" is infinite at u = 0, v = 2");
  expect_begin(error_in(parametric("sqrt(1-u^2-v^2)", R"(, "disc": {"radius": 1.25})"), StatusCode::non_finite),
               "m.json:3: /surfaces/0/z: \"sqrt(1-u^2-v^2)\" is NaN at ");
  EXPECT_TRUE(parse_json_model(json_with(parametric("sqrt(1-u^2-v^2)", R"(, "disc": {})")), "m.json").ok());
  expect_words(error_in(surface_of("sphere", R"j("radius": "sqr(2)")j")), "/surfaces/0/radius: \"sqr(2)\": ");
  expect_words(error_in(surface_of("sphere", R"("radius": "1/0")"), StatusCode::non_finite), "is not finite");
  const std::string border = R"j({"kind": "parametric", "x": "t", "y": "0", "z": "ln(t-1/2)"})j";
  expect_words(
      error_in(surface_of("ruled", "\"first\": " + border + ", \"second\": " + border), StatusCode::non_finite),
      "/surfaces/0/first/z: \"ln(t-1/2)\" is NaN at t = 0");
}

TEST(JsonErrors, Placements) {
  const auto placed = [](const std::string& maps) {
    return surface_of("bezier", json_square + ", \"placement\": " + maps);
  };
  expect_words(error_in(placed(R"({"scale": 2})")),
               "/surfaces/0/placement: expected an array of maps, found an object");
  expect_words(error_in(placed(R"([{"scale": 2, "translate": [0,0,0]}])")), "/surfaces/0/placement/0: expected one of");
  expect_words(error_in(placed(R"([{}])")), "/surfaces/0/placement/0: expected one of");
  expect_words(error_in(placed(R"([{"scale": 1}, {"turn": 2}])")), "/surfaces/0/placement/1: unknown key \"turn\"");
  expect_words(error_in(placed(R"([{"rotate": {"axis": [0,0,0], "angle": 1}}])")), "the axis has no direction");
  expect_words(error_in(placed(R"([{"matrix": [[1,0,0],[0,1,0],[0,0,1]]}])")), "expected 3 x 4");
  expect_words(error_in(placed(R"([{"scale": 1e200}, {"scale": 1e200}])"), StatusCode::non_finite), "beyond the range");
}

TEST(JsonErrors, NestingIsLimited) {
  const std::string opened(1 << 20, '[');
  EXPECT_EQ(json_error(opened), "m.json:1: nested more than 64 deep");
  std::string objects;
  for (int k = 0; k < 100000; ++k) objects += "{\"a\":";
  EXPECT_EQ(json_error(objects), "m.json:1: nested more than 64 deep");
  EXPECT_EQ(json_error(std::string(64, '[') + std::string(64, ']')),
            "m.json:1: expected an object, found an array of 1");
}

TEST(JsonErrors, HugeListsAreRefusedInTime) {
  std::string keys = "{";
  for (int k = 0; k < 200000; ++k) keys += "\"k" + std::to_string(k) + "\":0,";
  expect_words(json_error(keys + "\"k7\":0}"), "the key \"k7\" occurs twice");
  std::string zeros = "[0";
  for (int k = 0; k < 500000; ++k) zeros += ",0";
  expect_words(error_in(surface_of("bezier", "\"points\": [" + zeros + "]]")),
               "/surfaces/0/points/0/0: expected 3 numbers [x, y, z], found 0");
  const std::string text(1 << 20, 'a');
  expect_words(error_in(surface_of("parametric", R"("x": "u", "y": "v", "z": ")" + text + "\"")),
               "longer than 4096 characters");
  EXPECT_LT(error_in("{\"kind\": \"" + text + "\"}").size(), 500u);
  EXPECT_LT(error_in("{\"kind\": \"bezier\", \"" + text + "\": 1}").size(), 500u);
}

std::vector<std::string> model_texts() {
  std::vector<std::string> texts;
  for (const auto& entry : std::filesystem::directory_iterator(TESSERA_SOURCE_DIR "/tools/models"))
    if (entry.path().extension() == ".json") texts.push_back(content_of(entry.path()));
  std::sort(texts.begin(), texts.end());
  EXPECT_GT(texts.size(), 50u);
  return texts;
}

TEST(JsonErrors, TruncatedModelsAreRefused) {
  for (const std::string& text : model_texts())
    for (std::size_t bytes = 0; bytes + 2 < text.size(); bytes += 97) {
      const Result<Model> cut = parse_json_model(std::string_view(text).substr(0, bytes), "m.json");
      ASSERT_FALSE(cut.ok());
      EXPECT_EQ(cut.status().code(), StatusCode::parse_error);
      EXPECT_EQ(cut.status().message().rfind("m.json:", 0), 0u);
    }
}

TEST(JsonErrors, SpoiledModelsAreReadOrRefused) {
  std::mt19937 random(13);
  constexpr std::string_view likely = "0123456789.eE+-\"[]{},: tuv()^*/";
  for (const std::string& text : model_texts())
    for (int k = 0; k < 60; ++k) {
      std::string spoiled = text;
      for (std::size_t n = 1 + random() % 3; n > 0; --n) {
        const std::size_t at = random() % spoiled.size();
        if (k % 3 == 0)
          spoiled[at] = static_cast<char>(random());
        else if (k % 3 == 1)
          spoiled[at] = likely[random() % likely.size()];
        else
          spoiled.erase(at, 1 + random() % 4);
      }
      const Result<Model> model = parse_json_model(spoiled, "m.json");
      if (model) continue;
      EXPECT_EQ(model.status().message().rfind("m.json:", 0), 0u) << model.status().message();
      EXPECT_NE(model.status().code(), StatusCode::internal) << model.status().message();
    }
}

}}  // namespace tessera::test
