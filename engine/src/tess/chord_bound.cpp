#include "tess/chord_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "surface/homogeneous.h"

namespace tessera {
namespace {

/// A net of homogeneous vectors, `[i][j]`.
struct Net {
  int rows = 0, columns = 0;
  std::array<Homogeneous, (max_degree + 1) * (max_degree + 1)> at;

  Net() = default;
  Net(const Net& other) { *this = other; }
  Net& operator=(const Net& other) {  // no more than there is
    rows = other.rows;
    columns = other.columns;
    std::copy_n(other.at.begin(), other.size(), at.begin());
    return *this;
  }
  int size() const { return rows * columns; }
  Homogeneous& operator()(int i, int j) { return at[static_cast<std::size_t>(i * columns + j)]; }
};

/// Cuts a Bezier curve of `count` points, `step` apart, at 1/2 by de Casteljau: the points become its upper half, and its
/// lower half goes to `low`.
void cut(Homogeneous* high, Homogeneous* low, int count, int step) {
  for (int k = 0; k < count; ++k) {
    low[k * step] = high[0];
    for (int i = 0; i + 1 < count - k; ++i) high[i * step] = 0.5 * high[i * step] + 0.5 * high[(i + 1) * step];
  }
}

/// The quarters [low or high u][low or high v] of a net.
void cut(const Net& net, Net (&quarter)[2][2]) {
  Net high = net, low = net;
  for (int j = 0; j < net.columns; ++j) cut(&high(0, j), &low(0, j), net.rows, net.columns);
  for (int half = 0; half < 2; ++half) {
    quarter[half][0] = quarter[half][1] = half == 0 ? low : high;
    for (int i = 0; i < net.rows; ++i) cut(&quarter[half][1](i, 0), &quarter[half][0](i, 0), net.columns, 1);
  }
}

/// The Bezier nets of the second derivatives of the homogeneous patch.
struct Derivatives {
  Net uu, uv, vv;
};

Derivatives differentiate(const HomogeneousNet& net) {
  const int m = net.degree_u, n = net.degree_v;
  Derivatives d;
  d.uu.rows = m - 1;
  d.uu.columns = n + 1;
  d.uv.rows = m;
  d.uv.columns = n;
  d.vv.rows = m + 1;
  d.vv.columns = n - 1;
  for (int i = 0; i <= m; ++i)
    for (int j = 0; j <= n; ++j) {
      const Homogeneous& a = net.at(i, j);
      if (i + 2 <= m) d.uu(i, j) = m * (m - 1.0) * ((net.at(i + 2, j) - net.at(i + 1, j)) - (net.at(i + 1, j) - a));
      if (i < m && j < n)
        d.uv(i, j) = m * double(n) * ((net.at(i + 1, j + 1) - net.at(i + 1, j)) - (net.at(i, j + 1) - a));
      if (j + 2 <= n) d.vv(i, j) = n * (n - 1.0) * ((net.at(i, j + 2) - net.at(i, j + 1)) - (net.at(i, j + 1) - a));
    }
  return d;
}

/// Where a rational piece lies: its points are within `radius` of `centre`, its weights at least `lightest`. A polynomial
/// one has radius 0, which leaves the derivatives as they are.
struct Place {
  Vec3 centre;
  double radius = 0, lightest = 1;
};

/// What a piece takes from the quarters that it is made of: bit 2 i + j stands for quarter [i][j].
constexpr unsigned quarters_of_piece[9] = {0b1111, 0b0011, 0b1100, 0b0101, 0b1010, 0b0001, 0b0010, 0b0100, 0b1000};

template <class Visit>
void for_quarters(unsigned piece, Visit visit) {
  for (int k = 0; k < 4; ++k)
    if (piece >> k & 1u) visit(k / 2, k % 2);
}

Place place_of(Net (&quarter)[2][2], unsigned piece) {
  Place place;
  place.lightest = std::numeric_limits<double>::infinity();
  Box3 box;
  for_quarters(piece, [&](int i, int j) {
    for (int k = 0; k < quarter[i][j].size(); ++k) {
      const Homogeneous& a = quarter[i][j].at[static_cast<std::size_t>(k)];
      box.extend(a.project());
      place.lightest = std::min(place.lightest, a.w);
    }
  });
  place.centre = box.centre();
  place.radius = 0.5 * box.diagonal();
  return place;
}

double largest(Net (&quarter)[2][2], unsigned piece, const Place& place) {
  double most = 0;
  for_quarters(piece, [&](int i, int j) {
    for (int k = 0; k < quarter[i][j].size(); ++k) {
      const Homogeneous& a = quarter[i][j].at[static_cast<std::size_t>(k)];
      const double size = length(a.vector() - a.w * place.centre) + place.radius * std::abs(a.w);
      most = !(size <= most) ? size : most;  // NaN wins
    }
  });
  return most / place.lightest;
}

/// What largest() measures: vectors, each with a ball around it.
struct Vectors {
  struct Ball {
    Vec3 centre;
    double radius, size;
  };
  std::array<Ball, std::size_t{4} * (most_product_degree + 1) * (most_product_degree + 1)> balls;
  std::size_t count = 0;

  Vectors(Net (&quarter)[2][2], unsigned piece, const Place& place) {
    for_quarters(piece, [&](int i, int j) {
      for (int k = 0; k < quarter[i][j].size(); ++k) {
        const Homogeneous& a = quarter[i][j].at[static_cast<std::size_t>(k)];
        const Vec3 centre = (1 / place.lightest) * (a.vector() - a.w * place.centre);
        balls[count++] = {centre, place.radius * std::abs(a.w) / place.lightest, length(centre)};
      }
    });
  }
};

/// The largest product of vectors in balls of both, or its largest size.
double largest_product(const Vectors& a, const Vectors& b, bool size) {
  if (a.count == 0 || b.count == 0) return 0;
  double most = -std::numeric_limits<double>::infinity();
  for (const Vectors::Ball& p : std::span(a.balls.data(), a.count))
    for (const Vectors::Ball& q : std::span(b.balls.data(), b.count)) {
      const double product = dot(p.centre, q.centre);
      const double reach = p.size * q.radius + q.size * p.radius + p.radius * q.radius;
      const double largest = (size ? std::abs(product) : product) + reach;
      most = !(largest <= most) ? largest : most;  // NaN wins
    }
  return most;
}

/// The smallest t >= 1 with a + b / t + c / t^2 <= limit, a <= limit; infinite if there is none.
double smallest_rate(double a, double b, double c, double limit) {
  const double room = limit - a;
  if (b == 0 && c == 0) return 1;
  if (!(room > 0)) return std::numeric_limits<double>::infinity();
  return std::max(1.0, (b + std::sqrt(b * b + 4 * room * c)) / (2 * room));
}

}  // namespace

ChordBound::ChordBound(const BezierPatch& patch, bool products) {
  const HomogeneousNet net(patch, patch.point(0, 0));
  Derivatives whole = differentiate(net);
  Net uu[2][2], uv[2][2], vv[2][2];
  cut(whole.uu, uu);
  cut(whole.uv, uv);
  cut(whole.vv, vv);
  Net points[2][2];
  double size = 0, heaviest = 0;
  {
    Net all;
    all.rows = net.degree_u + 1;
    all.columns = net.degree_v + 1;
    for (std::size_t k = 0; k < net.size(); ++k) {
      all.at[k] = net.points[k];
      size = std::max(size, max_abs(net.points[k].vector()));
      heaviest = std::max(heaviest, net.points[k].w);
    }
    if (patch.is_rational()) cut(all, points);
  }
  // Each difference of four coefficients, the translation and the cuts round by less than 16 units of what enters.
  const double m = net.degree_u, n = net.degree_v;
  for (std::size_t k = 0; k < pieces_.size(); ++k) {
    const unsigned piece = quarters_of_piece[k];
    const Place place = patch.is_rational() ? place_of(points, piece) : Place{};
    const double entering = size + heaviest * (max_abs(place.centre) + place.radius);
    const double rounding = 0x1p-46 * entering / place.lightest;
    const double scale = net.scale * (1 + 0x1p-40);
    pieces_[k] = {scale * (largest(uu, piece, place) + (m > 1 ? m * (m - 1) * rounding : 0)),
                  scale * (largest(uv, piece, place) + m * n * rounding),
                  scale * (largest(vv, piece, place) + (n > 1 ? n * (n - 1) * rounding : 0))};
    for (double* bound : {&pieces_[k].uu, &pieces_[k].uv, &pieces_[k].vv})
      if (std::isnan(*bound)) *bound = std::numeric_limits<double>::infinity();
    if (!products || std::max(net.degree_u, net.degree_v) > most_product_degree) continue;
    // What was added to the bounds was that for a vector's error, and a product's errors are those with the other vector.
    const Vectors a(uu, piece, place), b(uv, piece, place), c(vv, piece, place);
    const auto bound = [&](double product, double x, double y, double degrees) {
      return scale * scale * product + 0x1p-38 * x * y + scale * degrees * rounding * (x + y);
    };
    SecondDerivatives& d = pieces_[k];
    const double of_uu = m * m, of_uv = m * n, of_vv = n * n;
    d.uu_vv = bound(largest_product(a, c, false), d.uu, d.vv, std::max(of_uu, of_vv));
    d.uu_uv = bound(largest_product(a, b, true), d.uu, d.uv, std::max(of_uu, of_uv));
    d.uv_vv = bound(largest_product(b, c, true), d.uv, d.vv, std::max(of_uv, of_vv));
    for (double* product : {&d.uu_vv, &d.uu_uv, &d.uv_vv})
      if (std::isnan(*product)) *product = std::numeric_limits<double>::infinity();
  }
}

double ChordBound::distance(Rates rates) const {
  const Split split = splits_[rates.u % 2 == 0][rates.v % 2 == 0];
  double most = 0;
  for (int k = split.first; k < split.first + split.count; ++k)
    most = std::max(most, pieces_[static_cast<std::size_t>(k)].chord(rates));
  return most;
}

double ChordBound::needed(double tolerance, int fixed, bool fixed_u, bool even) const {
  const double h = 1.0 / fixed + 0x1p-24;
  const bool fixed_even = fixed % 2 == 0;
  const Split split = fixed_u ? splits_[fixed_even][even] : splits_[even][fixed_even];
  double needed = 1;
  for (int k = split.first; k < split.first + split.count; ++k) {
    const SecondDerivatives& d = pieces_[static_cast<std::size_t>(k)];
    needed = std::max(
        needed, smallest_rate(h * h * (fixed_u ? d.uu : d.vv), 2 * h * d.uv, fixed_u ? d.vv : d.uu, 8 * tolerance));
  }
  return needed;
}

std::optional<Rates> ChordBound::with_rate(double tolerance, int fixed, bool fixed_u, int most) const {
  std::optional<Rates> best;
  for (const bool even : {false, true}) {
    const double least = needed(tolerance, fixed, fixed_u, even);
    if (!(least <= most)) continue;
    int rate = static_cast<int>(std::ceil(least));
    if ((rate % 2 == 0) != even) ++rate;
    const auto rates = [&] { return fixed_u ? Rates{fixed, rate} : Rates{rate, fixed}; };
    if (!(distance(rates()) <= tolerance)) rate += 2;  // the root was rounded, or the parameters are
    // By the products it may be less.
    for (int low = even ? 0 : -1; std::isfinite(pieces_[0].uu_vv) && rate - low > 2;) {
      const int high = rate;
      rate = low + (high - low) / 4 * 2;
      if (!(distance(rates()) <= tolerance)) low = rate, rate = high;
    }
    if (rate <= most && distance(rates()) <= tolerance && (!best || rate < (fixed_u ? best->v : best->u)))
      best = rates();
  }
  return best;
}

std::optional<Rates> ChordBound::cheapest(double tolerance, int most) const {
  std::optional<Rates> best;
  double least = std::numeric_limits<double>::infinity();
  // Over real rates the fewest cells have h^2 uu = k^2 vv, hence 4 tolerance = h^2 (uu + uv sqrt(uu / vv)). Whole numbers
  // and halves move the minimum a little: walk from there both ways, over the smaller rate, whose steps are the larger.
  const SecondDerivatives& d = pieces_[0];
  const bool fixed_u = d.uu <= d.vv;
  const double small = fixed_u ? d.uu : d.vv, large = fixed_u ? d.vv : d.uu;
  const double start = large > 0 ? std::sqrt((small + d.uv * std::sqrt(small / large)) / (4 * tolerance)) : 1;
  const auto attempt = [&](int rate) {
    const std::optional<Rates> rates = with_rate(tolerance, rate, fixed_u, most);
    if (!rates || !(double(rates->u) * rates->v < least)) return false;
    least = double(rates->u) * rates->v;
    best = rates;
    return true;
  };
  const int middle = start < most ? std::max(static_cast<int>(start), 1) : most;
  constexpr int patience = 4;
  for (const int step : {1, -1})
    for (int rate = step > 0 ? middle : middle - 1, left = patience; left > 0 && rate >= 1 && rate <= most;
         rate += step)
      left = attempt(rate) ? patience : left - 1;
  for (int rate = 1; rate <= patience; ++rate)
    if (rate <= most) attempt(rate);
  if (!best) attempt(most);
  return best;
}

}  // namespace tessera
