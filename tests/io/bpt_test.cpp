// The reader of .bpt files: what it accepts, and its errors.

#include <gtest/gtest.h>

#include <random>
#include <sstream>

#include "support/scratch_folder.h"
#include "tessera/io.h"

namespace tessera { namespace {

const std::string teapot_path = TESSERA_SOURCE_DIR "/tools/models/teapot.bpt";

/// A text that a test spoils: two bilinear patches.
const std::string two_patches = "2\n1 1\n0 0 0\n0 1 0\n1 0 0\n1 1 0\n1 1\n1 0 0\n1 1 0\n2 0 0\n2 1 0\n";

std::string error_of(std::string_view text) {
  const Result<Model> model = parse_bpt(text, "m.bpt");
  EXPECT_FALSE(model.ok()) << text;
  if (model.ok()) return {};
  EXPECT_EQ(model.status().code(), StatusCode::parse_error) << text;
  return model.status().message();
}

bool same(const Model& a, const Model& b) {
  return std::equal(a.surfaces.begin(), a.surfaces.end(), b.surfaces.begin(), b.surfaces.end(),
                    [](const ModelSurface& one, const ModelSurface& other) {
                      const auto& x = std::get<BezierPatch>(one.surface);
                      const auto& y = std::get<BezierPatch>(other.surface);
                      return x.degree_u() == y.degree_u() && x.degree_v() == y.degree_v() &&
                             std::ranges::equal(x.points(), y.points());
                    });
}

TEST(Bpt, PointsRunAlongVFirst) {
  const Result<Model> model = parse_bpt("1 1 2  0 0 7  0 1 7  0 2 7  1 0 7  1 1 7  1 2 7", "m.bpt");
  ASSERT_TRUE(model.ok()) << model.status().message();
  const BezierPatch& patch = std::get<BezierPatch>(model->surfaces.at(0).surface);
  EXPECT_EQ(patch.degree_u(), 1);
  EXPECT_EQ(patch.degree_v(), 2);
  for (int i = 0; i <= 1; ++i) {
    for (int j = 0; j <= 2; ++j) EXPECT_EQ(patch.point(i, j), (Vec3{double(i), double(j), 7}));
  }
}

TEST(Bpt, LayoutDoesNotMatter) {
  const Result<Model> plain = parse_bpt(two_patches, "m.bpt");
  ASSERT_TRUE(plain.ok());
  std::string windows = "\xEF\xBB\xBF# made elsewhere\r\n", tabs, without_end = two_patches;
  for (const char c : two_patches) windows += c == '\n' ? std::string(" # x 1 2\r\n\r\n") : std::string(1, c);
  for (const char c : two_patches) tabs += c == '\n' || c == ' ' ? '\t' : c;
  without_end.pop_back();
  for (const std::string& text : {windows, tabs, without_end}) {
    const Result<Model> model = parse_bpt(text, "m.bpt");
    ASSERT_TRUE(model.ok()) << model.status().message();
    EXPECT_TRUE(same(*plain, *model));
  }
}

TEST(Bpt, EveryDegreeIsRead) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(-10, 10);
  for (int m = 1; m <= max_degree; ++m) {
    for (int n = 1; n <= max_degree; ++n) {
      std::vector<Vec3> points(static_cast<std::size_t>((m + 1) * (n + 1)));
      std::ostringstream text;
      text.precision(17);
      text << "1\n" << m << ' ' << n << '\n';
      for (Vec3& p : points) {
        p = {coordinate(random), coordinate(random), coordinate(random)};
        text << p.x << ' ' << p.y << ' ' << p.z << '\n';
      }
      const Result<Model> model = parse_bpt(text.str(), "m.bpt");
      ASSERT_TRUE(model.ok()) << model.status().message();
      EXPECT_TRUE(std::ranges::equal(std::get<BezierPatch>(model->surfaces.at(0).surface).points(), points));
    }
  }
}

TEST(Bpt, ErrorsSayWhereWhatAndWhatWasWanted) {
  EXPECT_EQ(error_of(""), "m.bpt:1: expected the number of patches, at least 1, found the end of the file");
  EXPECT_EQ(error_of("# only words\n"),
            "m.bpt:1: expected the number of patches, at least 1, found the end of the file");
  EXPECT_EQ(error_of("0\n"), "m.bpt:1: expected the number of patches, at least 1, found \"0\"");
  EXPECT_EQ(error_of("\n-3"), "m.bpt:2: expected the number of patches, at least 1, found \"-3\"");
  EXPECT_EQ(error_of("teapot"), "m.bpt:1: expected the number of patches, at least 1, found \"teapot\"");
  EXPECT_EQ(error_of("1.5\n"), "m.bpt:1: expected the number of patches, at least 1, found \"1.5\"");
  EXPECT_EQ(error_of("1\n0 3\n"), "m.bpt:2: expected the degree along u of patch 1 of 1, from 1 to 15, found \"0\"");
  EXPECT_EQ(error_of("1\n3 16\n"), "m.bpt:2: expected the degree along v of patch 1 of 1, from 1 to 15, found \"16\"");
  EXPECT_EQ(error_of("1\n3\n"),
            "m.bpt:2: expected the degree along v of patch 1 of 1, from 1 to 15, found the end of the file");
  EXPECT_EQ(error_of("1\n1 1\n0 0 0\n0 1 0\n"), "m.bpt:4: the file ends after 2 of 4 control points of patch 1 of 1");
  EXPECT_EQ(error_of(two_patches + "1 2 3\n"), "m.bpt:12: expected the end of the file after 2 patches, found \"1\"");
  std::string wrong = two_patches;
  wrong.replace(wrong.find("0 1 0"), 5, "0 a 0");
  EXPECT_EQ(error_of(wrong),
            "m.bpt:4: expected 3 finite numbers for a control point (after 1 of 4 control points of "
            "patch 1 of 2), found \"a\"");
}

TEST(Bpt, NumbersThatAreNotFiniteAreErrorsWithTheirLine) {
  for (const char* bad : {"nan", "NAN", "-nan", "inf", "-inf", "Infinity", "1e400", "-1e400", "nan(1)"}) {
    std::string text = two_patches;
    text.replace(text.rfind("2 0 0"), 1, bad);
    const std::string message = error_of(text);
    EXPECT_EQ(message.rfind("m.bpt:10: expected 3 finite numbers", 0), 0u) << message;
    EXPECT_NE(message.find("\"" + std::string(bad) + "\""), std::string::npos) << message;
  }
}

TEST(Bpt, CountsThatTheFileCannotHoldAllocateNothing) {
  for (const char* count : {"4000000000", "9223372036854775807", "1000000000000"}) {
    const std::string message = error_of(std::string(count) + "\n1 1\n0 0 0\n");
    EXPECT_EQ(message, "m.bpt:3: the file ends after 1 of 4 control points of patch 1 of " + std::string(count));
  }
  EXPECT_EQ(error_of("99999999999999999999"),
            "m.bpt:1: expected the number of patches, at least 1, found \"99999999999999999999\"");
}

TEST(Bpt, FewerPatchesThanStatedIsAnError) {
  std::string text = two_patches;
  text[0] = '3';
  EXPECT_EQ(error_of(text),
            "m.bpt:11: expected the degree along u of patch 3 of 3, from 1 to 15, found the end of the file");
  text[0] = '1';
  EXPECT_EQ(error_of(text), "m.bpt:7: expected the end of the file after 1 patch, found \"1\"");
}

TEST(Bpt, ATruncatedTeapotIsNoTeapot) {
  const std::string text = test::content_of(teapot_path);
  const Result<Model> whole = parse_bpt(text, "teapot.bpt");
  ASSERT_TRUE(whole.ok()) << whole.status().message();
  // Only a text that is cut inside the last number, or behind it, cannot be told from a whole one.
  const std::size_t last_number = text.find_last_of(" \n", text.find_last_not_of(" \n")) + 1;
  for (std::size_t bytes = 0; bytes < text.size(); ++bytes) {
    const Result<Model> cut = parse_bpt(std::string_view(text).substr(0, bytes), "teapot.bpt");
    if (bytes <= last_number) {
      ASSERT_FALSE(cut.ok()) << "cut at byte " << bytes;
      ASSERT_EQ(cut.status().message().rfind("teapot.bpt:", 0), 0u);
    } else if (bytes + 1 >= text.size()) {
      ASSERT_TRUE(cut.ok());
      EXPECT_TRUE(same(*whole, *cut));
    }
  }
}

TEST(Bpt, SpoiledBytesNeverCrash) {
  const std::string text = test::content_of(teapot_path);
  std::mt19937 random(11);
  for (int k = 0; k < 2000; ++k) {
    std::string spoiled = text;
    for (int n = 0; n < 3; ++n) spoiled[random() % spoiled.size()] = static_cast<char>(random());
    const Result<Model> model = parse_bpt(spoiled, "teapot.bpt");
    if (!model) {
      EXPECT_EQ(model.status().code(), StatusCode::parse_error);
    }
  }
}

TEST(Bpt, TheTeapotIsNewells) {
  const Result<Model> model = read_model(teapot_path);
  ASSERT_TRUE(model.ok()) << model.status().message();
  EXPECT_EQ(model->name, "teapot");
  ASSERT_EQ(model->surfaces.size(), 32u);
  int collapsed = 0;
  Box3 box;
  for (const ModelSurface& surface : model->surfaces) {
    const BezierPatch& patch = std::get<BezierPatch>(surface.surface);
    EXPECT_EQ(patch.degree_u(), 3);
    EXPECT_EQ(patch.degree_v(), 3);
    collapsed += patch.collapsed_sides().any();
    box.extend(patch.hull_box());
  }
  EXPECT_EQ(collapsed, 8);  // the knob's four patches and the bottom's four
  EXPECT_EQ(box.lower, (Vec3{-3, -2, 0}));
  EXPECT_EQ(box.upper, (Vec3{3.525, 2, 3.15}));
}

TEST(Bpt, TheTeapotEqualsThePublishedCopies) {
  const char* const data = std::getenv("TESSERA_TEST_DATA");
  if (!data) GTEST_SKIP() << "TESSERA_TEST_DATA is not set";
  const Result<Model> own = read_model(teapot_path);
  ASSERT_TRUE(own.ok());
  for (const char* name : {"mkeeter_teapot.bpt", "cgjs_teapot.bpt"}) {
    const Result<Model> other = read_model(std::filesystem::path(data) / "classic_teaset" / name);
    ASSERT_TRUE(other.ok()) << other.status().message();
    EXPECT_TRUE(same(*own, *other)) << name;
  }
}

}}  // namespace tessera
