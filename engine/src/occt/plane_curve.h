#pragma once
// The curves of edges in the parameters of planes, for which files state none.

#include <opencascade/Geom2d_Curve.hxx>
#include <opencascade/Geom_Plane.hxx>
#include <opencascade/TopLoc_Location.hxx>
#include <opencascade/TopoDS_Edge.hxx>

#include "tessera/curve.h"

namespace tessera { inline namespace abi_0_1 {

/// Returns the curve of an edge in the parameters of a plane at `place`, as OpenCASCADE's own call finds it by way of
/// several others: lines, circles and ellipses that lie parallel to the plane, and splines. Null for other edges, and
/// for those at another place. `range`: of the curve. May throw Standard_Failure.
opencascade::handle<Geom2d_Curve> curve_on_plane(const TopoDS_Edge& edge, const Geom_Plane& plane,
                                                 const TopLoc_Location& place, Interval& range);

}}  // namespace tessera::abi_0_1
