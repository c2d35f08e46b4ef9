#include "occt/curve_parameter.h"

#include <algorithm>
#include <cmath>

namespace tessera { inline namespace abi_0_1 {
namespace {

bool are_equal(const Arcs& a, const Arcs& b) { return a.from() == b.from() && a.to() == b.to(); }

}  // namespace

void CurveParameter::follow_line(const ParameterPoint& from, const ParameterPoint& to,
                                 const Reparametrization& parameters) {
  const bool along_u = std::abs(to.u - from.u) > std::abs(to.v - from.v);
  const std::optional<Arcs>& arcs = along_u ? parameters.u : parameters.v;
  if (!arcs) return;
  Line line{*arcs, along_u ? from.u : from.v, along_u ? to.u : to.v, 0, 0};
  line.starts = arcs->parameter(line.from);
  line.ends = arcs->parameter(line.to);
  if (line.starts != line.ends) line_ = line;
}

/// Before the arcs of a surface. A curve that ends before its range has its end there.
double CurveParameter::even(double t) const {
  const double own = arcs_ ? arcs_->parameter(t) : std::clamp(t + shift_, range_.from, range_.to);
  return reversed_ ? range_.from + range_.to - own : own;
}

double CurveParameter::operator()(double t) const {
  const double x = even(t);
  if (!line_) return x;
  const double width = range_.to - range_.from, angle = line_->place((x - range_.from) / width);
  return range_.from + width * (line_->arcs.parameter(angle) - line_->starts) / (line_->ends - line_->starts);
}

std::vector<double> CurveParameter::breaks() const {
  std::vector<double> found;
  if (arcs_) found = arcs_->knots();
  if (!line_) return found;
  // The knots of the surface's arcs, and of those that follow them, along the line.
  const Arcs& arcs = line_->arcs;
  const double first = std::min(line_->from, line_->to), last = std::max(line_->from, line_->to);
  const double start = range_.from - shift_, width = range_.to - range_.from;
  for (double k = std::ceil((first - arcs.from()) / arcs.step()); arcs.from() + k * arcs.step() < last; ++k) {
    const double x = (arcs.from() + k * arcs.step() - line_->from) / (line_->to - line_->from);
    found.push_back(start + (reversed_ ? 1 - x : x) * width);
  }
  std::sort(found.begin(), found.end());
  return found;
}

bool CurveParameter::follows(const Arcs& arcs) const {
  if (arcs_) return !line_ && are_equal(*arcs_, arcs);
  if (!line_ || shift_ != 0 || !are_equal(line_->arcs, arcs)) return false;
  return reversed_ ? line_->from == range_.to && line_->to == range_.from
                   : line_->from == range_.from && line_->to == range_.to;
}

}}  // namespace tessera::abi_0_1
