// The checker of #include lines finds each kind of breach, and none in engine/.

#include "house/include_rules.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "house/tree.h"

namespace tessera::house { namespace {

constexpr std::string_view sample_table = R"(
floor base            # comments are left out
floor surface on base
floor parallel on base
floor eval on surface parallel
floor ray on eval
floor io on surface
room ray/line
room ray/leaf on ray/line
room ray/scene on ray/leaf
header status.h of base
header patch.h of surface
header ray_scene.h of ray
header ray_embree.h of ray
outside tbb/ for parallel
outside embree3/ for ray ray_embree.h
outside fcntl.h for io
)";
const Names sample_files{"include/tessera/status.h", "include/tessera/patch.h",      "include/tessera/ray_scene.h",
                         "src/base/guard.h",         "src/surface/casteljau.h",      "src/eval/plan.h",
                         "src/ray/scene/scene.h",    "include/tessera/ray_embree.h", "src/io/file.h",
                         "src/ray/line/line.h",      "src/ray/leaf/leaf.h"};

FloorTable sample() {
  std::vector<std::string> faults;
  FloorTable table = parse_floors(sample_table, faults);
  EXPECT_TRUE(faults.empty()) << faults.front();
  return table;
}

std::vector<std::string> faults_of(const std::string& path, const std::string& text) {
  return check_includes({path, text}, sample(), sample_files);
}

TEST(IncludeRules, AllowsWhatTheTableAllows) {
  const std::string plain = "#include <vector>\n#include \"tessera/status.h\"\n#include \"base/guard.h\"\n";
  EXPECT_EQ(faults_of("src/surface/a.cpp", plain), std::vector<std::string>());
  EXPECT_EQ(faults_of("src/eval/a.cpp", plain + "#include \"surface/casteljau.h\"\n#include \"tessera/patch.h\"\n"),
            std::vector<std::string>());
  EXPECT_EQ(faults_of("src/ray/scene/a.cpp", "#  include <embree3/rtcore.h>  // why\n#include \"ray/scene/scene.h\"\n"),
            std::vector<std::string>());
  EXPECT_EQ(faults_of("src/ray/scene/a.cpp", "#include \"ray/line/line.h\"\n#include \"ray/leaf/leaf.h\"\n"),
            std::vector<std::string>());
  EXPECT_EQ(faults_of("src/parallel/a.cpp", "#include <tbb/parallel_for.h>"), std::vector<std::string>());
  EXPECT_EQ(faults_of("include/tessera/ray_embree.h", "#include <embree3/rtcore.h>\n#include \"tessera/patch.h\""),
            std::vector<std::string>());
  EXPECT_EQ(faults_of("src/base/a.cpp", "// #include <tbb/a.h>\n/* as engine/* does:\n#include <tbb/a.h>\n*/\n"),
            std::vector<std::string>());
}

struct Breach {
  const char* path;
  const char* line;
  const char* message;
};

constexpr Breach breaches[] = {
    {"src/base/a.cpp", "#include \"surface/casteljau.h\"", "not below base"},             // a floor above
    {"src/surface/a.cpp", "#include \"eval/plan.h\"", "not below surface"},               // a floor above
    {"src/io/a.cpp", "#include \"ray/scene/scene.h\"", "not below io"},                   // the other wing
    {"src/ray/leaf/a.cpp", "#include \"ray/scene/scene.h\"", "not below ray/leaf"},       // a room above
    {"src/ray/line/a.cpp", "#include \"ray/leaf/leaf.h\"", "not below ray/line"},         // a room above
    {"src/io/a.cpp", "#include \"tessera/ray_scene.h\"", "belongs to ray"},               // its public header
    {"include/tessera/patch.h", "#include \"tessera/ray_scene.h\"", "belongs to ray"},    // a header above
    {"include/tessera/patch.h", "#include \"base/guard.h\"", "is private"},               // a private header
    {"include/tessera/patch.h", "#include <tbb/parallel_for.h>", "not for patch.h"},      // TBB in public
    {"include/tessera/ray_scene.h", "#include <embree3/rtcore.h>", "not for ray_scene"},  // Embree in public
    {"src/eval/a.cpp", "#include <tbb/parallel_for.h>", "not for eval"},                  // TBB above parallel
    {"src/eval/a.cpp", "#  include  <embree3/rtcore.h>", "not for eval"},
    {"src/eval/a.cpp", "#include <fcntl.h> // POSIX", "not for eval"},
    {"src/eval/a.cpp", "#include <boost/any.hpp>", "in no line"},  // a new dependency
    {"src/eval/a.cpp", "#include \"plan.h\"", "floor/file.h"},     // relative
    {"src/eval/a.cpp", "#include \"../surface/casteljau.h\"", "floor/file.h"},
    {"src/eval/a.cpp", "#include \"surface/missing.h\"", "does not exist"},
    {"src/eval/a.cpp", "#include \"tessera/unlisted.h\"", "not a public header"},
    {"src/eval/a.cpp", "#include HEADER", "neither"},
};

TEST(IncludeRules, EachBreachIsFound) {
  for (const auto& [path, line, message] : breaches) {
    const auto faults = faults_of(path, std::string("// engine/src/*.cpp \"/*\"\n/* a */ \n") + line + "\n");
    ASSERT_EQ(faults.size(), 1u) << path << " " << line;
    EXPECT_EQ(faults[0].rfind(std::string(path) + ":3: ", 0), 0u) << faults[0];
    EXPECT_NE(faults[0].find(message), std::string::npos) << faults[0];
  }
}

TEST(IncludeRules, FilesOfNoFloorAreFound) {
  EXPECT_EQ(faults_of("src/attic/a.cpp", "").size(), 1u);
  EXPECT_EQ(faults_of("src/a.cpp", "").size(), 1u);
  EXPECT_EQ(faults_of("include/tessera/unlisted.h", "").size(), 1u);
  EXPECT_EQ(faults_of("src/ray/a.cpp", "").size(), 1u);        // beside the rooms of its floor
  EXPECT_EQ(faults_of("src/ray/attic/a.cpp", "").size(), 1u);  // a room that is not stated
  EXPECT_EQ(faults_of("src/io/attic/a.cpp", "").size(), 1u);
}

TEST(FloorTable, FaultsAreFound) {
  for (const char* text :
       {"floor a on b", "floor a\nfloor a", "floor a on", "header x.h of a", "floor a on a", "outside tbb/ for a",
        "floor a\noutside tbb/", "roof a", "room a/b", "floor a\nroom a", "floor a\nroom a/b on a/c\nroom a/c",
        "floor a\nroom a/b\nroom a/b", "floor a\nfloor b\nroom a/x\nroom b/y on a/x"}) {
    std::vector<std::string> faults;
    parse_floors(text, faults);
    EXPECT_FALSE(faults.empty()) << text;
  }
}

// The tests below read the real tree.

FloorTable real_table() {
  std::vector<std::string> faults;
  FloorTable table = parse_floors(read_text("tests/house/floors.txt"), faults);
  for (const std::string& fault : faults) ADD_FAILURE() << "floors.txt: " << fault;
  return table;
}

constexpr const char* front_door = "include/tessera/tessera.h";

/// The headers that bring Embree, MPI and OpenCASCADE are included by name, and so are those of the library for C.
TEST(Engine, TheFrontDoorIncludesEveryPublicHeaderButThoseOfOtherLibraries) {
  Names expected;
  for (const auto& [header, floor] : real_table().floor_of)
    if (!header.starts_with("detail/") && header != "ray_embree.h" && header != "mpi.h" &&
        !header.starts_with("occt") && !header.starts_with("tessera_c"))
      expected.insert("tessera/" + header);
  std::string path = "engine/";
  path += front_door;
  EXPECT_EQ(quoted_includes(read_text(path)), expected);
}

TEST(Engine, EveryIncludeStaysOnOrBelowItsFloor) {
  const FloorTable table = real_table();
  Names known;
  for (const std::string& path : files_under("engine")) known.insert(path.substr(std::string("engine/").size()));
  std::size_t checked = 0;
  for (const std::string& path : known) {
    if (path == front_door || !(path.ends_with(".h") || path.ends_with(".cpp"))) continue;
    if (path.starts_with("wasm32/")) {  // stands below all floors, as the C++ library does
      EXPECT_TRUE(quoted_includes(read_text("engine/" + path)).empty()) << path;
      continue;
    }
    ++checked;
    for (const std::string& fault : check_includes({path, read_text("engine/" + path)}, table, known)) {
      ADD_FAILURE() << "engine/" << fault;
    }
  }
  EXPECT_GT(checked, 30u) << "the tree was not found";
}

/// Internal headers for the project's own programs, which no user needs.
const Names headers_for_tools{"io/file/descriptor.h",       "io/file/output_file.h", "io/file/text_cursor.h",
                              "io/format/output_formats.h", "io/mesh/mesh_pieces.h", "mpi/mpi_ply.h"};

/// The command line and the renderer are written as a user would write them, but for how they read and write files.
TEST(Tools, IncludePublicHeadersAndThoseOfFiles) {
  const FloorTable table = real_table();
  std::size_t checked = 0;
  for (const std::string& path : files_under("tools")) {
    if (!path.ends_with(".h") && !path.ends_with(".cpp")) continue;
    ++checked;
    for (const std::string& name : quoted_includes(read_text(path)))
      if (table.on.contains(name.substr(0, name.find('/'))) && !headers_for_tools.contains(name))
        ADD_FAILURE() << path << " includes " << name << ", which is private to the engine";
  }
  EXPECT_GT(checked, 30u) << "the tree was not found";
}

TEST(Engine, TheBuildTellsTheSameStoryAsTheTable) {
  const FloorTable table = real_table();
  FloorTable built;
  built.on = floors_of_cmake(read_text("engine/CMakeLists.txt"));
  EXPECT_EQ(built.on.size(), table.on.size());
  for (const auto& [floor, below] : built.on) EXPECT_EQ(built.reachable(floor), table.reachable(floor)) << floor;
}

}}  // namespace tessera::house
