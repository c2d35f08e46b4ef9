#pragma once
// Checks of the maps of models that are made of shapes of OpenCASCADE.

#include <opencascade/TopoDS_Shape.hxx>
#include <string>

#include "tessera/occt.h"

namespace tessera::test {

/// Expects that each face and edge of the model is one of the shape, in place and orientation; that they coincide at
/// mapped parameters, to within 1e-9 of the size or `fit`; that the maps undo each other, and that faces look to the
/// same side. Returns how many points were compared.
int expect_mapped(const OcctModel& all, const TopoDS_Shape& shape, const std::string& name, double fit = 0);

}  // namespace tessera::test
