#pragma once
// The surface of a face as a surface of the engine.

#include <opencascade/Geom_Surface.hxx>

#include "exact/swept_surface.h"
#include "tessera/geometry.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// The surface inside wrappers that change neither points nor parameters, such as a rectangle that trims it.
opencascade::handle<Geom_Surface> bare_surface(opencascade::handle<Geom_Surface> surface);

/// The part of `surface` over `box`, a rectangle of OpenCASCADE's parameters (angles span at most 2 pi). `most`: how
/// far it may move to have fewer spans. Errors: those of BSplineSurface, unsupported. May throw Standard_Failure.
Result<FaceSurface> face_surface(const opencascade::handle<Geom_Surface>& surface, const Domain& box,
                                 const SplineShift& most = {});

}}  // namespace tessera::abi_0_1
