#pragma once
// The surface of a face as a surface of the engine.

#include <array>
#include <opencascade/Geom_Surface.hxx>
#include <optional>
#include <string_view>

#include "io_occt/arcs.h"
#include "tessera/geometry.h"
#include "tessera/nurbs_surface.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Maps OpenCASCADE's parameters of a surface to ours.
struct Reparametrization {
  std::optional<Arcs> u, v;  ///< empty: equal parameters

  bool is_identity() const { return !u && !v; }
  std::array<double, 2> operator()(double theirs_u, double theirs_v) const {
    return {u ? u->parameter(theirs_u) : theirs_u, v ? v->parameter(theirs_v) : theirs_v};
  }
};

struct FaceSurface {
  BSplineSurface surface;
  Reparametrization parameters;
  double fit_error = 0;  ///< 0: exact
};

/// The surface inside wrappers that change neither points nor parameters, such as a rectangle that trims it.
opencascade::handle<Geom_Surface> bare_surface(opencascade::handle<Geom_Surface> surface);

/// The part of `surface` over `box`, a rectangle of OpenCASCADE's parameters (angles span at most 2 pi). Errors: those
/// of BSplineSurface, unsupported. May throw Standard_Failure.
Result<FaceSurface> face_surface(const opencascade::handle<Geom_Surface>& surface, const Domain& box);

}}  // namespace tessera::abi_0_1
