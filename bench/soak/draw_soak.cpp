#include <algorithm>
#include <cstdio>

#include "soak/canvas.h"
#include "soak/soak.h"

namespace tessera::bench {
namespace {

constexpr Colour paper{250, 250, 247}, ink{35, 39, 46}, faint{222, 222, 216}, blue{38, 99, 173};
constexpr int width = 1000, height = 560, left = 110, right = 960, top = 60, bottom = 490;

std::string number(double x, const char* format = "%.4g") {
  char text[32];
  std::snprintf(text, sizeof text, format, x);
  return text;
}

void axes(Canvas& canvas, double minutes, double highest) {
  for (int k = 0; k <= 5; ++k) {
    const double x = left + (right - left) * k / 5.0, y = bottom - (bottom - top) * k / 5.0;
    canvas.line(x, top, x, bottom, faint);
    canvas.line(left, y, right, y, faint);
    const std::string time = number(minutes * k / 5), size = number(highest * k / 5);
    canvas.text(x - 0.5 * Canvas::text_width(time), bottom + 12, time, ink);
    canvas.text(left - 12 - Canvas::text_width(size), y - 7, size, ink);
  }
  canvas.line(left, top, left, bottom, ink, 2);
  canvas.line(left, bottom, right, bottom, ink, 2);
  canvas.text(0.5 * (left + right - Canvas::text_width("minutes")), bottom + 40, "minutes", ink);
}

}  // namespace

double growth_per_hour(const std::vector<SoakSample>& samples) {
  double count = 0, t = 0, y = 0, tt = 0, ty = 0;
  for (std::size_t k = samples.size() / 2; k < samples.size(); ++k) {
    const double hours = samples[k].seconds / 3600;
    count += 1;
    t += hours;
    y += samples[k].resident;
    tt += hours * hours;
    ty += hours * samples[k].resident;
  }
  const double spread = count * tt - t * t;
  return spread > 0 ? (count * ty - t * y) / spread : 0;
}

Status draw_soak(const std::vector<SoakSample>& samples, const std::string& path) {
  Canvas canvas(width, height, paper);
  double highest = 1;
  for (const SoakSample& sample : samples) highest = std::max(highest, 1.25 * sample.resident);
  const double minutes = samples.empty() ? 1 : std::max(1.0 / 60, samples.back().seconds / 60);
  canvas.text(20, 16,
              "resident memory, MiB: " + number(growth_per_hour(samples), "%+.2f") + " MiB per hour in the second half",
              ink);
  axes(canvas, minutes, highest);
  const auto x = [&](const SoakSample& s) { return left + (right - left) * s.seconds / 60 / minutes; };
  const auto y = [&](const SoakSample& s) { return bottom - (bottom - top) * s.resident / highest; };
  for (std::size_t k = 1; k < samples.size(); ++k)
    canvas.line(x(samples[k - 1]), y(samples[k - 1]), x(samples[k]), y(samples[k]), blue, 2);
  return render::write_png(canvas.image(), path);
}

}  // namespace tessera::bench
