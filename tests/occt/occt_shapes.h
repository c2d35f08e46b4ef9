#pragma once
// Shapes of OpenCASCADE with faces of all kinds.

#include <opencascade/TopoDS_Compound.hxx>
#include <opencascade/TopoDS_Face.hxx>
#include <opencascade/TopoDS_Shape.hxx>
#include <opencascade/gp_Trsf.hxx>
#include <string>
#include <vector>

namespace tessera::test {

struct NamedShape {
  std::string name;
  TopoDS_Shape shape;
};

/// Solids, open shells and single faces: quadrics, splines, swept and offset surfaces, fillets, cut bodies; reversed,
/// mirrored, placed and repeated ones.
std::vector<NamedShape> occt_shapes();

/// A box with rounded edges and a hole through it.
TopoDS_Shape drilled_box();

TopoDS_Compound compound_of(const std::vector<TopoDS_Shape>& shapes);
gp_Trsf shift(double x, double y, double z);
/// In the order of the shape, as it holds them.
std::vector<TopoDS_Face> faces_in(const TopoDS_Shape& shape);

}  // namespace tessera::test
