// Long files of surfaces: read in pieces by several threads they are what one thread reads, with the same errors.

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <functional>
#include <random>
#include <string>
#include <vector>

#include "tessera/bezier_patch.h"
#include "tessera/io.h"
#include "tessera/nurbs_surface.h"

namespace tessera { namespace {

using Parser = Result<Model> (*)(std::string_view, std::string_view);

Result<Model> parse_by(int threads, Parser parse, const std::string& text) {
  std::optional<Result<Model>> model;
  tbb::task_arena(threads).execute([&] { model.emplace(parse(text, "long")); });
  return *std::move(model);
}

void expect_same(const ModelSurface& one, const ModelSurface& other) {
  ASSERT_EQ(one.surface.index(), other.surface.index());
  if (const auto* const patch = std::get_if<BezierPatch>(&one.surface)) {
    const auto& same = std::get<BezierPatch>(other.surface);
    EXPECT_EQ(patch->degree_u(), same.degree_u());
    EXPECT_TRUE(std::ranges::equal(patch->points(), same.points()));
    return;
  }
  const auto& spline = std::get<BSplineSurface>(one.surface);
  const auto& same = std::get<BSplineSurface>(other.surface);
  EXPECT_TRUE(std::ranges::equal(spline.points(), same.points()));
  EXPECT_TRUE(std::ranges::equal(spline.knots_u(), same.knots_u()));
}

/// Returns what both readings say: the message of an error, or "".
std::string expect_same_reading(Parser parse, const std::string& text) {
  const Result<Model> one = parse_by(1, parse, text), several = parse_by(4, parse, text);
  EXPECT_EQ(one.ok(), several.ok());
  EXPECT_EQ(one.status().message(), several.status().message());
  if (!one || !several) return one.status().message();
  EXPECT_EQ(one->warnings, several->warnings);
  EXPECT_EQ(one->surfaces.size(), several->surfaces.size());
  for (std::size_t k = 0; k < std::min(one->surfaces.size(), several->surfaces.size()); ++k) {
    expect_same(one->surfaces[k], several->surfaces[k]);
    if (testing::Test::HasFailure()) break;
  }
  return {};
}

constexpr std::size_t long_text = std::size_t{6} << 20;  // bytes; texts from 4 MiB on are read in pieces

/// Patches of .bpt. `end`: what stands after each number.
struct BptText {
  std::size_t patches = 0;
  std::string text;

  explicit BptText(const std::function<std::string(std::mt19937&, std::size_t number)>& end) {
    std::mt19937 random(11);
    while (text.size() < long_text) {
      const int u = 1 + static_cast<int>(random() % 4), v = 1 + static_cast<int>(random() % 4);
      text += std::to_string(u) + " " + std::to_string(v) + end(random, 0);
      for (int k = 0; k < 3 * (u + 1) * (v + 1); ++k)
        text += std::to_string(static_cast<int>(random() % 9) - 2) + end(random, static_cast<std::size_t>(k) + 1);
      ++patches;
    }
  }
  std::string with_count(std::size_t count) const { return std::to_string(count) + "\n" + text; }
  std::string whole() const { return with_count(patches); }
};

std::string by_points(std::mt19937&, std::size_t number) { return number % 3 == 0 ? "\n" : " "; }

TEST(LongFiles, PatchesAreThoseOfOneThread) {
  EXPECT_EQ(expect_same_reading(parse_bpt, BptText(by_points).whole()), "");
}

TEST(LongFiles, LinesMayLookLikeDegrees) {
  // Lines of two numbers, which may be the degrees of a patch or not.
  const BptText pairs([](std::mt19937&, std::size_t number) { return number % 2 == 0 ? "\n" : " "; });
  EXPECT_EQ(expect_same_reading(parse_bpt, pairs.whole()), "");
  const BptText any([](std::mt19937& random, std::size_t) {
    return std::vector<std::string>{" ", "\n", "\t", "\r\n", " # 2 2\n", "\n\n"}[random() % 6];
  });
  EXPECT_EQ(expect_same_reading(parse_bpt, any.whole()), "");
  const BptText one_line([](std::mt19937&, std::size_t) { return " "; });
  EXPECT_EQ(expect_same_reading(parse_bpt, one_line.whole()), "");
}

TEST(LongFiles, ErrorsNameTheSamePlace) {
  const BptText good(by_points);
  EXPECT_NE(expect_same_reading(parse_bpt, good.with_count(good.patches + 1)), "");
  EXPECT_NE(expect_same_reading(parse_bpt, good.with_count(good.patches - 1)), "");
  EXPECT_NE(expect_same_reading(parse_bpt, good.with_count(3)), "");
  std::mt19937 random(5);
  for (int k = 0; k < 12; ++k) {
    std::string text = good.whole();
    const std::size_t place = random() % text.size();
    if (k % 3 == 0)
      text.resize(place);
    else
      text.insert(place, k % 3 == 1 ? " x " : "\n3 3\n");
    EXPECT_NE(expect_same_reading(parse_bpt, text), "") << k;
  }
}

std::string g2_text(const std::string& between) {
  std::mt19937 random(3);
  std::string text;
  for (std::size_t k = 0; text.size() < long_text; ++k) {
    text += "200 1 0 0\n3 0\n2 2\n0 0 1 1\n3 2\n0 0 1 2 2\n";
    for (int p = 0; p < 6; ++p) {
      for (int c = 0; c < 3; ++c) text += std::to_string(random() % 300) + " ";
      text += "\n";
    }
    if (k % 1000 == 7) text += between;
  }
  return text;
}

TEST(LongFiles, ObjectsOfG2) {
  EXPECT_EQ(expect_same_reading(parse_g2, g2_text("")), "");
  EXPECT_EQ(expect_same_reading(parse_g2, g2_text("\n# 200 1 0 0\n\n")), "");
  // A curve is passed over, with a warning.
  EXPECT_EQ(expect_same_reading(parse_g2, g2_text("100 1 0 0\n3 0\n2 2\n0 0 1 1\n0 0 0\n1 0 0\n")), "");
  EXPECT_NE(expect_same_reading(parse_g2, g2_text("200 1 0 0\n3 0\n")), "");
  EXPECT_NE(expect_same_reading(parse_g2, g2_text("").substr(0, long_text - 20)), "");
}

TEST(LongFiles, ObjectsLongerThanAPiece) {
  std::string knots = "0 0";
  for (int k = 1; k < 159; ++k) knots += " " + std::to_string(k);
  std::string points;
  for (int k = 0; k < 160 * 160; ++k) points += "1.2345678 2.3456789 " + std::to_string(k % 7) + ".4567891\n";
  std::string text;
  for (int k = 0; k < 12; ++k) {
    text += "200 1 0 0\n3 0\n160 2\n" + knots + " 159 159\n160 2\n" + knots + " 159 159\n";
    text += points;
  }
  EXPECT_EQ(expect_same_reading(parse_g2, text), "");
}

TEST(LongFiles, AMarkWithinTheTextIsAnError) {
  const BptText good(by_points);
  std::string text = good.whole();
  for (std::size_t at = text.find('\n', text.size() / 3); at < text.size() / 2; at = text.find('\n', at + (1 << 16)))
    text.insert(at + 1, "\xEF\xBB\xBF");
  EXPECT_NE(expect_same_reading(parse_bpt, text), "");
}

TEST(LongFiles, AnObjectThatNeverEndsIsReadOnce) {
  // Each line begins what takes all that follows for its points.
  std::string text;
  while (text.size() < 4 * long_text) text += "200 1 0 0\n3 0 1000 2 \n";
  EXPECT_NE(expect_same_reading(parse_g2, text), "");
}

}}  // namespace tessera
