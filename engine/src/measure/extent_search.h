#pragma once
// How far the kept part of a face reaches along a direction of an axis.
//
// The farthest point is a critical point of the coordinate inside a patch or on a side of it, or it is on a loop, or at
// a corner. So parts are halved in which a critical point may be, and left out where the coordinate's derivative keeps
// its sign: the search converges quadratically even where a plane is cut at a slant.

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include "measure/face_integrals.h"
#include "measure/scalar_net.h"
#include "trim/trim_region_impl.h"

namespace tessera { inline namespace abi_0_1 {

/// The largest value of a coordinate lies between these.
struct Extent {
  double reached;  ///< a point reaches it
  double bound;    ///< no point exceeds it
};

class ExtentSearch {
 public:
  /// `face` must outlive this object. `sign`: -1 searches the largest of minus the coordinate.
  ExtentSearch(const MeasuredFace& face, int axis, double sign);

  /// A value that a point reaches, at little cost; -infinity if none is found.
  double quick() const;
  /// Searches values that exceed `reached`, which some point of the model reaches, by more than `tolerance`.
  Extent run(double reached, double tolerance, std::size_t max_cells);

 private:
  /// A part of a patch, of a side of it, or of a piece of a loop.
  struct Part {
    double bound;
    std::size_t patch, number;
    Domain window;                      ///< in the patch's parameters; of no width or height: a side
    std::optional<LocalCurve> curve{};  ///< of a loop
    double band = 0;                    ///< how far the curve's error may move values
    bool operator<(const Part& other) const {
      return bound != other.bound ? bound < other.bound : number > other.number;
    }
  };

  void add_patch(std::size_t place);
  void add_window(std::size_t patch, const Domain& window);
  void add_curve(std::size_t patch, const LocalCurve& curve, double band);
  void push(Part part);
  void halve(const Part& part);
  void reach(double value) { reached_ = std::max(reached_, value - slack_); }
  /// Leaves a part out, of which no point exceeds the bound.
  void leave(double bound) { left_ = std::max(left_, bound); }
  bool is_cut(std::size_t patch) const;
  TrimSide side(std::size_t patch, const Domain& window) const;
  const ScalarNet& net(std::size_t patch);
  double at(std::size_t patch, const ParameterPoint& p);

  const MeasuredFace& face_;
  int axis_;
  double sign_, slack_ = 0, reached_ = 0, tolerance_ = 0;
  double left_ = -std::numeric_limits<double>::infinity();  ///< the largest bound of what is left out
  std::size_t made_ = 0;
  std::optional<TrimRegion> points_;  ///< made for points, if any patch is cut
  std::vector<std::optional<ScalarNet>> nets_;
  std::vector<Part> open_;  ///< a heap
};

}}  // namespace tessera::abi_0_1
