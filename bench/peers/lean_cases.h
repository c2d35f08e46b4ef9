#pragma once
// The cases of occt_lean_mesh: classic shapes as NURBS and as OpenCASCADE's own surfaces, and the surfaces of models.

#include <Geom_Surface.hxx>
#include <string>
#include <vector>

#include "tessera/patch_set.h"

namespace tessera::bench {

/// Surfaces for both programs. `surfaces` is empty if only Tessera's mesh is reported.
struct LeanCase {
  std::string name;
  PatchSet set;
  std::vector<Handle(Geom_Surface)> surfaces;
  std::vector<double> tolerances;  ///< lengths
  bool is_model = false;           ///< from a file
};

/// The degrees of a set's patches, and the largest ratio of two weights of one patch: "rational 2x1 2x2, weights to
/// 1:2".
std::string patch_kinds(const PatchSet& set);

/// Cylinders, a cone, a sphere, a torus, a fillet, a revolved and a ruled NURBS surface. Leaves out shapes whose names
/// do not contain `only`.
std::vector<LeanCase> shape_cases(const std::string& only);

/// The surfaces of the project's models and of the files below TESSERA_TEST_DATA: a case for the rational surfaces of
/// each file, and one for the polynomial ones. Leaves out trimmed and fitted surfaces, and files whose paths do not
/// contain `only`. Prints what it skips, and why.
std::vector<LeanCase> model_cases(const std::string& only);

}  // namespace tessera::bench
