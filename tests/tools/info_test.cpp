// tessera info: joins, parameters, memory, and the page that documents the output of --json.

#include <array>
#include <cmath>
#include <regex>
#include <set>

#include "tools/tool_test.h"

namespace tessera::test { namespace {

using nlohmann::json;

class Info : public ToolTest {
 protected:
  json facts_of(const std::string& text, const std::vector<std::string>& options = {}) const {
    folder_.file("m.bpt", text);
    Names words{"info", "m.bpt", "--json"};
    words.insert(words.end(), options.begin(), options.end());
    return json::parse(output_of(words));
  }
};

/// A bilinear patch of these corners: (0,0), (0,1), (1,0), (1,1).
std::string patch(const std::array<std::array<double, 3>, 4>& corners) {
  std::ostringstream text;
  text.precision(17);
  text << "1 1\n";
  for (const auto& p : corners) text << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
  return text.str();
}
/// The unit square of the plane z = 0, and one beyond its edge x = 1 that goes on for `length`, bent up by `angle`.
std::string bent(double angle, double length, double gap = 0) {
  const double x = 1 + length * std::cos(angle), z = length * std::sin(angle);
  return "2\n" + patch({{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}}}) +
         patch({{{1, 0, 0}, {1, 1 + gap, 0}, {x, 0, z}, {x, 1, z}}});
}

TEST_F(Info, JoinsAreToldByTheirContinuity) {
  const json flat = facts_of(bent(0, 1))["joins"];
  EXPECT_EQ(flat["between_surfaces"]["joins"], 1);
  EXPECT_EQ(flat["between_surfaces"]["c1"], 1);
  EXPECT_EQ(flat["within_surfaces"]["joins"], 0);
  EXPECT_EQ(flat["open_borders"], 6);
  EXPECT_EQ(flat["crowded_borders"], 0);
  EXPECT_EQ(facts_of(bent(0, 2))["joins"]["between_surfaces"]["g1"], 1);  // one normal, derivatives 1 and 2
  const json roof = facts_of(bent(0.4, 1))["joins"]["between_surfaces"];
  EXPECT_EQ(roof["c0"], 1);
  EXPECT_NEAR(roof["largest_angle_degrees"], 0.4 * 180 / 3.14159265358979, 1e-6);
  const json gap = facts_of(bent(0, 1, 5e-5))["joins"]["between_surfaces"];
  EXPECT_EQ(gap["gaps"], 1);
  EXPECT_NEAR(gap["largest_gap"], 5e-5, 1e-7);
  EXPECT_EQ(facts_of(bent(0, 1, 0.01))["joins"]["open_borders"], 8);
  const std::string text = output_of({"info", "m.bpt"});
  EXPECT_NE(text.find("open borders     8\n"), std::string::npos) << text;
  facts_of(bent(0.4, 1));
  EXPECT_NE(output_of({"info", "m.bpt"}).find("between surfaces 1: 1 C0 (largest angle 22.9 deg)"), std::string::npos);
}

TEST_F(Info, ThreePatchesAtABorderAreCrowded) {
  const std::string fin = bent(0, 1).substr(1) + patch({{{1, 0, 0}, {1, 1, 0}, {1, 0, 1}, {1, 1, 1}}});
  const json joins = facts_of("3" + fin)["joins"];
  EXPECT_EQ(joins["crowded_borders"], 1);
  EXPECT_EQ(joins["between_surfaces"]["joins"], 0);
  EXPECT_EQ(joins["open_borders"], 9);
}

TEST_F(Info, BordersWithTheSameEndsNeedTheSameMiddle) {
  // Two arches over the same feet, one up, one down: their curved borders are open, as the middles lie apart.
  const auto arch = [](double height) {
    const std::string h = std::to_string(height);
    return "2 1\n0 0 0\n0 1 0\n0.5 0 " + h + "\n0.5 1 " + h + "\n1 0 0\n1 1 0\n";
  };
  const json joins = facts_of("2\n" + arch(1) + arch(-1))["joins"];
  EXPECT_EQ(joins["between_surfaces"]["joins"], 2);  // the straight borders u0 and u1
  EXPECT_EQ(joins["open_borders"], 4);
}

TEST_F(Info, JoinsCanBeLimitedAndLeftOut) {
  const json some = facts_of(content_of(teapot), {"--joins", "5"})["joins"]["between_surfaces"];
  const json all = facts_of(content_of(teapot))["joins"]["between_surfaces"];
  EXPECT_EQ(some["measured"], 5);
  EXPECT_EQ(some["joins"], all["joins"]);
  EXPECT_EQ(all["measured"], all["joins"]);
  EXPECT_EQ(all["c1"].get<int>() + all["g1"].get<int>() + all["c0"].get<int>() + all["gaps"].get<int>(), all["joins"]);
  EXPECT_TRUE(facts_of(content_of(teapot), {"--joins", "0"})["joins"].is_null());
  EXPECT_NE(output_of({"info", teapot, "--joins", "0"}).find("left out"), std::string::npos);
  EXPECT_NE(output_of({"info", teapot, "--joins", "5"}).find(", of which 5 measured: "), std::string::npos);
}

TEST_F(Info, ATorusHasNoOpenBorder) {
  const json facts = json::parse(output_of({"info", TESSERA_SOURCE_DIR "/tools/models/torus.json", "--json"}));
  EXPECT_EQ(facts["joins"]["open_borders"], 0);
  EXPECT_EQ(facts["joins"]["within_surfaces"]["joins"], 2 * facts["patches"].get<int>());
  EXPECT_EQ(facts["joins"]["within_surfaces"]["c0"], 0);
}

TEST_F(Info, ParametersAndMemory) {
  const json facts = json::parse(output_of({"info", TESSERA_SOURCE_DIR "/tools/models/nurbs_5x5.json", "--json"}));
  EXPECT_EQ(facts["file_bytes"], content_of(TESSERA_SOURCE_DIR "/tools/models/nurbs_5x5.json").size());
  EXPECT_EQ(facts["parameters"]["u"].size(), 2u);
  EXPECT_LT(facts["parameters"]["u"][0], facts["parameters"]["u"][1]);
  EXPECT_GE(facts["memory_bytes"]["model"], 25u * 4 * sizeof(double));
  const std::size_t control_points = facts["control_points"];
  EXPECT_GE(facts["memory_bytes"]["patches"], control_points * 3 * sizeof(double));
  EXPECT_GE(facts["memory_bytes"]["blocks"], control_points * 3 * sizeof(float));
  const json pot = json::parse(output_of({"info", teapot, "--json"}));
  EXPECT_EQ(pot["parameters"]["surfaces_on_unit_square"], 32);
  EXPECT_EQ(pot["parameters"]["u"], json({0.0, 1.0}));
}

/// A torus and a plate with loops of all sorts.
TEST_F(Info, LoopsAndTheirRemarks) {
  folder_.file("loops.json", R"({"format": "tessera", "version": 1, "surfaces": [
    {"kind": "torus", "name": "ring", "major": 3, "minor": 1, "trims": [
      {"hole": true, "curves": [{"kind": "circle", "center": [1, 1], "radius": 0.1}]}]},
    {"kind": "bezier", "points": [[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]]},
    {"kind": "bezier", "name": "plate", "points": [[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]], "trims": [
      {"hole": true, "curves": [{"kind": "circle", "center": [1, 1], "radius": 0.25}]},
      {"hole": true, "curves": [{"kind": "bezier", "points": [[0.25, 0.25], [0.5, 0.25], [0.25, 0.5]]}]},
      {"curves": [{"kind": "bezier", "points": [[0.25, 0.25], [0.5, 0.25]]},
                  {"kind": "bezier", "points": [[0.5, 0.25], [0.25, 0.25]]}]}]}]})");
  const json facts = json::parse(run({"info", "loops.json", "--json"}).output);
  EXPECT_EQ(facts["surfaces"], 3);
  EXPECT_EQ(facts["trimmed_surfaces"], 2);
  EXPECT_EQ(facts["loops"], 4);
  const json& remarks = facts["loop_remarks"];
  ASSERT_EQ(remarks.size(), 3u) << remarks;
  const std::array<std::string, 3> faults{"outside", "gap", "retraced"};
  const std::array<double, 3> sizes{0.25, 0.25, 0};
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(remarks[k]["surface"], 2);
    EXPECT_EQ(remarks[k]["loop"], k);
    EXPECT_EQ(remarks[k]["fault"], faults[k]);
    EXPECT_EQ(remarks[k]["size"], sizes[k]);
    EXPECT_EQ(remarks[k]["text"].get<std::string>().rfind("loop " + std::to_string(k) + ": ", 0), 0u);
  }
  const std::string text = run({"info", "loops.json"}).output;
  EXPECT_NE(text.find("\n  trims            2 of 3 faces, 4 loops, 3 remarks:\n"
                      "    surface 2 (plate): loop 0: it leaves the surface's domain by 0.25 and is cut off there\n"
                      "    surface 2 (plate): loop 1: a straight line closes a gap of 0.25"),
            std::string::npos)
      << text;
}

/// Loops that no region can be made of cost a remark.
TEST_F(Info, LoopsThatCannotBeUsed) {
  folder_.file("far.json", R"({"format": "tessera", "version": 1, "surfaces": [
    {"kind": "bezier", "points": [[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]], "trims": [
      {"curves": [{"kind": "bezier", "points": [[0, 0], [1e200, 0], [0, 1]]}]}]}]})");
  const json remarks = json::parse(run({"info", "far.json", "--json"}).output)["loop_remarks"];
  ASSERT_EQ(remarks.size(), 1u);
  EXPECT_EQ(remarks[0]["fault"], "unusable");
  EXPECT_EQ(remarks[0]["loop"], 0);
  EXPECT_EQ(remarks[0]["text"],
            "its loops cannot be used: loop 0 has a coordinate of 1e+200; the largest is limited to 1e+100");
}

/// Every key of an object, as a.b.c; elements of arrays as a[].b.
void info_collect(const json& value, const std::string& path, std::set<std::string>& keys) {
  if (value.is_array() && !value.empty()) return info_collect(value[0], path + "[]", keys);
  if (!value.is_object()) return;
  for (const auto& [key, child] : value.items()) {
    keys.insert(path.empty() ? key : path + "." + key);
    if (path + key != "kinds") info_collect(child, path.empty() ? key : path + "." + key, keys);
  }
}

TEST_F(Info, ThePageOfJsonIsWhole) {
  const std::string page = content_of(TESSERA_SOURCE_DIR "/tools/tessera/JSON.md");
  folder_.file("rays.csv", "ox,oy,oz,dx,dy,dz\n0,0,9,0,0,-1\n");
  folder_.file("points.csv", "x,y,z\n0,0,9\n");
  const std::vector<std::pair<std::string, Names>> runs{
      {"info", {"info", teapot}},
      {"eval", {"eval", teapot, "--grid", "2x2", "--derivs", "2"}},
      {"eval -o", {"eval", teapot, "--grid", "2x2", "-o", "a.csv"}},
      {"tessellate", {"tessellate", teapot, "--grid", "2x2", "-o", "a.ply"}},
      {"tessellate --tolerance", {"tessellate", teapot, "--tolerance", "0.1", "-o", "a.ply"}},
      {"tessellate --tolerance", {"tessellate", teapot, "--angle", "30", "-o", "a.ply"}},
      {"convert", {"convert", teapot, "-o", "a.obj"}},
      {"section", {"section", teapot, "--at", "1", "-o", "a.svg"}},
      {"project", {"project", teapot, "--points", "points.csv", "-o", "c.csv"}},
      {"raycast -o", {"raycast", teapot, "--size", "8x8", "--shade", "error", "-o", "a.png"}},
      {"raycast --rays", {"raycast", teapot, "--rays", "rays.csv", "--hits", "b.csv"}},
      {"check", {"check", "a.ply"}},
      {"compare", {"compare", TESSERA_SOURCE_DIR "/tools/models/sphere.json", "a.ply", "--samples", "99"}},
      {"measure", {"measure", teapot, "--enclosed", "--inertia"}}};
  for (const auto& [name, words] : runs) {
    const std::size_t begin = page.find("## " + name + "\n");
    ASSERT_NE(begin, std::string::npos) << name;
    const std::string section = page.substr(begin, page.find("\n## ", begin + 3) - begin);
    static const std::regex entry("\n\\| `([^`]+)`");
    std::set<std::string> documented;
    for (std::sregex_iterator at(section.begin(), section.end(), entry), end; at != end; ++at)
      documented.insert((*at)[1]);
    Names command = words;
    command.push_back("--json");
    std::set<std::string> said;
    info_collect(json::parse(output_of(command)), "", said);
    for (const std::string& key : said) EXPECT_TRUE(documented.count(key)) << name << " says " << key;
    for (const std::string& key : documented) {
      const bool in_empty = key.find("[].") != std::string::npos;  // of lists that are empty here
      EXPECT_TRUE(in_empty || said.count(key)) << name << " lacks " << key;
    }
  }
}

}}  // namespace tessera::test
