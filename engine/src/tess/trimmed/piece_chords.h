#pragma once
// Lays chords along the pieces of trimming loops.

#include <array>
#include <atomic>
#include <limits>
#include <span>
#include <vector>

#include "tess/trimmed/speed_bound.h"
#include "tessera/geometry.h"
#include "trim/trim_piece.h"

namespace tessera { inline namespace abi_0_1 {

/// The limits of a chord, in parameters of the surface and lengths of the model.
struct ChordLimits {
  double sliver = 0;   ///< the largest distance on the surface between a chord and its piece of curve
  ParameterPoint box;  ///< the largest box of a chord
  SpeedBound speed;    ///< bounds on the surface's first derivatives around the piece
  /// The largest sliver over the length of its chord, both in these speeds: an eighth of the angle by which an arc of a
  /// circle turns.
  double bend = std::numeric_limits<double>::infinity();
  const std::atomic<bool>* cancel = nullptr;  ///< once it is set, chords are not halved any more
};

/// Stations along a caller's curve: parameters where chords must end.
struct CurveStations {
  std::span<const double> at;  ///< growing
  double same = 0;             ///< nearer to an end of a piece, a station is that end
};

/// The chords along a chain of pieces: their points but the start, and the parameters of the caller's curve there.
struct LaidChords {
  std::vector<ParameterPoint> points;
  std::vector<double> parameters;
  double sliver = 0;  ///< the largest
};

/// Lays chords along chains of monotone pieces: over as many pieces as the limits allow, or over even parts of one
/// piece, as few as the limits allow. Parts that need more are divided again.
///
/// Sliver bound, for a part of a chain with the ends a and b and control points q: by the cross products
/// c = (b - a) x (q - a), each point between curve and chord lies at most d = max |c| / |b - a| from the line of the
/// chord. Away from the chord, in any one direction, it meets the curve. Towards the chord it meets it if no q lies
/// beside the chord, seen in that direction. So it moves by at most max |c| / |b.u - a.u| along v,
/// max |c| / |b.v - a.v| along u, or d across the chord. The shortest on the surface counts.
class PieceChords {
 public:
  /// Appends the points of a chain but its start, and the parameters of the caller's curve there. `chain`: pieces that
  /// follow each other. Returns the largest sliver bound, which is at most limits.sliver, unless a piece would need
  /// more than 2^20 chords. The errors of the pieces count as a part of the sliver.
  double append(std::span<const TrimPiece> chain, const ChordLimits& limits, std::vector<ParameterPoint>& points,
                std::vector<double>& parameters);
  /// Appends the points of chords that also end at stations. All pieces are of one curve.
  double append(std::span<const TrimPiece> chain, const CurveStations& stations, const ChordLimits& limits,
                std::vector<ParameterPoint>& points, std::vector<double>& parameters);

 private:
  struct Control {
    double u, v, w;  ///< homogeneous, relative to the start of the piece
    ParameterPoint point() const { return {u / w, v / w}; }
  };
  using Net = std::array<Control, max_degree + 1>;
  /// The sliver bound of a chord, and whether it keeps the limits.
  struct Sliver {
    double size = 0;
    bool is_fine = false;
  };
  /// Whether points between curve and chord meet the chord along u and along v. They do across it.
  struct Feet {
    bool along_u = true, along_v = true;
  };
  /// `cross`: the largest |c|.
  Sliver sliver_of(const ParameterPoint& chord, double cross, double error, const Feet& feet) const;
  /// The sliver of a chord over all of a chain.
  Sliver sliver_over(std::span<const TrimPiece> chain) const;
  Sliver sliver_of(const Net& net, double balance) const;
  /// The largest sliver of chords along a piece with this error.
  double sliver_room(double error) const;
  static double cross_of(const ParameterPoint& chord, const ParameterPoint& start, const Control& q);
  /// The number of pieces that the next chord spans.
  std::size_t reach(std::span<const TrimPiece> chain) const;
  double error_of(const TrimPiece& piece) const;
  void begin_chords(const ChordLimits& limits, std::vector<ParameterPoint>& points, std::vector<double>& parameters);
  /// Appends the points of one piece but its start; chords end at the stations, which lie inside.
  void append_one(const TrimPiece& piece, std::span<const double> stations);
  /// Returns c so that weights w_k c^k, those of the same curve by another parameter, are equal at both ends.
  double balance(const Net& net) const;
  /// The largest part of the distance of control points from the chord at which the curve passes. Exact for degree 2.
  double reach_of(const Net& net, double balance) const;
  void split(const Net& net, double x, Net& low, Net& high) const;
  /// `from`, `to`: of the piece, the part that the net is.
  void divide(const Net& net, double from, double to, int depth);
  void divide_evenly(const Net& net, double from, double to, int depth, int count);
  /// About the number of even parts that the limits need, from a chord over all and its sliver.
  int count_for(const ParameterPoint& chord, double sliver) const;
  /// Whether as many even parts keep the limits.
  bool is_fine(const Net& net, int count) const;
  /// Appends the end of a chord.
  void put(const ParameterPoint& end, double to, const Sliver& sliver);

  const TrimPiece* piece_ = nullptr;
  const ChordLimits* limits_ = nullptr;
  std::vector<ParameterPoint>* points_ = nullptr;
  std::vector<double>* parameters_ = nullptr;
  std::vector<TrimPiece> parts_;  ///< from one station to the next
  int degree_ = 0;
  double most_ = 0, error_ = 0;
};

}}  // namespace tessera::abi_0_1
