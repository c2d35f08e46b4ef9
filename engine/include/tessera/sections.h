#pragma once
// Sections: where planes cut the surfaces of a set, as polylines whose points lie on the surface.
//
// Memory: results own theirs; arguments are not kept. Threads: any number of calls at once on a const set; work runs in
// the caller's TBB arena.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tessera/execution.h"
#include "tessera/geometry.h"
#include "tessera/patch_set.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// The plane of the points p with dot(normal, p) = offset.
struct Plane {
  Vec3 normal{0, 0, 1};  ///< finite and not zero; of any length
  double offset = 0;     ///< finite; in units of length if the normal is a unit vector
};

/// The choice of a section where a plane runs along faces, edges or vertices: the limit of planes that come from one
/// side. It makes the section of a closed shape closed there, too. Elsewhere both limits are the section itself.
enum class PlaneLimit : std::uint8_t {
  automatic,  ///< below; above where there is nothing below, as at the bottom of a box
  below,      ///< of planes with a smaller offset
  above,      ///< of planes with a larger offset
};

/// How sections are made.
struct SectionOptions {
  /// The largest distance of a chord from the section's curve; above 0. 1e-4 of the size of the set by default.
  std::optional<double> tolerance = {};
  PlaneLimit limit = PlaneLimit::automatic;  ///< where a plane runs along a face
  /// The height within which a point counts as one of the plane's when it is decided what runs along the plane; at
  /// least 0. By default 1e-10 of the size of the set and of its distance from the origin, or less for a tolerance that
  /// is finer than 1e-4 of these. Files with coarse numbers need more for planes that run along their faces.
  std::optional<double> contact = {};
  /// How far ends on one edge of two faces may be apart to be joined; at least 0. 5e-3 of the set's size by default.
  std::optional<double> max_gap = {};
  std::size_t max_points = std::size_t{1} << 28;  ///< of all polylines together
};

/// A point of a polyline. It lies on its patch and in the plane, up to rounding; where the plane runs along the surface
/// or is tangent to it, within SectionOptions::contact of the plane.
struct SectionPoint {
  Vec3 position;             ///< in the model
  double u = 0, v = 0;       ///< in the parameters of the patch's surface: within PatchSource::domain
  std::uint32_t patch = 0;   ///< the patch of the point and of the segment that follows it
  bool bridges_gap = false;  ///< whether the segment that follows crosses a gap between two faces, on neither
};

/// A polyline of a section: points[first] to points[first + count - 1]. Its direction means nothing.
struct SectionPolyline {
  std::size_t first = 0;  ///< index into Sections::points
  std::size_t count = 0;  ///< at least 2
  bool closed = false;    ///< whether a segment leads from the last point to the first; then the points differ
  double length = 0;      ///< of all segments
};

/// A place where a plane touches a surface, or where branches of its section meet. Where a plane touches along a curve,
/// contacts are some of its points, and polylines run along it twice, as the section of a plane beside it does.
struct SectionContact {
  /// How the plane and the surface meet.
  enum class Kind : std::uint8_t {
    point,    ///< in a point, or a curve smaller than Sections::contact_size; no polyline goes there
    tangent,  ///< the plane is tangent to the surface: at a saddle, where branches meet, or along a curve
  };
  Kind kind = Kind::point;  ///< of the contact
  std::uint32_t patch = 0;  ///< the patch that it lies on
  Vec3 position;            ///< within 4 times Sections::contact_size of it
};

/// The section of one plane.
struct PlaneSection {
  double offset = 0;                                   ///< of the plane, as the caller states it
  std::size_t first_polyline = 0, polyline_count = 0;  ///< a range of Sections::polylines
  std::size_t first_contact = 0, contact_count = 0;    ///< a range of Sections::contacts
  std::size_t first_coplanar = 0, coplanar_count = 0;  ///< a range of Sections::coplanar
  PlaneLimit limit = PlaneLimit::below;                ///< the side that was taken: below or above
  std::size_t open_count = 0;  ///< polylines that are not closed; each has two ends that no other was joined to
  double length = 0;           ///< of all polylines
  double bound = 0;            ///< proven: the largest distance of a chord from the section's curve
  double largest_gap = 0;      ///< the largest distance between two ends that were joined across faces
};

/// The sections of parallel planes.
struct Sections {
  Vec3 normal;                             ///< of the planes, of length 1
  std::vector<PlaneSection> planes;        ///< in the order of the offsets
  std::vector<SectionPolyline> polylines;  ///< plane by plane
  std::vector<SectionPoint> points;        ///< polyline by polyline
  std::vector<SectionContact> contacts;    ///< plane by plane, at most 1,000 of each
  /// Patches that lie in a plane, plane by plane. They have no polylines; their neighbours' make the outline.
  std::vector<std::uint32_t> coplanar;
  double tolerance = 0;     ///< SectionOptions::tolerance, or its default
  double contact_size = 0;  ///< polylines no larger than this are contacts
  /// Patches whose section is not proven to be complete, growing; the bound of a plane that meets one may exceed the
  /// tolerance. They have so many places where the height has no slope that their division into simple parts was
  /// ended, or parts that lie in a plane as far as doubles can tell.
  std::vector<std::uint32_t> unproven;
};

/// Finds where parallel planes cut a set. Patches that loops cut count with the part that they keep.
///
/// - `normal`: finite, not zero; of any length.
/// - `offsets`: of each plane, the points p with dot(normal, p) = offset; finite, in any order; may be empty.
///
/// Result: every branch of the sections, none missed but closed ones smaller than Sections::contact_size. Ends at
/// borders of patches with equal control points are joined, then those on one edge of two faces (make_patch_set() of a
/// model with shapes), then others that are no farther apart than the tolerance. Points and bounds are in double, also
/// far from the origin. The bound states how far chords are from the section of the patches, and what joining ends
/// moved; PatchSet::fit_error() comes on top. Where a plane is tangent to a surface, it is that of a plane at most
/// SectionOptions::contact beside it. The same bytes for any number of threads.
///
/// Errors: invalid_argument (normal, options; index = the offset: one that is not finite; more points than max_points),
/// cancelled, out_of_memory. Memory: about 1 kB per patch that a plane meets, and 48 bytes per point.
///
/// Source: level sets of Bernstein polynomials by their hull (Farin, Curves and Surfaces for CAGD, 5th ed., ch. 6 and
/// 14), over parts where the height is monotone along u or v.
Result<Sections> make_sections(const PatchSet& set, const Vec3& normal, std::span<const double> offsets,
                               const SectionOptions& options = {}, const Execution& execution = {});
/// Finds where one plane cuts a set. Result: one plane. Errors: as above.
Result<Sections> make_section(const PatchSet& set, const Plane& plane, const SectionOptions& options = {},
                              const Execution& execution = {});

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
