#include "ray/tube/edge_tubes.h"

#include <algorithm>
#include <array>
#include <atomic>

#include "parallel/parallel_for.h"
#include "ray/tube/centre_curve.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr std::size_t edges_per_task = 8;
constexpr int samples = 4;               // intervals of a piece between them
constexpr double margin = 2;             // of gaps beyond what samples show
constexpr double flat = 1.0 / 32;        // share of a chord's length that its curve may leave it
constexpr int max_halvings = 6;          // of a piece
constexpr std::size_t max_centres = 8;   // that are tried at a vertex
constexpr std::uint32_t max_chords = 4;  // of a tube

double share_of(int k) { return static_cast<double>(k) / samples; }

/// Bounds the curve's distance from its chord by second differences of points at even parameters, with a margin of 1.5.
double off_chord(const std::array<Vec3, samples + 1>& at) {
  double largest = 0;
  for (std::size_t k = 1; k < samples; ++k) largest = std::max(largest, length(at[k - 1] - 2 * at[k] + at[k + 1]));
  return 1.5 * samples * samples / 8.0 * largest;
}

}  // namespace

/// The additions of one edge.
struct EdgeTubes::EdgeParts {
  std::vector<TubeChord> chords;
  std::vector<double> measured;
  std::vector<EdgeEnd> ends;
};

bool EdgeTubes::needs_tube(std::size_t edge, const LazyAdjacency& borders) const {
  return curves_->meet(edge) && !curves_->edge(edge).degenerate && !curves_->is_joined(edge, borders.of(*set_));
}

void EdgeTubes::place(const EdgeStretch& stretch, TubeChord& chord) const {
  std::array<Vec3, samples + 1> at;
  for (int k = 0; k <= samples; ++k)
    at[static_cast<std::size_t>(k)] =
        curves_->at_place(stretch, (1 - share_of(k)) * chord.from + share_of(k) * chord.to).position;
  chord.start = at.front(), chord.end = at.back();
  chord.off = off_chord(at);
}

void EdgeTubes::cut(const EdgeStretch& stretch, std::uint32_t index, double from, double to, int depth,
                    std::vector<TubeChord>& chords) const {
  TubeChord chord{stretch.piece, stretch.patch, index, from, to, {}, {}, 0};
  place(stretch, chord);
  if (depth == max_halvings || chord.off <= flat * length(chord.end - chord.start)) {
    chords.push_back(chord);
    return;
  }
  const double middle = (from + to) / 2;
  cut(stretch, index, from, middle, depth + 1, chords);
  cut(stretch, index, middle, to, depth + 1, chords);
}

/// Measures the distances of other faces' points from the first curve: at its own samples, and at theirs.
void EdgeTubes::measure(std::size_t edge, std::span<const EdgeCurve> curves, std::span<const TubeChord> chords,
                        std::span<double> measured) const {
  if (chords.empty()) return;
  const PatchEdges::Edge& of = curves_->edge(edge);
  const CentreCurve centre(*curves_, curves[0], chords);
  std::ranges::fill(measured, 0.0);
  const auto note = [&](const LoopPoint& point, double s) {
    const bool is_end = is_same(of, s, of.range.from) || is_same(of, s, of.range.to);
    const CentreCurve::Place place = is_end ? centre.at(s) : centre.nearest(point, s);
    const double distance = place.distance(point);
    for (const std::size_t k : {place.chord, centre.chord_of(s)}) measured[k] = std::max(measured[k], distance);
  };
  for (std::size_t k = 0; k < chords.size(); ++k)
    for (int n = 0; n <= samples; ++n) {
      const double x = (1 - share_of(n)) * chords[k].from + share_of(n) * chords[k].to;
      const double s = curves_->parameter(curves[0][chords[k].stretch], x);
      for (const EdgeCurve& other : curves.subspan(1)) {
        if (const EdgeStretch* const stretch = EdgeCurves::stretch_at(other, of, s)) {
          note(curves_->at(*stretch, s), s);
        } else {  // a gap that nothing closes: the ends beside it stand for it
          measured[k] = std::max(measured[k], centre.at(s).distance(curves_->at(other, s)));
        }
      }
    }
  for (const EdgeCurve& other : curves.subspan(1))
    for (const EdgeStretch& stretch : other)
      for (int n = 0; n <= samples; ++n) {
        const double x = stretch.place(share_of(n));
        note(curves_->at_place(stretch, x), curves_->parameter(stretch, x));
      }
}

void EdgeTubes::add_ends(std::size_t edge, std::span<const EdgeCurve> curves, std::vector<EdgeEnd>& ends) const {
  const PatchEdges::Edge& of = curves_->edge(edge);
  for (const EdgeCurve& curve : curves)
    for (const bool at_start : {true, false}) {
      const std::uint32_t vertex = at_start ? of.start : of.end;
      const EdgeStretch& stretch = at_start ? curve.front() : curve.back();
      const double s = at_start ? stretch.low() : stretch.high();
      const double x = s == stretch.from ? stretch.begin : stretch.end;
      if (vertex == no_id || !is_same(of, s, at_start ? of.range.from : of.range.to)) continue;
      const LoopPoint point = curves_->at_place(stretch, x);
      ends.push_back(
          {vertex, static_cast<std::uint32_t>(edge), at_start, &curve == curves.data(), point.position, point.unsure});
    }
}

/// Adds points of an edge that is a point.
void EdgeTubes::add_lines(std::size_t edge, std::span<const EdgeCurve> curves, std::vector<EdgeEnd>& ends) const {
  const std::uint32_t vertex = curves_->edge(edge).start;
  if (vertex == no_id) return;
  for (const EdgeCurve& curve : curves)
    for (const EdgeStretch& stretch : curve)
      for (int k = 0; k <= samples; ++k) {
        const LoopPoint point = curves_->at_place(stretch, stretch.place(share_of(k)));
        ends.push_back({vertex, static_cast<std::uint32_t>(edge), true, false, point.position, point.unsure});
      }
}

EdgeTubes::EdgeParts EdgeTubes::parts_of(std::size_t edge) const {
  EdgeParts parts;
  const std::vector<EdgeCurve> curves = curves_->of(edge);
  if (curves.empty()) return parts;
  if (curves_->edge(edge).degenerate) {
    add_lines(edge, curves, parts.ends);
    return parts;
  }
  add_ends(edge, curves, parts.ends);
  for (std::uint32_t k = 0; k < curves[0].size(); ++k) {
    const EdgeStretch& stretch = curves[0][k];
    const bool grows = stretch.from <= stretch.to;
    cut(stretch, k, grows ? stretch.begin : stretch.end, grows ? stretch.end : stretch.begin, 0, parts.chords);
  }
  parts.measured.resize(parts.chords.size());
  measure(edge, curves, parts.chords, parts.measured);
  return parts;
}

Status EdgeTubes::build(const SetView& set, const SceneFrame& frame, const LazyAdjacency& borders, double least,
                        const Execution& execution) {
  clear();
  if (!set.impl().edges) return {};
  set_ = &set, frame_ = frame;
  curves_.emplace(set, frame);
  const std::size_t count = curves_->edge_count();
  std::vector<EdgeParts> parts(count);
  const Execution quiet{.cancel = execution.cancel};
  const auto make = [&](std::size_t begin, std::size_t end) {
    for (std::size_t edge = begin; edge < end; ++edge) {
      parts[edge] = parts_of(edge);
      if (!needs_tube(edge, borders)) parts[edge].chords.clear(), parts[edge].measured.clear();
    }
  };
  if (Status status = parallel_for(count, edges_per_task, quiet, make); !status.ok()) return status;
  for (EdgeParts& of : parts) {
    first_chord_.push_back(static_cast<std::uint32_t>(chords_.size()));
    chords_.insert(chords_.end(), of.chords.begin(), of.chords.end());
    measured_.insert(measured_.end(), of.measured.begin(), of.measured.end());
    ends_.push_back(std::move(of.ends));
  }
  first_chord_.push_back(static_cast<std::uint32_t>(chords_.size()));
  ends_.emplace_back();
  group();
  set_gaps(least);
  return {};
}

Result<bool> EdgeTubes::update(std::span<const std::uint32_t> patches, const LazyAdjacency& borders, double least,
                               const Execution& execution) {
  if (!curves_) return true;
  std::vector<bool> marks(set_->patch_count());
  for (const std::uint32_t patch : patches) marks[patch] = true;
  std::vector<std::size_t> touched;
  for (std::size_t edge = 0; edge < curves_->edge_count(); ++edge) {
    if (!curves_->has_marked(edge, marks)) continue;
    if (needs_tube(edge, borders) && first_chord_[edge] == first_chord_[edge + 1]) return false;
    touched.push_back(edge);
  }
  const Execution quiet{.cancel = execution.cancel};
  std::atomic<bool> are_same = true;
  const auto measure_again = [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const std::size_t edge = touched[k];
      const std::vector<EdgeCurve> curves = curves_->of(edge);
      const std::span<TubeChord> chords =
          std::span(chords_).subspan(first_chord_[edge], first_chord_[edge + 1] - first_chord_[edge]);
      const auto is_there = [&](const TubeChord& chord) {
        return chord.stretch < curves[0].size() && curves[0][chord.stretch].piece == chord.piece;
      };
      if (!std::ranges::all_of(chords, is_there)) {  // lines that close gaps are divided elsewhere
        are_same = false;
        continue;
      }
      for (TubeChord& chord : chords) place(curves[0][chord.stretch], chord);
      measure(edge, curves, chords, std::span(measured_).subspan(first_chord_[edge], chords.size()));
      ends_[edge].clear();
      curves_->edge(edge).degenerate ? add_lines(edge, curves, ends_[edge]) : add_ends(edge, curves, ends_[edge]);
    }
  };
  if (Status status = parallel_for(touched.size(), edges_per_task, quiet, measure_again); !status.ok()) return status;
  if (!are_same) return false;
  set_gaps(least);
  return true;
}

/// Divides the chords of edges into tubes.
void EdgeTubes::group() {
  for (std::uint32_t edge = 0; edge + 1 < first_chord_.size(); ++edge) {
    const std::uint32_t begin = first_chord_[edge], end = first_chord_[edge + 1];
    const std::uint32_t parts = (end - begin + max_chords - 1) / max_chords;
    for (std::uint32_t k = 0; k < parts; ++k) {
      const std::uint32_t first = begin + (end - begin) * k / parts, next = begin + (end - begin) * (k + 1) / parts;
      tubes_.push_back({edge, first, next - first, 0, {}});
    }
  }
}

void EdgeTubes::set_gaps(double least) {
  for (Tube& tube : tubes_) {
    const auto first = measured_.begin() + tube.first;
    tube.gap = margin * *std::max_element(first, first + tube.count) + least;
  }
  hold_vertices(least);
  for (Tube& tube : tubes_) {
    tube.box = {};
    for (const TubeChord& chord : std::span(chords_).subspan(tube.first, tube.count)) {
      const double reach = tube.gap + chord.off;
      for (const Vec3& p : {chord.start, chord.end})
        tube.box.extend(p - Vec3{reach, reach, reach}), tube.box.extend(p + Vec3{reach, reach, reach});
    }
  }
}

/// Widens for each vertex the tube whose end is nearest to all points that faces have there.
void EdgeTubes::hold_vertices(double least) {
  std::vector<EdgeEnd> all;
  for (const std::vector<EdgeEnd>& of : ends_) all.insert(all.end(), of.begin(), of.end());
  for (const VertexLine& line : curves_->vertex_lines())
    for (int k = 0; k <= samples; ++k) {
      const LoopPoint point = loop_point(*set_, frame_, *line.piece, line.patch, share_of(k));
      all.push_back({line.vertex, 0, false, false, point.position, point.unsure});
    }
  std::ranges::stable_sort(all, {}, &EdgeEnd::vertex);
  for (auto begin = all.begin(); begin != all.end();) {
    const auto end = std::find_if(begin, all.end(), [&](const EdgeEnd& of) { return of.vertex != begin->vertex; });
    const EdgeEnd* nearest = nullptr;
    double reach = 0;
    std::size_t tried = 0;
    for (auto centre = begin; centre != end && tried < max_centres; ++centre) {
      if (!centre->is_centre || first_chord_[centre->edge] == first_chord_[centre->edge + 1]) continue;
      ++tried;
      double farthest = 0;
      for (auto of = begin; of != end; ++of)
        farthest = std::max(farthest, length(of->position - centre->position) + of->unsure + centre->unsure);
      if (nearest == nullptr || farthest < reach) nearest = &*centre, reach = farthest;
    }
    if (nearest != nullptr) {
      const auto of_edge = std::ranges::equal_range(tubes_, nearest->edge, {}, &Tube::edge);
      Tube& tube = nearest->at_start ? of_edge.front() : of_edge.back();
      tube.gap = std::max(tube.gap, reach + least);
    }
    begin = end;
  }
}

double EdgeTubes::largest_gap() const {
  double largest = 0;
  for (const Tube& tube : tubes_) largest = std::max(largest, tube.gap);
  return largest;
}

std::vector<double> EdgeTubes::gaps() const {
  std::vector<double> gaps(curves_ ? curves_->edge_count() : 0);
  for (const Tube& tube : tubes_) gaps[tube.edge] = std::max(gaps[tube.edge], tube.gap / frame_.scale);
  return gaps;
}

}}  // namespace tessera::abi_0_1
