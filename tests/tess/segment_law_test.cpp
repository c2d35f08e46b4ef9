// Segments that are graded: where they begin, the rates that they have, and the law by which they follow from needs.

#include "tess/cells/segment_law.h"

#include <algorithm>
#include <cmath>

#include "support/random_patches.h"
#include "tess/edges/edge_needs.h"

namespace tessera::test { namespace {

constexpr int parts = Segments::parts;

/// Segments of any number up to `most`, but rather few.
Segments random_segments(Random& random, int most) {
  Segments::Grades grades{};
  for (std::uint8_t& grade : grades) grade = static_cast<std::uint8_t>(random() % Segments::weight_count);
  const int all = 1 + static_cast<int>(random() % static_cast<std::uint64_t>(random() % 8 ? 40 : most));
  const int lower = all > 1 && random() % 2 ? 1 + static_cast<int>(random() % static_cast<std::uint64_t>(all - 1)) : 0;
  return Segments::graded(all, lower, grades);
}

/// Needs between 1/8 and about `most`, in which the eighths differ up to 50 times.
RateNeeds random_needs(Random& random, double most) {
  RateNeeds needs;
  for (Segments::Fraction& rate : needs) rate = {1 + static_cast<int>(8 * most * std::exp(-uniform(random, 0, 4))), 8};
  return needs;
}

bool has(Segments segments, const RateNeeds& needs) {
  for (int e = 0; e < parts; ++e)
    if (segments.rate_in(e) < needs[static_cast<std::size_t>(e)]) return false;
  return true;
}

/// The sum of (length in an eighth) x (rate there).
double measure(Segments segments, double from, double to) {
  double sum = 0;
  for (int e = 0; e < parts; ++e) {
    const double begin = std::max(from, double(e) / parts), end = std::min(to, double(e + 1) / parts);
    if (end > begin) sum += (end - begin) * segments.rate_in(e).value();
  }
  return sum;
}

TEST(GradedSegments, HaveTheRatesThatTheyTell) {
  Random random(1);
  for (int k = 0; k < 3000; ++k) {
    const Segments along = random_segments(random, Segments::max_graded), back = along.reversed();
    EXPECT_EQ(along.at(0).value(), 0);
    EXPECT_EQ(along.at(along.rate()).value(), 1);
    EXPECT_TRUE(back.reversed() == along);
    if (along.parts_halves()) {
      EXPECT_EQ(along.at(along.in_lower_half()).value(), 0.5);
    }
    for (int i = 0; i < along.rate(); ++i) {
      EXPECT_NEAR(measure(along, along.at(i).value(), along.at(i + 1).value()), 1, 1e-9);
      EXPECT_EQ(along.at(i).value(), back.at(along.rate() - i).rest());
      EXPECT_EQ(along.at(i).rest(), back.at(along.rate() - i).value());
    }
  }
}

TEST(SegmentLaw, HasTheRatesWithFewSegmentsEitherWay) {
  Random random(2);
  double taken = 0, least = 0;
  for (int k = 0; k < 3000; ++k) {
    const RateNeeds needs = random_needs(random, std::exp(uniform(random, 0, 6)));
    RateNeeds back = needs;
    std::reverse(back.begin(), back.end());
    for (const bool halves : {false, true}) {
      const Segments along = segments_for(needs, halves);
      EXPECT_TRUE(has(along, needs));
      EXPECT_TRUE(along.parts_halves() || !halves);
      EXPECT_TRUE(segments_for(back, halves).reversed() == along);
      if (along.rate() < 24) continue;  // few segments have one length in each half, and roundings of their own
      taken += along.rate();
      for (const Segments::Fraction& rate : needs) least += rate.value() / parts;
    }
  }
  EXPECT_LE(taken, 1.1 * least);  // weights have steps of a tenth
}

/// The patches at an edge agree in whichever order they are, and each of them has its rates.
TEST(SegmentLaw, NeedsAddUpInAnyOrder) {
  Random random(3);
  for (int k = 0; k < 2000; ++k) {
    std::vector<Segments> asked;
    for (std::uint64_t n = 2 + random() % 3; n > 0; --n)
      asked.push_back(random() % 3 ? random_segments(random, max_rate / parts)
                                   : Segments(1 + static_cast<int>(random() % 30)));
    if (random() % 3 == 0) asked.push_back(asked[0]);
    std::vector<bool> against;
    for (std::size_t n = 0; n < asked.size(); ++n) against.push_back(random() % 2);
    const auto border = [&](const std::vector<std::size_t>& order, std::uint16_t is_even) {
      PieceNeeds needs;
      for (const std::size_t n : order) needs.add(asked[n], against[n]);
      return needs.segments(false, is_even);
    };
    std::vector<std::size_t> order;
    for (std::size_t n = 0; n < asked.size(); ++n) order.push_back(n);
    for (const std::uint16_t is_even : {std::uint16_t{0}, std::uint16_t{1}}) {
      const Segments along = border(order, is_even);
      EXPECT_TRUE(along.parts_halves() || is_even == 0);
      for (std::size_t n = 0; n < asked.size(); ++n) {
        const Segments own = against[n] ? asked[n].reversed() : asked[n];
        for (int e = 0; e < parts; ++e) EXPECT_FALSE(along.rate_in(e) < own.rate_in(e));
      }
      std::vector<std::size_t> other = order;
      do {
        EXPECT_TRUE(border(other, is_even) == along);
      } while (std::next_permutation(other.begin(), other.end()));
    }
  }
}

TEST(SegmentLaw, OnePatchGetsWhatItAsksFor) {
  Random random(4);
  for (int k = 0; k < 500; ++k) {
    const Segments asked = random_segments(random, Segments::max_graded);
    PieceNeeds needs;
    needs.add(asked, false);
    needs.add(asked, false);
    EXPECT_TRUE(needs.segments(false, 0) == asked);
    EXPECT_TRUE(needs.segments(true, 0) == asked.reversed());
  }
}

}}  // namespace tessera::test
