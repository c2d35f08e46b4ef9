// Trimming loops of every bad sort: what is refused, what is repaired, and the part that is then kept.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "robustness/bad_input.h"
#include "tessera/trim_region.h"
#include "trim/trim_shapes.h"

namespace tessera::test {
namespace {

using enum StatusCode;
using Numbers = std::vector<double>;
using Loops = std::vector<TrimLoop>;
using Kept = std::function<bool(double u, double v)>;

constexpr Domain unit{0, 1, 0, 1};

/// A row for loops that are used: the remarks, and whether the region keeps what `kept` says at points that no border
/// of these loops meets.
void used(Table& table, const std::string& input, const Loops& loops, const Kept& kept, const std::string& remarks,
          const TrimOptions& options = {}) {
  const std::array breaks{0.0, 0.25, 0.5, 0.75, 1.0};
  const Result<TrimRegion> region = TrimRegion::make(loops, breaks, breaks, options);
  bool holds = region.ok();
  std::string found;
  if (region) {
    for (const LoopRemark& remark : region->remarks()) found += (found.empty() ? "" : "; ") + remark.text;
    for (int i = 0; i < 61; ++i)
      for (int k = 0; k < 61; ++k) {
        const double u = 0.0081 + 0.0161 * i, v = 0.0077 + 0.0163 * k;
        holds = holds && region->locate(u, v) == (kept(u, v) ? TrimSide::inside : TrimSide::outside);
      }
  }
  table.gives(input, remarks.empty() ? "accepted" : remarks, holds && found == remarks);
}

bool in_box(double u, double v, double u0, double u1, double v0, double v1) {
  return u > u0 && u < u1 && v > v0 && v < v1;
}

void refused_loops(Table& table) {
  const Loops circle{test::circle({0.5, 0.5}, 0.25)};
  const auto made = [&](const Loops& loops, const Numbers& u, const Numbers& v, const TrimOptions& options = {}) {
    return TrimRegion::make(loops, u, v, options);
  };
  const Numbers range{0, 1};
  table.of("TrimRegion::make(loops, breaks_u, breaks_v, options)");
  table.row("no breaks", invalid_argument, made(circle, {}, range));
  table.row("one break", invalid_argument, made(circle, range, {1}));
  table.row("breaks that decrease", invalid_argument, made(circle, {0, 1, 0.5}, range));
  table.row("NaN in a break", non_finite, made(circle, range, {0, not_a_number}));
  table.row("a break of 1e101", invalid_argument, made(circle, {0, 1e101}, range));
  table.row("breaks 1e-101 apart", invalid_argument, made(circle, {0, 1e-101}, range));
  table.row("a snap of NaN", invalid_argument, made(circle, range, range, {.snap = not_a_number}));
  table.row("a snap of 0.01", invalid_argument, made(circle, range, range, {.snap = 0.01}));
  table.row("a loop at 1e101", unsupported,
            made({test::circle({0.5, 0.5}, 0.25), test::circle({1e101, 0}, 1)}, range, range));
  table.row("a loop over 65 periods", unsupported,
            made({{{test::line({0, 0}, {65, 0})}, false}}, range, range, {.periodic_u = true}));
  table.of("TrimRegion::locate(u, v, sides)");
  const TrimRegion region = value_of(TrimRegion::make(circle, unit));
  const Numbers two{0.5, 0.5}, three{0.5, 0.5, 0.5};
  std::vector<TrimSide> sides(2, TrimSide::border);
  table.row("a v too many", count_mismatch, region.locate(two, three, sides),
            [&] { return std::ranges::count(sides, TrimSide::border) == 2; });
  const bool outside = region.locate(not_a_number, 0.5) == TrimSide::outside &&
                       region.locate(0.5, infinity) == TrimSide::outside &&
                       region.locate(1.5, 0.5) == TrimSide::outside;
  table.gives("NaN, infinity, a point beyond the domain", "outside", outside);
}

void loops_without_inside(Table& table) {
  const auto all = [](double, double) { return true; };
  table.of("TrimRegion::make: loops that enclose nothing");
  used(table, "no loops", {}, all, "");
  used(table, "a loop without curves", {{}}, all, "loop 0: it has no curves");
  used(table, "a loop that is a point", {{{test::line({0.5, 0.5}, {0.5, 0.5})}, false}}, all,
       "loop 0: all of its curves are points");
  used(table, "one straight line that does not come back", {{{test::line({0.25, 0.25}, {0.75, 0.625})}, false}}, all,
       "loop 0: a straight line closes a gap of 0.5 between curves 0 and 0; "
       "loop 0: it runs back over itself and encloses nothing, so it is ignored");
  used(table, "a straight line, forth and back",
       {{{test::line({0.25, 0.25}, {0.75, 0.625}), test::line({0.75, 0.625}, {0.25, 0.25})}, true}}, all,
       "loop 0: it runs back over itself and encloses nothing, so it is ignored");
  used(
      table, "a rectangle with a slit",
      {test::polygon({{0.1, 0.1}, {0.9, 0.1}, {0.9, 0.9}, {0.5, 0.9}, {0.5, 0.5}, {0.5, 0.9}, {0.1, 0.9}})},
      [](double u, double v) { return in_box(u, v, 0.1, 0.9, 0.1, 0.9); },
      "loop 0: 4 pieces of it that run over each other bound nothing and are dropped");
  used(table, "the domain's own sides", {test::rectangle(0, 1, 0, 1)}, all, "");
  used(
      table, "a loop twice", {test::rectangle(0.1, 0.9, 0.1, 0.9), test::rectangle(0.1, 0.9, 0.1, 0.9)},
      [](double, double) { return false; }, "");
}

void odd_loops(Table& table) {
  table.of("TrimRegion::make: loops that cross, touch or leave");
  const Curve arc =
      value_of(Curve::bezier(std::vector<Vec3>{{0.5, 0.25, 0}, {1.5, 1.25, 0}, {-0.5, 1.25, 0}, {0.5, 0.25, 0}}));
  const TrimRegion drop = value_of(TrimRegion::make(Loops{{{arc}, false}}, unit));
  used(
      table, "a loop of one curve", {{{arc}, false}},
      [&](double u, double v) { return drop.locate(u, v) == TrimSide::inside; }, "");
  used(
      table, "a loop that crosses itself", {test::polygon({{0.25, 0.25}, {0.75, 0.75}, {0.75, 0.25}, {0.25, 0.75}})},
      [](double u, double v) { return std::abs(v - 0.5) < std::abs(u - 0.5) && std::abs(u - 0.5) < 0.25; }, "");
  used(
      table, "loops that cross each other", {test::rectangle(0.1, 0.6, 0.1, 0.6), test::rectangle(0.4, 0.9, 0.4, 0.9)},
      [](double u, double v) { return in_box(u, v, 0.1, 0.6, 0.1, 0.6) != in_box(u, v, 0.4, 0.9, 0.4, 0.9); }, "");
  used(
      table, "a loop that stops short",
      {{{test::line({0.25, 0.25}, {0.75, 0.25}), test::line({0.75, 0.25}, {0.75, 0.75})}, false}},
      [](double u, double v) { return u < 0.75 && v > 0.25 && v < u; },
      "loop 0: a straight line closes a gap of 0.5 between curves 1 and 0");
  used(
      table, "a loop that leaves the domain", {test::rectangle(0.5, 1.5, 0.25, 0.75)},
      [](double u, double v) { return in_box(u, v, 0.5, 1, 0.25, 0.75); },
      "loop 0: it leaves the surface's domain by 0.5 and is cut off there");
  used(
      table, "a loop outside of the domain", {test::rectangle(2, 3, 2, 3)}, [](double, double) { return false; },
      "loop 0: it leaves the surface's domain by 2 and is cut off there");
  used(
      table, "a hole that touches the border of the domain", {test::circle({0.25, 0.5}, 0.25, true)},
      [](double u, double v) { return std::hypot(u - 0.25, v - 0.5) > 0.25; }, "");
  used(
      table, "holes that touch each other",
      {test::circle({0.25, 0.5}, 0.25, true), test::circle({0.75, 0.5}, 0.25, true)},
      [](double u, double v) { return std::hypot(std::min(std::abs(u - 0.25), std::abs(u - 0.75)), v - 0.5) > 0.25; },
      "");
  used(
      table, "holes alone, no outer loop", {test::rectangle(0.25, 0.75, 0.25, 0.75, true)},
      [](double u, double v) { return !in_box(u, v, 0.25, 0.75, 0.25, 0.75); }, "");
  used(
      table, "a hole whose outer loop comes last, both in one direction",
      {test::rectangle(0.25, 0.75, 0.25, 0.75, true), test::rectangle(0.1, 0.9, 0.1, 0.9)},
      [](double u, double v) { return in_box(u, v, 0.1, 0.9, 0.1, 0.9) && !in_box(u, v, 0.25, 0.75, 0.25, 0.75); }, "");
  const double apart = 1e-12;
  used(
      table, "loops 1e-12 apart",
      {test::rectangle(0.1, 0.9, 0.1, 0.9), test::rectangle(0.1 + apart, 0.9 - apart, 0.1 + apart, 0.9 - apart, true)},
      [](double, double) { return false; }, "");
  used(
      table, "loops along a line between patches", {test::rectangle(0.25, 0.5, 0, 1), test::rectangle(0.5, 0.75, 0, 1)},
      [](double u, double) { return u > 0.25 && u < 0.75; }, "");
  Loops sieve;
  for (int k = 0; k < 100; ++k)
    sieve.push_back(test::circle({0.45 + 0.0011 * (k % 10), 0.45 + 0.0011 * (k / 10)}, 5e-4, true));
  used(
      table, "a hundred holes in a cell", sieve,
      [](double u, double v) {
        const double x = (u - 0.45) / 0.0011, y = (v - 0.45) / 0.0011;
        const double du = u - 0.45 - 0.0011 * std::clamp(std::round(x), 0.0, 9.0);
        const double dv = v - 0.45 - 0.0011 * std::clamp(std::round(y), 0.0, 9.0);
        return std::hypot(du, dv) > 5e-4;
      },
      "");
}

void periodic_loops(Table& table) {
  table.of("TrimRegion::make: loops over seams and around poles");
  const TrimOptions around{.periodic_u = true}, torus{.periodic_u = true, .periodic_v = true};
  used(
      table, "a hole over a seam", {test::circle({1, 0.5}, 0.25, true)},
      [](double u, double v) { return std::hypot(std::min(u, 1 - u), v - 0.5) > 0.25; }, "", around);
  used(
      table, "a hole over the side of a surface without a seam", {test::circle({1, 0.5}, 0.25, true)},
      [](double u, double v) { return std::hypot(1 - u, v - 0.5) > 0.25; },
      "loop 0: it leaves the surface's domain by 0.25 and is cut off there");
  used(
      table, "a hole where both seams of a torus cross", {test::circle({0, 0}, 0.25, true)},
      [](double u, double v) { return std::hypot(std::min(u, 1 - u), std::min(v, 1 - v)) > 0.25; }, "", torus);
  used(
      table, "two loops around a cylinder",
      {{{test::line({0, 0.25}, {1, 0.25})}, false}, {{test::line({1, 0.75}, {0, 0.75})}, false}},
      [](double, double v) { return v > 0.25 && v < 0.75; }, "", around);
  used(
      table, "one loop around a pole", {{{test::line({0, 0.75}, {1, 0.75})}, false}},
      [](double, double v) { return v > 0.75; },
      "loop 0: it runs around the surface and no other loop closes it, so the part on its left is kept", around);
  used(
      table, "one loop around a pole, reversed", {{{test::line({1, 0.75}, {0, 0.75})}, false}},
      [](double, double v) { return v < 0.75; },
      "loop 0: it runs around the surface and no other loop closes it, so the part on its left is kept", around);
  used(
      table, "a loop up to a pole, along the seam and back", {test::polygon({{0, 0.5}, {1, 0.5}, {1, 1}, {0, 1}})},
      [](double, double v) { return v > 0.5; }, "", around);
  used(
      table, "a ball bounded by its seam", {{{test::line({0, 0}, {0, 1}), test::line({0, 1}, {0, 0})}, false}},
      [](double, double) { return true; }, "loop 0: it runs back over itself and encloses nothing, so it is ignored",
      around);
}

}  // namespace

void fill_trims(Table& table) {
  refused_loops(table);
  loops_without_inside(table);
  odd_loops(table);
  periodic_loops(table);
}

}  // namespace tessera::test
