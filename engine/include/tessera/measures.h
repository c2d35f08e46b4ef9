#pragma once
// Areas of surfaces; volumes, centroids and inertia of solids; tight boxes. Each number comes with a bound of its
// error.
//
// Bounds: integrals are sums of Gauss rules whose remainders are bounded from the size of the integrand at complex
// parameters; rounding, the width of trimming loops and the rounding of placements are added. Members `proven` tell
// where a bound is only sampled. Lengths are in the model's unit.
//
// Memory: results own theirs, arguments are not kept. Threads: any number of calls at once, if the functions of the
// surfaces allow it; work runs in the caller's TBB arena, and results are the same bytes for any number of threads.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "tessera/execution.h"
#include "tessera/geometry.h"
#include "tessera/model.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// A number that is known to lie within `error` of `value`.
struct Measured {
  double value = 0;  ///< the best that is known
  double error = 0;  ///< how far the true number is off at most; not negative
};

/// A point each of whose coordinates is known to lie within `error` of that of `value`.
struct MeasuredPoint {
  Vec3 value;        ///< the best that is known
  double error = 0;  ///< of each coordinate
};

/// The inertia of a body of density 1 about its centroid: xx = integral of y^2 + z^2, xy = -integral of x y, and so on.
struct Inertia {
  double xx = 0, yy = 0, zz = 0, xy = 0, yz = 0, zx = 0;  ///< the tensor's entries
  double error = 0;                                       ///< of each entry
  std::array<double, 3> moments{};                        ///< the principal moments, rising
  double moments_error = 0;                               ///< of each principal moment
  /// The principal axes, of length 1, orthogonal, right-handed. Where moments are equal, any axes are.
  std::array<Vec3, 3> axes{};
};

/// How exact measures are to be.
struct MeasureOptions {
  /// The error of an integral, as a share of what it would be if nothing cancelled: areas as a share of the area,
  /// volumes of the area times the size. From 1e-14 to 1e-2.
  double accuracy = 1e-10;
  /// How many parts a patch, or the strip beside a piece of a loop, is divided into at most; at least 1. Where they do
  /// not suffice, as may be where a normal vanishes along a curve, errors are larger than asked for.
  std::size_t max_cells = 4096;
};

/// The measures of one surface, as its loops trim it, or of several together.
struct SurfaceMeasures {
  Measured area;           ///< of the kept part
  MeasuredPoint centroid;  ///< of the area; the middle of the control points' box, with its size, if the area may be 0
  /// Whether the errors are proven. Not for surfaces that are approximated by a fit (see PatchGrid::fit_error()):
  /// errors of their areas take the fit's for polynomials of the patches' degree. Nor for loops of quadrics that run
  /// along no parameter (see grid_trims()), or for loops that touch or cross others.
  bool proven = true;
};

/// The measures of the surfaces of a model.
struct AreaMeasures {
  std::vector<SurfaceMeasures> surfaces;  ///< `[surface]`
  SurfaceMeasures total;                  ///< of all together
  /// Why the loops of some surfaces could not be used: "surface 3 (rim): loop 0 ..."; index = the surface. These
  /// surfaces are measured whole, and are not proven.
  std::vector<Status> faults;
};

/// The measures of a body of density 1.
struct BodyMeasures {
  std::uint32_t instance = no_id;  ///< index into Model::instances; no_id for a shape or surfaces on their own
  std::uint32_t shape = no_id;     ///< index into Model::shapes; no_id likewise
  std::uint32_t solid = no_id;     ///< the number of the solid; no_id for a shell of none
  std::uint32_t shell = no_id;     ///< index into Shape::shells, of a shell that is of no solid; no_id otherwise
  Measured volume;                 ///< positive, whatever the faces' directions; cavities are taken away
  MeasuredPoint centroid;          ///< if the volume may be 0, the middle of the box, with its size
  Inertia inertia;                 ///< about the centroid
  /// The largest distance of two faces along an edge between them, as edge_gaps() samples it. The slits that such
  /// distances leave are part of the errors above: their length times their width times the distance to the body's
  /// middle. This share is as certain as samples are.
  double gap = 0;
  bool proven = true;  ///< whether all else is: see SurfaceMeasures::proven; false if edges disagree on sides
};

/// Measures the areas of all surfaces of a model.
///
/// Errors: those of the conversions and of check_topology(); invalid_argument (options; a number that overflows),
/// cancelled, out_of_memory. Memory: O(largest surface) per thread.
///
/// Source: Green's theorem and tensor Gauss rules, with the remainder of Trefethen, Approximation Theory and
/// Approximation Practice, theorem 19.3.
Result<AreaMeasures> measure_surfaces(const Model& model, const MeasureOptions& options = {},
                                      const Execution& execution = {});

/// Measures the body that surfaces enclose together, taking for granted that they leave no gap, and that their normals
/// all point outwards, or all inwards. A mapping that mirrors turns normals. BodyMeasures::gap is 0.
///
/// Errors: as above; invalid_argument (no surfaces).
Result<BodyMeasures> measure_enclosed(std::span<const ModelSurface> surfaces, const MeasureOptions& options = {},
                                      const Execution& execution = {});

/// Measures the solids of a shape, and its shells that are of no solid and closed, in the shape's space. The directions
/// of faces follow from the edges that they share; of a solid's shells, those whose boxes lie within that of the
/// largest bound cavities.
///
/// Errors: as above; invalid_argument (a solid that is open, as "solid 0: 2 open edges: 17, 23"; faces that cannot be
/// oriented, as in a Moebius strip; index = the solid).
Result<std::vector<BodyMeasures>> measure_solids(const Shape& shape, const MeasureOptions& options = {},
                                                 const Execution& execution = {});
/// Measures the solids of all instances of a model, in the model's space. Errors: as above, as "shape 2 (nut): ..."
/// (index = the shape).
Result<std::vector<BodyMeasures>> measure_solids(const Model& model, const MeasureOptions& options = {},
                                                 const Execution& execution = {});

/// Adds up bodies that do not overlap: volume, centroid, inertia about the common centroid, the largest gap. Errors:
/// invalid_argument (no bodies).
Result<BodyMeasures> total_of(std::span<const BodyMeasures> bodies);

/// A box that contains a model, and how far each of its sides is from the model at most.
struct MeasuredBox {
  Box3 box;            ///< contains the kept parts of all surfaces
  Vec3 lower_error;    ///< how far box.lower is below the smallest coordinates at most
  Vec3 upper_error;    ///< how far box.upper is above the largest coordinates at most
  bool proven = true;  ///< see SurfaceMeasures::proven
};
/// Finds the smallest box of a model's surfaces, as loops trim them, with sides that are off by at most
/// options.accuracy times the diagonal, where max_cells suffice. Errors: as measure_surfaces().
Result<MeasuredBox> measure_box(const Model& model, const MeasureOptions& options = {},
                                const Execution& execution = {});

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
