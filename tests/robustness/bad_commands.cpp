// The command line: runs the built program; the table holds what it prints on standard error.

#include <gtest/gtest.h>

#include "robustness/bad_input.h"
#include "tools/run_tool.h"

namespace tessera::test {
namespace {

/// Runs commands in a folder with a model; none may print, or leave anything there.
class Commands {
 public:
  explicit Commands(Table& table) : table_(table) {
    folder_.file("teapot.bpt", content_of(TESSERA_SOURCE_DIR "/tools/models/teapot.bpt"));
    folder_.file("rays.csv", "ox,oy,oz,dx,dy,dz\n0,0,9,0,0,-1\n");
  }
  void file(const std::string& name, const std::string& text) { folder_.file(name, text); }

  void row(int status, const std::vector<std::string>& arguments, const std::vector<std::string>& variables = {}) {
    const std::vector<std::string> before = folder_.names();
    const ToolRun run = run_tool(folder_, arguments, variables);
    std::string words;
    for (const std::string& variable : variables) words += variable + " ";
    words += "tessera";
    for (const std::string& argument : arguments) words += " " + (argument.empty() ? "\"\"" : argument);
    EXPECT_EQ(run.status, status) << words << ": " << run.errors;
    EXPECT_TRUE(run.errors.starts_with("tessera: ")) << words << ": " << run.errors;
    EXPECT_EQ(run.output, "") << words;
    EXPECT_EQ(folder_.names(), before) << words;
    std::string said = run.errors;
    while (said.ends_with('\n')) said.pop_back();
    table_.says(words, "exit " + std::to_string(run.status) + ": " + said);
  }

 private:
  Table& table_;
  ScratchFolder folder_;
};

const std::vector<std::string> bad_grids{"3",     "3x",  "x3",     "3x3x3",         "0x3", "-3x3",
                                         "3.5x3", "axb", "3x4097", "99999999999x3", ""};

}  // namespace

void fill_commands(Table& table) {
  Commands tool(table);
  table.of("tessera COMMAND");
  tool.row(2, {});
  tool.row(2, {"paint"});
  tool.row(2, {"inof", "teapot.bpt"});
  tool.row(2, {"--versoin"});
  tool.row(2, {"info"});
  tool.row(2, {"info", "teapot.bpt", "--colour"});
  tool.row(2, {"info", "teapot.bpt"}, {"TESSERA_ISA=mmx"});
  tool.row(2, {"info", "teapot.bpt", "--isa", "avx3"});
  for (const char* const threads : {"0", "-1", "x", "1.5", "1025"})
    tool.row(2, {"info", "teapot.bpt", "--threads", threads});
  table.of("tessera tessellate MODEL -o MESH");
  tool.row(2, {"tessellate", "teapot.bpt", "--grid", "3x3"});
  tool.row(2, {"tessellate", "teapot.bpt", "-o", "-"});
  tool.row(2, {"tessellate", "teapot.bpt", "-o", "a.ply", "--max-memory", "0"});
  tool.row(1, {"tessellate", "teapot.bpt", "-o", "a.ply", "--grid", "64x64", "--max-memory", "1M"});
  tool.row(2, {"info", "-"});
  tool.row(2, {"tessellate", "teapot.bpt", "-o", "", "--grid", "3x3"});
  tool.row(2, {"tessellate", "teapot.bpt", "-o", "a.off", "--grid", "3x3"});
  for (const std::string& grid : bad_grids) tool.row(2, {"tessellate", "teapot.bpt", "-o", "a.ply", "--grid", grid});
  for (const char* const tolerance : {"0", "-1", "nan", "inf", "x", "1e999"})
    tool.row(2, {"tessellate", "teapot.bpt", "-o", "a.ply", "--tolerance", tolerance});
  tool.row(1, {"tessellate", "teapot.bpt", "-o", "a.ply", "--tolerance", "1e-12"});
  table.of("tessera eval MODEL");
  tool.row(2, {"eval", "teapot.bpt"});
  tool.row(2, {"eval", "teapot.bpt", "--grid", "1x2"});
  tool.row(2, {"eval", "teapot.bpt", "--grid", "3x3", "--params", "p.csv"});
  tool.row(2, {"eval", "teapot.bpt", "--grid", "3x3", "--derivs", "3"});
  tool.row(2, {"eval", "teapot.bpt", "--grid", "3x3", "--format", "xml"});
  tool.row(2, {"eval", "teapot.bpt", "--params", ""});
  table.of("tessera raycast MODEL");
  tool.row(2, {"raycast", "teapot.bpt"});
  tool.row(2, {"raycast", "teapot.bpt", "-o", "a.gif"});
  tool.row(2, {"raycast", "teapot.bpt", "--rays", "rays.csv"});
  tool.row(2, {"raycast", "teapot.bpt", "-o", "a.png", "--mode", "both"});
  for (const char* const size : {"0x10", "10x16385", "10"})
    tool.row(2, {"raycast", "teapot.bpt", "-o", "a.png", "--size", size});
  for (const char* const camera : {"1,2,3", "1,2,3,4,5,6,x", "1,2,3,4,5,6,nan", "0,0,0,1e999,0,0,40", "1,2,3,1,2,3,40",
                                   "1,2,3,4,5,6,0", "1,2,3,4,5,6,180", "1e19,0,0,0,0,0,40"})
    tool.row(2, {"raycast", "teapot.bpt", "-o", "a.png", "--camera", camera});
  table.of("tessera measure MODEL");
  tool.row(2, {"measure"});
  for (const char* const accuracy : {"0", "-1", "nan", "1e-15", "1", "x"})
    tool.row(2, {"measure", "teapot.bpt", "--accuracy", accuracy});
  table.of("tessera compare MODEL MESH");
  tool.row(2, {"compare", "teapot.bpt"});
  tool.row(1, {"compare", "teapot.bpt", "missing.ply"});
  tool.row(2, {"compare", "teapot.bpt", "a.ply", "-o", "a.gif"});
  tool.row(2, {"compare", "teapot.bpt", "a.ply", "--size", "8x8"});
  tool.row(2, {"compare", "teapot.bpt", "a.ply", "--scale", "2", "--mesh-unit", "mm"});
  for (const char* const length : {"0", "-1", "nan", "x"}) {
    tool.row(2, {"compare", "teapot.bpt", "a.ply", "--tolerance", length});
    tool.row(2, {"compare", "teapot.bpt", "a.ply", "--spacing", length});
  }
}

void fill_model_commands(Table& table) {
  Commands tool(table);
  tool.file("empty.bpt", "");
  tool.file("huge_count.bpt", "4000000000\n3 3\n0 0 0\n");
  tool.file("nan.bpt", "1\n1 1\n0 0 0\n0 1 nan\n1 0 0\n1 1 0\n");
  tool.file("degree0.bpt", "1\n0 1\n0 0 0\n0 1 0\n");
  tool.file("huge.bpt", "1\n1 1\n0 0 0\n0 1 0\n1 0 0\n1e300 1 0\n");
  tool.file("point.bpt", "1\n1 1\n1 2 3\n1 2 3\n1 2 3\n1 2 3\n");
  tool.file("cut.json", "{\"surfaces\": [");
  table.of("a model that cannot be used");
  tool.row(1, {"info", "missing.bpt"});
  tool.row(1, {"info", "."});
  tool.row(1, {"info", "scene.k3d"});
  tool.row(1, {"info", "empty.bpt"});
  tool.row(1, {"eval", "huge_count.bpt", "--grid", "2x2"});
  tool.row(1, {"tessellate", "nan.bpt", "-o", "a.ply", "--grid", "2x2"});
  tool.row(1, {"convert", "degree0.bpt", "-o", "a.obj"});
  tool.row(1, {"raycast", "huge.bpt", "-o", "a.png"});
  tool.row(1, {"raycast", "point.bpt", "-o", "a.png"});
  tool.row(1, {"info", "cut.json"});
  tool.row(1, {"measure", "huge.bpt"});
  tool.row(1, {"check", "teapot.bpt"});
  tool.row(2, {"convert", "teapot.bpt", "-o", "a.step"});
  tool.row(2, {"project", "teapot.bpt", "-o", "a.csv"});
  tool.row(1, {"project", "teapot.bpt", "-o", "a.csv", "--points", "missing.csv"});
  tool.row(2, {"project", "teapot.bpt", "-o", "a.csv", "--points", "missing.csv", "--max-distance", "0"});
  tool.row(2, {"section", "teapot.bpt", "-o", "a.step", "--at", "1"});
  tool.row(2, {"section", "teapot.bpt", "-o", "a.svg"});
  tool.row(2, {"section", "teapot.bpt", "-o", "a.svg", "--plane", "0,0,0,1"});
  tool.row(1, {"section", "teapot.bpt", "-o", "a.svg", "--at", "1", "--tolerance", "1e-200"});

  tool.file("header.csv", "a,b,c\n1,2,3\n");
  tool.file("short.csv", "ox,oy,oz,dx,dy,dz\n0,0,9,0,0\n");
  tool.file("word.csv", "ox,oy,oz,dx,dy,dz\n0,0,nine,0,0,-1\n");
  tool.file("outside.csv", "surface,u,v\n0,0.5,1.5\n");
  tool.file("nosuch.csv", "surface,u,v\n99,0.5,0.5\n");
  table.of("a table that cannot be used");
  tool.row(1, {"raycast", "teapot.bpt", "--rays", "missing.csv", "--hits", "h.csv"});
  tool.row(1, {"raycast", "teapot.bpt", "--rays", "header.csv", "--hits", "h.csv"});
  tool.row(1, {"raycast", "teapot.bpt", "--rays", "short.csv", "--hits", "h.csv"});
  tool.row(1, {"raycast", "teapot.bpt", "--rays", "word.csv", "--hits", "h.csv"});
  tool.row(1, {"eval", "teapot.bpt", "--params", "outside.csv"});
  tool.row(1, {"eval", "teapot.bpt", "--params", "nosuch.csv"});

  table.of("an output that cannot be written");
  tool.row(1, {"tessellate", "teapot.bpt", "-o", "teapot.bpt/a/a.ply", "--grid", "2x2"});
  tool.row(1, {"raycast", "teapot.bpt", "-o", "teapot.bpt/a/a.png", "--size", "8x8"});
  tool.row(1, {"eval", "teapot.bpt", "--grid", "2x2", "-o", "/dev/full"});
  tool.row(2, {"eval", "teapot.bpt", "--grid", "2x2", "-o", "teapot.bpt"});
  tool.row(2, {"raycast", "teapot.bpt", "--rays", "rays.csv", "--hits", "./rays.csv"});
}

}  // namespace tessera::test
