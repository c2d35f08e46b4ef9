#include <algorithm>
#include <cmath>
#include <cstdio>

#include "roofline/canvas.h"
#include "roofline/roofline.h"

namespace tessera::bench {
namespace {

constexpr Colour paper{250, 250, 247}, ink{35, 39, 46}, faint{222, 222, 216}, cache_blue{38, 99, 173},
    memory_orange{201, 98, 28};
constexpr int width = 1200, height = 760, left = 110, right = 1160, top = 70, bottom = 680;

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", x);
  return text;
}

/// Logarithmic axes: operations per byte to the right, G operations per second upwards.
class Chart {
 public:
  Chart(Canvas& canvas, double highest) : canvas_(canvas), y_to_(2 * highest), y_from_(highest / 200) {}

  double x(double per_byte) const {
    return left + (right - left) * std::log(per_byte / x_from) / std::log(x_to / x_from);
  }
  double y(double operations) const {
    return bottom - (bottom - top) * std::log(operations / y_from_) / std::log(y_to_ / y_from_);
  }

  void axes() {
    for (const double tick : {0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0}) {
      canvas_.line(x(tick), top, x(tick), bottom, faint);
      canvas_.text(x(tick) - 0.5 * Canvas::text_width(number(tick)), bottom + 12, number(tick), ink);
    }
    for (double decade = 1e-3; decade < y_to_; decade *= 10)
      for (const double step : {1.0, 2.0, 5.0}) {
        const double tick = decade * step;
        if (tick < y_from_ || tick > y_to_) continue;
        canvas_.line(left, y(tick), right, y(tick), faint);
        canvas_.text(left - 12 - Canvas::text_width(number(tick)), y(tick) - 7, number(tick), ink);
      }
    canvas_.line(left, top, left, bottom, ink, 2);
    canvas_.line(left, bottom, right, bottom, ink, 2);
    const std::string below = "multiply-adds a byte written";
    canvas_.text(0.5 * (left + right - Canvas::text_width(below)), bottom + 40, below, ink);
    canvas_.text(20, top - 28, "G multiply-adds/s, one thread", ink);
  }

  /// Draws min(peak, bandwidth * operations per byte).
  void roof(double peak, double bandwidth, Colour colour, const std::string& label, bool label_below) {
    const double edge = peak / bandwidth, from = std::max(x_from, y_from_ / bandwidth);
    canvas_.line(x(from), y(bandwidth * from), x(std::min(edge, x_to)), y(bandwidth * std::min(edge, x_to)), colour,
                 2.5);
    if (edge < x_to) canvas_.line(x(edge), y(peak), right, y(peak), colour, 2.5);
    const double at = std::sqrt(from * std::min(edge, x_to));  // the middle of the slope
    canvas_.text(label_below ? x(at) + 12 : x(at) - Canvas::text_width(label) - 12,
                 y(bandwidth * at) + (label_below ? 6 : -18), label, colour);
  }
  void peak(double peak, const std::string& label) {
    canvas_.line(x(0.5), y(peak), right, y(peak), ink);
    canvas_.text(right - Canvas::text_width(label) - 6, y(peak) - 20, label, ink);
  }
  void point(const RooflinePoint& p) {
    const double px = x(std::clamp(p.per_byte, x_from, x_to)), py = y(std::clamp(p.operations * 1e-9, y_from_, y_to_));
    const Colour colour = p.in_cache ? cache_blue : memory_orange;
    canvas_.disc(px, py, 7, colour);
    // Positions and positions + r_u + r_v have the same operations per byte.
    const bool to_the_left = p.name == "+ du + dv";
    canvas_.text(to_the_left ? px - Canvas::text_width(p.name) - 12 : px + 12, py - 7, p.name, colour);
  }

 private:
  static constexpr double x_from = 0.1, x_to = 10;
  Canvas& canvas_;
  double y_to_, y_from_;
};

}  // namespace

Status draw_roofline(const Roofline& roofline, const std::string& path) {
  Canvas canvas(width, height, paper);
  canvas.text(20, 14, roofline.machine, ink);
  const Limits& fastest = roofline.isas.back();
  const double peak = 1e-9 * fastest.float_operations_per_second;
  Chart chart(canvas, peak);
  chart.axes();
  for (const Limits& limits : roofline.isas)
    chart.peak(1e-9 * limits.float_operations_per_second, std::string(name(limits.isa)));
  const double memory = 1e-9 * fastest.store_bytes_per_second, cache = 1e-9 * roofline.cache_store;
  chart.roof(peak, cache, cache_blue, number(cache) + " GB/s to the cache", false);
  chart.roof(peak, memory, memory_orange, number(memory) + " GB/s to memory", true);
  for (const RooflinePoint& point : roofline.points) chart.point(point);
  return render::write_png(canvas.image(), path);
}

}  // namespace tessera::bench
