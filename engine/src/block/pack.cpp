#include "block/pack.h"

#include <cmath>

#include "block/patch_set_impl.h"
#include "convert/basis/power_form.h"
#include "surface/net/homogeneous.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// The least share of the largest weight that a weight may be: derivatives grow with the inverse of that share, and
/// normals with its square.
constexpr double min_weight_in_float = 1e-9, min_weight_in_double = 1e-70;

/// Returns the largest |coefficient| of components `first` to before `end`.
double largest_of(std::span<const double> net, std::size_t components, std::size_t first, std::size_t end) {
  double largest = 0;
  for (std::size_t k = 0; k < net.size(); k += components)
    for (std::size_t c = first; c < end; ++c) largest = std::max(largest, std::abs(net[k + c]));
  return largest;
}

/// Whether the weights, and Bernstein coefficients up to `largest`, fit the blocks; `in_float`: some of these are in
/// float.
bool fits(const RelativeNet& net, bool in_float, double largest) {
  const double ratio = net.weight_ratio();
  return largest <= largest_coefficient(in_float, 1) &&
         largest / net.heaviest() <= largest_coefficient(in_float, ratio) &&
         !(ratio < (in_float ? min_weight_in_float : min_weight_in_double));
}

/// Where a patch is packed to, and the values that its thresholds follow from.
struct Place {
  const BlockGroup& group;
  PatchSet::Slot slot;
  std::uint32_t lane_count;  ///< the block's lanes in use
  const RelativeNet& net;
  bool curve;
  double diameter;

  /// Writes the patch's lane, and those that repeat it, by write_coefficients(lane). `size`: see normal_threshold().
  template <class T, class Write>
  void write(UnsetVector<T>& coefficients, UnsetVector<T>& thresholds, double size, Write write_coefficients) const {
    constexpr std::size_t lanes = PatchSet::lanes;
    const std::array<T, 2> threshold = threshold_in<T>(curve ? no_normal : regular_threshold<T>(size));
    T* block = coefficients.data() + group.first_value + (slot.block - group.first_block) * group.block_values;
    T* rows = thresholds.data() + 2 * lanes * slot.block;
    const auto write_to = [&](std::uint32_t lane) {
      write_coefficients(block + lane);
      rows[lane] = threshold[0];
      rows[lanes + lane] = threshold[1];
    };
    write_to(slot.lane);
    if (slot.lane == 0)
      for (std::uint32_t lane = lane_count; lane < lanes; ++lane) write_to(lane);
  }

  /// Writes the coefficients for scattered points.
  template <class T>
  void write_points(Coefficients<T>& to, double size) const {
    net.write_rows(to.points.data() + group.point_value(slot), group.point_values);
    DegenerateNormalThreshold threshold = regular_threshold<T>(size);
    if (curve) threshold.noise = no_normal.noise;
    to.point_threshold[slot.block * std::size_t{PatchSet::lanes} + slot.lane] = threshold_in<T>(threshold);
  }

  template <class T>
  DegenerateNormalThreshold regular_threshold(double size) const {
    return normal_threshold<T>(std::max(group.degree_u, group.degree_v), size, diameter, net.lightest(),
                               net.weight_spread());
  }
};

}  // namespace

RelativeNet::RelativeNet(const BezierPatch& patch, const Vec3& origin) : patch_(patch), origin_(origin) {
  if (!patch.is_rational()) return;
  const auto [low, high] = std::ranges::minmax(patch.weights());
  low_ = low;
  high_ = high;
  scale_ = 1 / power_of_two_near(high);
}

double RelativeNet::largest(const Box3& hull) const {
  if (!patch_.is_rational()) return farthest(hull);
  double largest = 0;
  for (std::size_t k = 0; k < patch_.points().size(); ++k)
    largest = std::max(largest, max_abs(scale_ * patch_.weights()[k] * (patch_.points()[k] - origin_)));
  return largest;
}

std::span<const double> RelativeNet::power(Power& memory) const {
  double* to = memory.data();
  for_each([&](double value) { *to++ = value; });
  const std::span net(memory.data(), to);
  power_coefficients(patch_.degree_u(), patch_.degree_v(), coefficient_components(patch_.is_rational()), net);
  return net;
}

bool is_curve(const BezierPatch& patch, SideMask collapsed) {
  if (!collapsed.any()) return false;
  bool equal_rows = true, equal_columns = true;
  for (int i = 0; i <= patch.degree_u(); ++i)
    for (int j = 0; j <= patch.degree_v(); ++j) {
      equal_rows = equal_rows && patch.point(i, j) == patch.point(0, j);
      equal_columns = equal_columns && patch.point(i, j) == patch.point(i, 0);
    }
  return patch.is_rational() ? equal_rows && equal_columns : equal_rows || equal_columns;
}

bool PatchSet::Impl::pack_bernstein(std::size_t index, const BlockGroup& group, const Box3& hull) {
  if (!kinds.float_bernstein && !kinds.double_bernstein) return true;
  const RelativeNet net(patches[index], origin);
  const Slot slot = slots[index];
  const bool curve = is_curve(patches[index], collapsed[index]);
  const Place place{group, slot, lane_counts[slot.block], net, curve, hull.diagonal()};
  if (!fits(net, kinds.float_bernstein, net.largest(hull))) return false;
  const double size = net.tangent_size(hull);
  const auto coefficients = [&](auto* lane) { net.write(lane); };
  if (kinds.float_bernstein) place.write(f32.bernstein, f32.bernstein_threshold, size, coefficients);
  if (kinds.double_bernstein) place.write(f64.bernstein, f64.bernstein_threshold, size, coefficients);
  return true;
}

bool PatchSet::Impl::pack_points(std::size_t index, const BlockGroup& group, const Box3& hull,
                                 Coefficients<float>* to_f32, Coefficients<double>* to_f64) const {
  if (!to_f32 && !to_f64) return true;
  const RelativeNet net(patches[index], origin);
  const Slot slot = slots[index];
  const bool curve = is_curve(patches[index], collapsed[index]);
  const Place place{group, slot, lane_counts[slot.block], net, curve, hull.diagonal()};
  if (!fits(net, to_f32 != nullptr, net.largest(hull))) return false;
  const double size = net.tangent_size(hull);
  if (to_f32) place.write_points(*to_f32, size);
  if (to_f64) place.write_points(*to_f64, size);
  return true;
}

bool PatchSet::Impl::pack_power(std::size_t index, const BlockGroup& group, const Box3& hull) {
  if (!kinds.float_power && !kinds.double_power) return true;
  const RelativeNet net(patches[index], origin);
  const Slot slot = slots[index];
  const bool curve = is_curve(patches[index], collapsed[index]);
  const Place place{group, slot, lane_counts[slot.block], net, curve, hull.diagonal()};
  RelativeNet::Power memory;
  const std::span<const double> power = net.power(memory);
  const double limit = largest_coefficient(kinds.float_power, 1);
  const auto in_range = [&](double value) { return std::abs(value) <= limit; };
  if (!fits(net, kinds.float_power, net.largest(hull)) || !std::ranges::all_of(power, in_range)) return false;
  // See tangent_size(); a power coefficient may exceed the Bernstein ones.
  double size = largest_of(power, static_cast<std::size_t>(coefficient_components(group.rational)), 0, 3);
  if (group.rational) size = std::max(size, net.tangent_size(hull) / net.heaviest() * largest_of(power, 4, 3, 4));
  const auto coefficients = [&]<class T>(T* lane) {
    for (std::size_t k = 0; k < power.size(); ++k) lane[k * lanes] = static_cast<T>(power[k]);
  };
  if (kinds.float_power) place.write(f32.power, f32.power_threshold, size, coefficients);
  if (kinds.double_power) place.write(f64.power, f64.power_threshold, size, coefficients);
  return true;
}

bool PatchSet::Impl::pack_lanes(std::size_t index) {
  const BlockGroup& group = group_of_block(slots[index].block);
  const Box3 hull = patches[index].hull_box();
  collapsed[index] = patches[index].collapsed_sides();
  return pack_bernstein(index, group, hull) && pack_points(index, group, hull) && pack_power(index, group, hull);
}

void PatchSet::Impl::note_threshold(std::size_t index) {
  const std::size_t at = slots[index].block * std::size_t{lanes} + slots[index].lane;
  if (kinds.float_points) f32.largest_threshold = std::max(f32.largest_threshold, f32.point_threshold[at][0]);
  if (kinds.double_points) f64.largest_threshold = std::max(f64.largest_threshold, f64.point_threshold[at][0]);
}

bool PatchSet::Impl::pack(std::size_t index) {
  if (!pack_lanes(index)) return false;
  note_threshold(index);
  return true;
}

}}  // namespace tessera::abi_0_1
