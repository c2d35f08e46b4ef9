#include "tess/bounds/picture.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <string>
#include <vector>

#include "base/aligned.h"
#include "base/infinity.h"
#include "base/text.h"
#include "kernel/table/kernel_table.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

constexpr int max_pixels = 1 << 20;

Status bad(const std::string& message) { return {StatusCode::invalid_argument, message}; }

/// A patch's control points in the camera's axes, and its weights.
struct LocalNet {
  int rows = 0, columns = 0;
  std::vector<Vec3> points;
  std::vector<double> weights;

  LocalNet() = default;
  LocalNet(const Camera& camera, const BezierPatch& patch) { place(camera, patch); }
  void place(const Camera& camera, const BezierPatch& patch) {
    rows = patch.degree_u() + 1;
    columns = patch.degree_v() + 1;
    points.resize(patch.points().size());
    std::ranges::transform(patch.points(), points.begin(), [&](const Vec3& p) { return camera.local(p); });
    if (patch.is_rational())
      weights.assign(patch.weights().begin(), patch.weights().end());
    else
      weights.assign(points.size(), 1.0);
  }
  bool is_in_front(const Camera& camera) const { return camera.orthographic() || shallowest() >= camera.nearest(); }

  double shallowest() const {
    double z = infinity;
    for (const Vec3& p : points) z = std::min(z, p.z);
    return z;
  }
  double deepest() const {
    double z = -infinity;
    for (const Vec3& p : points) z = std::max(z, p.z);
    return z;
  }
  /// Whether the whole hull lies outside one plane of the frame, by more than the margin.
  bool is_unseen(const Camera& camera, double margin) const {
    for (int plane = 0; plane < camera.plane_count(); ++plane)
      if (std::all_of(points.begin(), points.end(), [&](const Vec3& p) { return camera.outside(p, plane) > margin; }))
        return true;
    return false;
  }
  /// Returns the lower and the upper half by the rational algorithm of de Casteljau (Farin, sec. 13.3), which keeps
  /// points in the hull.
  std::pair<LocalNet, LocalNet> halves(bool along_u) const {
    LocalNet low = *this, high = *this;
    const int count = along_u ? rows : columns, lines = along_u ? columns : rows;
    const int step = along_u ? columns : 1, line_step = along_u ? 1 : columns;
    for (int line = 0; line < lines; ++line)
      for (int k = 0; k < count; ++k) {
        const auto at = [&](int i) { return static_cast<std::size_t>(line * line_step + i * step); };
        low.points[at(k)] = high.points[at(0)];
        low.weights[at(k)] = high.weights[at(0)];
        for (int i = 0; i + 1 < count - k; ++i) {
          const double a = high.weights[at(i)], b = high.weights[at(i + 1)], share = b / (a + b);
          high.points[at(i)] = (1 - share) * high.points[at(i)] + share * high.points[at(i + 1)];
          high.weights[at(i)] = 0.5 * a + 0.5 * b;
        }
      }
    return {low, high};
  }
};

/// Bounds the depth from below at which a point of the patch lies within the margin of what the camera sees. The depth
/// is infinite if no point does, and at least the near distance less the margin.
class NearestSeen {
 public:
  NearestSeen(const Camera& camera, const LocalNet& net, double margin) : camera_(camera), margin_(margin) {
    visit(net, 0);
  }
  double depth() const { return std::isinf(depth_) ? depth_ : std::max(depth_, camera_.nearest() - margin_); }

 private:
  void visit(const LocalNet& net, int cuts) {
    constexpr int max_cuts = 12;
    constexpr double level = 0.8;
    const double shallowest = net.shallowest();
    if (shallowest >= depth_ || net.is_unseen(camera_, margin_)) return;
    const bool enough = shallowest >= level * net.deepest();
    if (cuts == max_cuts || enough) {
      depth_ = shallowest;
      return;
    }
    const auto [low, high] = net.halves(cuts % 2 == 0);
    visit(low, cuts + 1);
    visit(high, cuts + 1);
  }

  const Camera& camera_;
  double margin_, depth_ = infinity;
};

/// The extent of a net in the plane of the picture.
struct Projected {
  Vec3 lower{infinity, infinity, 0}, upper{-infinity, -infinity, 0};
  double lightest = infinity, heaviest = 0;  ///< weights
  double size = 0;                           ///< the largest distance from the picture's middle, pixels
};

/// Replaces a net by its picture, with points in pixels. In perspective all points must be deeper than 0.
Projected project(const Camera& camera, LocalNet& net) {
  Projected to;
  for (std::size_t k = 0; k < net.points.size(); ++k) {
    Vec3& p = net.points[k];
    const double depth = camera.orthographic() ? 1 : p.z, scale = camera.focal() / depth;
    p = {scale * p.x, scale * p.y, 0};
    const double weight = net.weights[k] *= depth;
    to.lower = {std::min(to.lower.x, p.x), std::min(to.lower.y, p.y), 0};
    to.upper = {std::max(to.upper.x, p.x), std::max(to.upper.y, p.y), 0};
    to.lightest = std::min(to.lightest, weight);
    to.heaviest = std::max(to.heaviest, weight);
    to.size = std::max(to.size, p.x * p.x + p.y * p.y);
  }
  to.size = std::sqrt(to.size);
  return to;
}

Result<BezierPatch> patch_of(const LocalNet& net) {
  return BezierPatch::rational(net.rows - 1, net.columns - 1, net.points, net.weights);
}

/// Pictures of some patches of a block, for the kernel.
class PictureBlock {
 public:
  PictureBlock(int degree_u, int degree_v) : degree_u_(degree_u), degree_v_(degree_v) {
    const std::size_t count = static_cast<std::size_t>(degree_u + 1) * static_cast<std::size_t>(degree_v + 1);
    std::fill_n(net_.data(), 4 * lanes * count, 0.0f);
    for (std::size_t k = 0; k < count; ++k) std::fill_n(net_.data() + (4 * k + 3) * lanes, lanes, 1.0f);
  }

  /// Adds the picture of a net, which project() has made, if float can hold it; else returns false.
  bool add(std::size_t lane, const LocalNet& net, const Projected& projected) {
    const auto [lower, upper, lightest, heaviest, size] = projected;
    if (!(lightest >= min_weight * heaviest && heaviest <= largest && heaviest >= 1 / largest)) return false;
    const Vec3 middle = 0.5 * (lower + upper);
    const double width = max_abs(upper - lower);
    if (!(width <= largest && width >= 1 / largest)) return false;
    const double scale = std::ldexp(1, -std::ilogb(heaviest) - 1);
    float* to = net_.data() + lane;
    for (std::size_t k = 0; k < net.points.size(); ++k, to += 4 * lanes) {
      const double weight = scale * net.weights[k];
      to[0] = static_cast<float>(weight * (net.points[k].x - middle.x));
      to[lanes] = static_cast<float>(weight * (net.points[k].y - middle.y));
      to[3 * lanes] = static_cast<float>(weight);
    }
    return true;
  }
  void bound() {
    kernel::default_kernels().bound_rational_chords({.net = net_.data(),
                                                     .degree_u = degree_u_,
                                                     .degree_v = degree_v_,
                                                     .pieces = pieces_.data(),
                                                     .unit = unit_.data(),
                                                     .size = size_.data(),
                                                     .is_plane = true});
  }
  ChordBound::PlainPieces pieces(std::size_t lane) const {
    ChordBound::PlainPieces pieces;
    for (std::size_t k = 0; k < pieces.size(); ++k)
      for (std::size_t kind = 0; kind < 3; ++kind)
        pieces[k][kind] = double(unit_[lane]) * double(pieces_[(3 * k + kind) * lanes + lane]);
    return pieces;
  }
  /// Whether rounding is a small part of the bound. The bound holds in any case.
  bool is_sharp(std::size_t lane) const { return size_[lane] >= 0; }

 private:
  static constexpr std::size_t lanes = PatchSet::lanes, max_terms = kernel::max_rational_degree + 1;
  static constexpr double min_weight = 1.0 / 16, largest = 1e30;

  int degree_u_, degree_v_;
  alignas(cache_line) std::array<float, max_terms * max_terms * 4 * lanes> net_;
  alignas(cache_line) std::array<float, 9 * 3 * lanes> pieces_;
  alignas(cache_line) std::array<float, lanes> unit_, size_;
};

}  // namespace

Result<Camera> Camera::make(const View& view) {
  // The conditions are written so that NaN fails.
  constexpr double largest = 1e100;
  const auto in_range = [](const Vec3& v) { return is_finite(v) && max_abs(v) <= largest; };
  if (!in_range(view.eye) || !in_range(view.target) || !in_range(view.up))
    return bad("the view's eye, target and up must be finite, at most 1e100");
  const double distance = length(view.target - view.eye);
  if (!(distance > 0)) return bad("the view's eye and target are the same point");
  if (!view.orthographic && !(view.field_of_view > 0 && view.field_of_view < std::numbers::pi))
    return bad("the view's field of view is " + text(view.field_of_view) + ", it must lie between 0 and pi");
  if (view.orthographic && !(view.extent > 0 && view.extent <= largest))
    return bad("the view's extent is " + text(view.extent) + ", it must be finite and above 0");
  if (view.width < 1 || view.height < 1 || view.width > max_pixels || view.height > max_pixels)
    return bad("the view is " + std::to_string(view.width) + " x " + std::to_string(view.height) +
               " pixels, each must be from 1 to 1048576");
  if (!(view.near_distance >= 0 && view.near_distance <= largest))
    return bad("the view's near distance is " + text(view.near_distance) + ", it must be finite and at least 0");
  Camera camera;
  camera.eye_ = view.eye;
  camera.forward_ = normalized(view.target - view.eye);
  Vec3 right = cross(camera.forward_, normalized(view.up));
  if (!(length(right) > 1e-6))
    right = cross(camera.forward_, std::abs(camera.forward_.z) < 0.9 ? Vec3{0, 0, 1} : Vec3{0, 1, 0});
  camera.right_ = normalized(right);
  camera.up_ = cross(camera.right_, camera.forward_);
  camera.orthographic_ = view.orthographic;
  const double shorter = std::min(view.width, view.height);
  const double half = view.orthographic ? view.extent / 2 : std::tan(view.field_of_view / 2);
  camera.focal_ = shorter / (2 * half);
  camera.half_width_ = half * view.width / shorter;
  camera.half_height_ = half * view.height / shorter;
  camera.lean_x_ = view.orthographic ? 1 : 1 / std::sqrt(1 + camera.half_width_ * camera.half_width_);
  camera.lean_y_ = view.orthographic ? 1 : 1 / std::sqrt(1 + camera.half_height_ * camera.half_height_);
  if (!view.orthographic) camera.near_ = view.near_distance > 0 ? view.near_distance : 1e-3 * distance;
  return camera;
}

double Camera::steepest() const {
  return focal_ * std::sqrt(1 + half_width_ * half_width_ + half_height_ * half_height_);
}

ScreenSpaceBound::ScreenSpaceBound(const Camera& camera, const BezierPatch& patch, double moved, double pixels) {
  LocalNet net(camera, patch);
  if (net.is_unseen(camera, moved)) return;
  const double shallowest = net.shallowest();
  const bool in_front = net.is_in_front(camera);
  const Projected projected = in_front ? project(camera, net) : Projected();
  const Result<BezierPatch> picture =
      in_front ? patch_of(net) : Status(StatusCode::unsupported, "not in front of the eye");
  if (!picture) {
    bound_by_depth(camera, patch, moved, pixels);
    return;
  }
  projected_ = ChordBound(*picture).plain_pieces();
  allow_for(camera, moved, shallowest, projected.size);
}

void ScreenSpaceBound::allow_for(const Camera& camera, double moved, double shallowest, double size) {
  const double tangent = camera.orthographic() ? 0 : size / camera.focal();
  const double slope = camera.focal() * std::sqrt(1 + tangent * tangent);
  // The rounding of the points in the plane is far below 2^-40 of them.
  const double room = camera.orthographic() ? 1 : shallowest - moved;
  moved_pixels_ = room > 0 ? slope * moved / room + 0x1p-40 * size : infinity;
}

void ScreenSpaceBound::find(const Camera& camera, const PatchSet::Impl& set, std::size_t block,
                            const std::array<double, PatchSet::lanes>& moved, double pixels,
                            ScreenSpaceBound* pictures) {
  constexpr double little = 0.1;  // a share of the tolerance in pixels
  const BlockGroup& group = set.group_of_block(block);
  const std::uint32_t* const patches = set.lane_patches.data() + block * PatchSet::lanes;
  const std::size_t count = set.lane_counts[block];
  const bool in_block = std::max(group.degree_u, group.degree_v) <= kernel::max_rational_degree;
  std::bitset<PatchSet::lanes> is_open, is_added;
  PictureBlock flat(in_block ? group.degree_u : 0, in_block ? group.degree_v : 0);
  LocalNet net;
  for (std::size_t lane = 0; lane < count; ++lane) {
    net.place(camera, set.patches[patches[lane]]);
    ScreenSpaceBound& picture = pictures[patches[lane]] = ScreenSpaceBound();
    if (net.is_unseen(camera, moved[lane])) continue;
    is_open.set(lane);
    const double shallowest = net.shallowest();
    if (!in_block || !(camera.orthographic() || shallowest >= camera.nearest())) continue;
    const Projected projected = project(camera, net);
    if (!flat.add(lane, net, projected)) continue;
    is_added.set(lane);
    picture.allow_for(camera, moved[lane], shallowest, projected.size);
  }
  if (is_added.any()) flat.bound();
  for (std::size_t lane = 0; lane < count; ++lane) {
    ScreenSpaceBound& picture = pictures[patches[lane]];
    if (is_added[lane]) picture.projected_ = flat.pieces(lane);
    const bool is_bounded =
        is_added[lane] && (flat.is_sharp(lane) || picture.projected()->distance({1, 1}) <= little * pixels);
    if (is_open[lane] && !is_bounded)
      picture = ScreenSpaceBound(camera, set.patches[patches[lane]], moved[lane], pixels);
  }
}

void ScreenSpaceBound::bound_by_depth(const Camera& camera, const BezierPatch& patch, double moved, double pixels) {
  distance_ = 0;
  if (camera.orthographic()) return;  // only if the picture's numbers are beyond double
  const LocalNet net(camera, patch);
  steepest_ = camera.steepest();
  const auto kept_at = [&](double depth) { return pixels * depth / (steepest_ + pixels); };
  // 1. Where q is seen and p lies within d of q, p lies within d of what is seen. So p is at least as deep as the least
  //    deep point of the patch, or of the mesh, that lies within d of what is seen.
  // 2. So the search is for a distance that is kept at the depth to which this distance itself leads.
  // 3. If nothing is seen at a distance, the mesh passes beside the frame as the patch does.
  const double seen = NearestSeen(camera, net, moved).depth();
  double distance = std::isinf(seen) ? patch.hull_box().diagonal() : kept_at(seen);
  while (distance > moved) {
    const double depth = NearestSeen(camera, net, distance).depth();
    if (std::isinf(depth) || kept_at(depth) >= distance) {
      depth_ = std::isinf(depth) ? 0 : depth;
      distance_ = distance;
      return;
    }
    distance = std::max(kept_at(depth), 0.5 * distance);
  }
}

double ScreenSpaceBound::pixels(const std::optional<ChordBound>& projected, PatchSegments segments,
                                double distance) const {
  if (projected) return projected->distance_of(segments) + moved_pixels_;
  return depth_ > 0 ? steepest_ * distance / (depth_ - distance) : 0;
}

}}  // namespace tessera::abi_0_1
