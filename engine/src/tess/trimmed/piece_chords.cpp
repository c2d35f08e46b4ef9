#include "tess/trimmed/piece_chords.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr int max_depth = 20;    // of halves
constexpr int max_count = 1024;  // of even parts

/// The parameter of a net at a share of it, where weights w_k c^k would be equal at both ends.
double share_at(double share, double c) { return c * share / (1 - share + c * share); }

/// Divides a piece at x, 0 < x < 1: `piece` becomes the part before. Returns the part after it.
TrimPiece divide_at(TrimPiece& piece, double x) {
  TrimPiece after = piece;
  const ParameterPoint origin = piece.start();
  const double y = 1 - x;
  const std::size_t last = piece.curve.points.size() - 1;
  const bool rational = !piece.curve.weights.empty();
  std::array<double, max_degree + 1> u, v, w;
  for (std::size_t k = 0; k <= last; ++k) {
    w[k] = piece.curve.weight(k);
    u[k] = w[k] * (piece.curve.points[k].u - origin.u);
    v[k] = w[k] * (piece.curve.points[k].v - origin.v);
  }
  const auto point = [&](std::size_t k) {
    return ParameterPoint{std::clamp(origin.u + u[k] / w[k], piece.lower_u(), piece.upper_u()),
                          std::clamp(origin.v + v[k] / w[k], piece.lower_v(), piece.upper_v())};
  };
  std::array<ParameterPoint, max_degree + 1> before;
  std::array<double, max_degree + 1> before_weights;
  for (std::size_t level = 1; level <= last; ++level) {
    for (std::size_t k = 0; k + level <= last; ++k)
      u[k] = y * u[k] + x * u[k + 1], v[k] = y * v[k] + x * v[k + 1], w[k] = y * w[k] + x * w[k + 1];
    before[level] = point(0), before_weights[level] = w[0];
  }
  for (std::size_t k = 0; k < last; ++k) {
    after.curve.points[k] = point(k);
    piece.curve.points[k + 1] = before[k + 1];
    if (!rational) continue;
    after.curve.weights[k] = w[k];
    piece.curve.weights[k + 1] = before_weights[k + 1];
  }
  const double middle = piece.range.from + x * (piece.range.to - piece.range.from);
  after.range.from = piece.range.to = middle;
  const auto rounding = [](double a, double b) { return 0x1p-51 * std::max(std::abs(a), std::abs(b)); };
  for (TrimPiece* const part : {&piece, &after}) {
    part->error.u += rounding(part->start().u, part->end().u);
    part->error.v += rounding(part->start().v, part->end().v);
    part->exact_line = false;
  }
  return after;
}

}  // namespace

// Parts of one piece between two stations are divided as they are; only parts that go on into other pieces become
// pieces.
double PieceChords::append(std::span<const TrimPiece> chain, const CurveStations& stations, const ChordLimits& limits,
                           std::vector<ParameterPoint>& points, std::vector<double>& parameters) {
  double most = 0;
  const auto end_parts = [&] {
    if (!parts_.empty()) most = std::max(most, append(parts_, limits, points, parameters));
    parts_.clear();
  };
  parts_.clear();
  auto station = std::ranges::upper_bound(stations.at, chain.front().range.from + stations.same);
  for (const TrimPiece& piece : chain) {
    const double from = piece.range.from, to = piece.range.to;
    while (station != stations.at.end() && *station <= from + stations.same) ++station;
    const auto first = station;
    while (station != stations.at.end() && *station < to - stations.same) ++station;
    const std::span<const double> inside(first, station);
    const bool ends = &piece == &chain.back() || (station != stations.at.end() && *station <= to + stations.same);
    if (inside.empty() && (!ends || !parts_.empty())) {
      parts_.push_back(piece);
      if (ends) end_parts();
      continue;
    }
    const auto place = [&](double t) { return (t - from) / (to - from); };
    std::size_t begin = 0, end = inside.size();  // of the stations between which parts are divided as they are
    TrimPiece rest = piece;
    double at = 0;
    if (!parts_.empty()) {
      at = place(inside[begin++]);
      TrimPiece after = divide_at(rest, at);
      parts_.push_back(std::move(rest));
      end_parts();
      rest = std::move(after);
    }
    begin_chords(limits, points, parameters);
    if (ends) {
      append_one(rest, inside.subspan(begin));
    } else if (begin < end) {
      const double last = place(inside[end - 1]);
      TrimPiece after = divide_at(rest, (last - at) / (1 - at));
      append_one(rest, inside.subspan(begin, end - 1 - begin));
      rest = std::move(after);
    }
    if (!ends) parts_.push_back(std::move(rest));
    most = std::max(most, most_);
  }
  end_parts();
  return most;
}

void PieceChords::begin_chords(const ChordLimits& limits, std::vector<ParameterPoint>& points,
                               std::vector<double>& parameters) {
  limits_ = &limits;
  points_ = &points;
  parameters_ = &parameters;
  most_ = 0;
}

double PieceChords::append(std::span<const TrimPiece> chain, const ChordLimits& limits,
                           std::vector<ParameterPoint>& points, std::vector<double>& parameters) {
  begin_chords(limits, points, parameters);
  while (!chain.empty()) {
    const std::size_t count = reach(chain);
    if (count == 1) {
      append_one(chain.front(), {});
    } else {
      most_ = std::max(most_, sliver_over(chain.first(count)).size);
      points.push_back(chain[count - 1].end());
      parameters.push_back(chain[count - 1].range.to);
    }
    chain = chain.subspan(count);
  }
  return most_;
}

std::size_t PieceChords::reach(std::span<const TrimPiece> chain) const {
  std::size_t fine = 1, next = 2;
  for (; next <= chain.size() && sliver_over(chain.first(next)).is_fine; next *= 2) fine = next;
  for (std::size_t most = std::min(next - 1, chain.size()); fine < most;) {
    const std::size_t middle = fine + (most - fine + 1) / 2;
    if (sliver_over(chain.first(middle)).is_fine)
      fine = middle;
    else
      most = middle - 1;
  }
  return fine;
}

// A chain that turns back in u or v may have one chord only if it turns little, so that a small hole stays one.
PieceChords::Sliver PieceChords::sliver_over(std::span<const TrimPiece> chain) const {
  const ParameterPoint start = chain.front().start(), end = chain.back().end();
  const ParameterPoint chord{end.u - start.u, end.v - start.v};
  const auto lies_between = [](double x, double a, double b) { return std::min(a, b) <= x && x <= std::max(a, b); };
  const auto turns_little = [&](const ParameterPoint& leg) {  // by at most 45 degrees
    const double along = leg.u * chord.u + leg.v * chord.v, across = leg.u * chord.v - leg.v * chord.u;
    return along > 0 && std::abs(across) <= along;
  };
  double cross = 0, error = 0;
  Feet feet;
  bool turns = false;
  for (const TrimPiece& piece : chain) {
    error = std::max(error, error_of(piece));
    ParameterPoint before = piece.start();
    for (const ParameterPoint& q : piece.curve.points) {
      cross = std::max(cross, std::abs(chord.u * (q.v - start.v) - chord.v * (q.u - start.u)));
      feet.along_u &= lies_between(q.v, start.v, end.v);
      feet.along_v &= lies_between(q.u, start.u, end.u);
      turns |= !(q == before || turns_little({q.u - before.u, q.v - before.v}));
      before = q;
    }
  }
  if (turns && !(feet.along_u && feet.along_v)) return {};
  return sliver_of(chord, cross, error, feet);
}

PieceChords::Sliver PieceChords::sliver_of(const ParameterPoint& chord, double cross, double error,
                                           const Feet& feet) const {
  const SpeedBound& speed = limits_->speed;
  const double du = std::abs(chord.u), dv = std::abs(chord.v);
  double sliver = 0;
  if (cross > 0) {
    sliver = speed.moved(dv, du) * cross / (du * du + dv * dv);
    if (feet.along_v && du > 0) sliver = std::min(sliver, speed.v * cross / du);
    if (feet.along_u && dv > 0) sliver = std::min(sliver, speed.u * cross / dv);
  }
  const bool is_straight = sliver <= limits_->bend * std::hypot(speed.u * du, speed.v * dv);
  return {sliver + error, is_straight && sliver <= sliver_room(error) && du <= limits_->box.u && dv <= limits_->box.v};
}

double PieceChords::sliver_room(double error) const {
  return std::max(limits_->sliver - error, limits_->sliver / 8);  // an error cannot be divided
}

double PieceChords::error_of(const TrimPiece& piece) const {
  return piece.error.u * limits_->speed.u + piece.error.v * limits_->speed.v;
}

void PieceChords::append_one(const TrimPiece& piece, std::span<const double> stations) {
  piece_ = &piece;
  degree_ = piece.curve.degree();
  error_ = error_of(piece);
  most_ = std::max(most_, error_);
  Net net, before;
  for (std::size_t k = 0; k <= static_cast<std::size_t>(degree_); ++k) {
    const double weight = piece.curve.weight(k);
    const ParameterPoint& point = piece.curve.points[k];
    net[k] = {weight * (point.u - piece.start().u), weight * (point.v - piece.start().v), weight};
  }
  double from = 0;
  for (const double station : stations) {
    const double at = (station - piece.range.from) / (piece.range.to - piece.range.from);
    split(net, (at - from) / (1 - from), before, net);
    divide(before, from, at, 0);
    from = at;
  }
  divide(net, from, 1, 0);
  points_->back() = piece.end();
}

// De Casteljau's algorithm; `high` may be the net itself.
void PieceChords::split(const Net& net, double x, Net& low, Net& high) const {
  const std::size_t last = static_cast<std::size_t>(degree_);
  const double y = 1 - x;
  high = net;
  low[0] = net[0];
  for (std::size_t level = 1; level <= last; ++level) {
    for (std::size_t k = 0; k + level <= last; ++k) {
      const Control &p = high[k], &q = high[k + 1];
      high[k] = {y * p.u + x * q.u, y * p.v + x * q.v, y * p.w + x * q.w};
    }
    low[level] = high[0];
  }
}

PieceChords::Sliver PieceChords::sliver_of(const Net& net, double balance) const {
  const std::size_t last = static_cast<std::size_t>(degree_);
  const ParameterPoint a = net[0].point(), b = net[last].point(), chord{b.u - a.u, b.v - a.v};
  double cross = 0;
  for (std::size_t k = 1; k < last; ++k) cross = std::max(cross, cross_of(chord, a, net[k]));
  return sliver_of(chord, cross * reach_of(net, balance), error_, {});
}

double PieceChords::cross_of(const ParameterPoint& chord, const ParameterPoint& start, const Control& q) {
  return std::abs(chord.u * (q.v / q.w - start.v) - chord.v * (q.u / q.w - start.u));
}

// The control points of both halves lie nearer to the curve than its own.
void PieceChords::divide(const Net& net, double from, double to, int depth) {
  const std::size_t last = static_cast<std::size_t>(degree_);
  const ParameterPoint a = net[0].point(), b = net[last].point();
  const ParameterPoint chord{b.u - a.u, b.v - a.v};
  const double balance = this->balance(net);
  const Sliver whole = sliver_of(net, balance);
  const bool is_cancelled = limits_->cancel && limits_->cancel->load(std::memory_order_relaxed);
  if (whole.is_fine || depth >= max_depth || is_cancelled) return put(b, to, whole);
  Net low, high;
  split(net, share_at(0.5, balance), low, high);
  double cross = 0;
  for (std::size_t k = 1; k <= last; ++k)
    cross = std::max({cross, cross_of(chord, a, low[k]), cross_of(chord, a, high[k - 1])});
  const Sliver sliver = sliver_of(chord, cross, error_, {});
  if (sliver.is_fine) return put(b, to, sliver);
  int count = count_for(chord, std::min(whole.size, sliver.size));
  for (int attempt = 0; attempt < 3 && count < max_count && !is_fine(net, count); ++attempt) ++count;
  divide_evenly(net, from, to, depth + std::bit_width(static_cast<unsigned>(count - 1)), count);
}

// A sliver shrinks with the square of the length of its chord.
int PieceChords::count_for(const ParameterPoint& chord, double sliver) const {
  const SpeedBound& speed = limits_->speed;
  const double du = std::abs(chord.u), dv = std::abs(chord.v), size = std::max(sliver - error_, 0.0);
  const double most = std::max({std::sqrt(size / sliver_room(error_)), du / limits_->box.u, dv / limits_->box.v,
                                size / (limits_->bend * std::hypot(speed.u * du, speed.v * dv))});
  return most < max_count ? std::max(2, static_cast<int>(std::ceil(most))) : max_count;
}

bool PieceChords::is_fine(const Net& net, int count) const {
  const double balance = this->balance(net);
  if (count == 1) return sliver_of(net, balance).is_fine;
  Net low, high;
  split(net, share_at(double(count / 2) / count, balance), low, high);
  return is_fine(low, count / 2) && is_fine(high, count - count / 2);
}

void PieceChords::divide_evenly(const Net& net, double from, double to, int depth, int count) {
  if (count == 1) return divide(net, from, to, depth);
  const double x = share_at(double(count / 2) / count, balance(net)), middle = from + x * (to - from);
  Net low, high;
  split(net, x, low, high);
  divide_evenly(low, from, middle, depth, count / 2);
  divide_evenly(high, middle, to, depth, count - count / 2);
}

double PieceChords::balance(const Net& net) const {
  const double ratio = net[0].w / net[static_cast<std::size_t>(degree_)].w;
  return ratio == 1 ? 1 : degree_ == 2 ? std::sqrt(ratio) : std::pow(ratio, 1.0 / degree_);
}

// With weights w at both ends, let W be the largest inside. At t the Bernstein values inside have the sum
// 1 - t^n - (1-t)^n, at most 1 - 2^(1-n), and their share of all weights grows with it.
double PieceChords::reach_of(const Net& net, double balance) const {
  double inside = 0, scale = balance;
  for (std::size_t k = 1; k < static_cast<std::size_t>(degree_); ++k, scale *= balance)
    inside = std::max(inside, scale * net[k].w);
  const double ends = std::ldexp(1.0, 1 - degree_), rest = 1 - ends;
  return inside * rest / (inside * rest + net[0].w * ends);
}

// Points are kept within the box of the piece, which rounding could leave, so they never pass a line between patches.
void PieceChords::put(const ParameterPoint& end, double to, const Sliver& sliver) {
  most_ = std::max(most_, sliver.size);
  const TrimPiece& piece = *piece_;
  points_->push_back({std::clamp(piece.start().u + end.u, piece.lower_u(), piece.upper_u()),
                      std::clamp(piece.start().v + end.v, piece.lower_v(), piece.upper_v())});
  parameters_->push_back(piece.range.from + to * (piece.range.to - piece.range.from));
}

}}  // namespace tessera::abi_0_1
