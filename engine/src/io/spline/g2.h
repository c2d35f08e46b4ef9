#pragma once
// Objects of GoTools' .g2 files, one after the other: a header (class, version, auxiliary numbers), then the object.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/file/text_cursor.h"
#include "tessera/curve.h"
#include "tessera/geometry.h"
#include "tessera/status.h"
#include "tessera/surface.h"
#include "tessera/trim_loop.h"

namespace tessera { inline namespace abi_0_1 {

/// Classes that are read (GoTools, ClassType.h).
enum G2Class : std::int64_t {
  g2_spline_curve = 100,
  g2_line = 120,
  g2_circle = 130,
  g2_spline_surface = 200,
  g2_trimmed_surface = 210,
  g2_plane = 250,
  g2_cylinder = 260,
  g2_extrusion = 261,
  g2_sphere = 270,
  g2_cone = 280,
  g2_torus = 290,
};

/// Reads the numbers of an object one by one. After the first that is missing or wrong it reads nothing, and status()
/// holds the error.
class G2Numbers {
 public:
  /// `header` is the object's place; `object` names it in messages.
  G2Numbers(TextCursor& cursor, const TextCursor& header, std::string object)
      : cursor_(cursor), header_(header), object_(std::move(object)) {}

  double number(std::string_view what) {
    double value = 0;
    if (!ok()) return value;
    cursor_.skip_space();
    if (!cursor_.take_finite(value)) fail(what);
    return value;
  }
  double positive(std::string_view what);
  std::int64_t integer(std::string_view what, std::int64_t low, std::int64_t high);
  Vec3 vector(std::string_view what);
  const Status& status() const { return status_; }
  bool ok() const { return status_.ok(); }
  /// An error of the object as a whole.
  Status failure(const std::string& sentence) const { return header_.failure(object_ + ": " + sentence); }
  TextCursor& cursor() { return cursor_; }

 private:
  void fail(std::string_view what);

  TextCursor& cursor_;
  TextCursor header_;
  std::string object_;
  Status status_;
};

/// A plane, cylinder, sphere, cone or torus as its record states it.
struct G2Elementary {
  double radius = 0, minor_radius = 0, angle = 0;
  Vec3 location, z_axis, x_axis;
  bool bounded = true;   ///< if not, `range` lacks v, and u of planes too
  bool swapped = false;  ///< whether the file has u and v swapped; `range` has not
  Domain range;
};
/// Reads an elementary surface after its header. One without bounds is read to its end if `is_whole`.
G2Elementary read_g2_elementary(std::int64_t kind, G2Numbers& numbers, bool is_whole);

/// A surface and its place.
struct G2Object {
  Surface surface;
  Affine placement;
  double shift_v = 0;  ///< added to the v of the file
};
/// Makes the surface of a record that has all its bounds. Parameters are the file's (angles in radians), with two
/// exceptions: a cone's v counts from the apex, and a torus has the parameters of its NURBS on [0,1]^2 or a part of it.
Result<G2Object> make_g2_elementary(std::int64_t kind, const G2Elementary& record, const G2Numbers& numbers);

/// A curve that is moved along a direction, without its bounds along v.
struct G2Extrusion {
  Curve profile;   ///< u is its parameter
  Vec3 direction;  ///< per unit of v
  bool swapped = false;
};
/// Reads a surface of linear extrusion after its class.
Result<G2Extrusion> read_g2_extrusion(G2Numbers& numbers);
/// Makes the part of an extrusion over `range` of v.
Result<Surface> make_g2_extrusion(const G2Extrusion& extrusion, const Interval& range);

/// One direction of a spline: the number of points, the order, the knots.
struct G2Line {
  std::int64_t points = 0, order = 0;
  std::vector<double> knots;
  int degree() const { return static_cast<int>(order) - 1; }
};
G2Line read_g2_line(G2Numbers& numbers);

/// The loops of a trimmed surface. They are not read if a curve is of another class, or lacks in the parameters.
struct G2Loops {
  std::vector<TrimLoop> loops = {};
  bool unread = false;
};
/// Reads the loops after the surface that they trim.
Result<G2Loops> read_g2_loops(G2Numbers& numbers);
/// Reads a spline curve of this dimension, 2 or 3, after its class.
Result<Curve> read_g2_curve(G2Numbers& numbers, std::int64_t dimension);

}}  // namespace tessera::abi_0_1
