#pragma once
// Texts of products, assemblies and representations of STEP files, and their trees.

#include <string>
#include <vector>

#include "io/step/step_tree.h"
#include "io_step/step_text_file.h"
#include "support/synthetic_sets.h"

namespace tessera::test {

inline std::string ref(int number) { return "#" + std::to_string(number); }

/// "(#1,#2)".
inline std::string refs(const std::vector<int>& numbers) {
  std::string out;
  for (const int number : numbers) out += (out.empty() ? "(" : ",") + ref(number);
  return out.empty() ? "()" : out + ")";
}

/// Contexts of lengths in millimetres, #900, and in inches, #901; placements at the origin, #910, and at (x, 0, 0) for
/// x from 1 to 3, #911 to #913, the last of which is turned from x to y; solids #921 to #924.
inline const std::string step_basics =
    "#900=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT((#902))REPRESENTATION_CONTEXT('',''));\n"
    "#901=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNIT_ASSIGNED_CONTEXT((#903))REPRESENTATION_CONTEXT('',''));\n"
    "#902=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));\n"
    "#903=(CONVERSION_BASED_UNIT('INCH',#904)LENGTH_UNIT()NAMED_UNIT($));\n"
    "#904=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#902);\n"
    "#905=DIRECTION('',(0.,1.,0.));\n#906=DIRECTION('',(0.,0.,1.));\n#907=DIRECTION('',(0.,0.,-1.));\n"
    "#930=CARTESIAN_POINT('',(0.,0.,0.));\n#931=CARTESIAN_POINT('',(1.,0.,0.));\n"
    "#932=CARTESIAN_POINT('',(2.,0.,0.));\n#933=CARTESIAN_POINT('',(3.,0.,0.));\n"
    "#910=AXIS2_PLACEMENT_3D('',#930,$,$);\n#911=AXIS2_PLACEMENT_3D('',#931,$,$);\n"
    "#912=AXIS2_PLACEMENT_3D('',#932,$,$);\n#913=AXIS2_PLACEMENT_3D('',#933,#906,#905);\n"
    "#921=MANIFOLD_SOLID_BREP('',$);\n#922=MANIFOLD_SOLID_BREP('',$);\n#923=MANIFOLD_SOLID_BREP('',$);\n"
    "#924=MANIFOLD_SOLID_BREP('',$);\n";

/// A representation of these items in the context #900 or another one.
inline std::string shape_text(int number, const std::vector<int>& items, int context = 900,
                              const std::string& kind = "SHAPE_REPRESENTATION") {
  return ref(number) + "=" + kind + "(''," + refs(items) + "," + ref(context) + ");\n";
}

/// A product with these representations: its definition is `first`; it takes numbers up to `first` + 9.
inline std::string product_text(int first, const std::string& name, const std::vector<int>& shapes) {
  std::string out = ref(first) + "=PRODUCT_DEFINITION('',''," + ref(first + 1) + ",$);\n" + ref(first + 1) +
                    "=PRODUCT_DEFINITION_FORMATION('',''," + ref(first + 2) + ");\n" + ref(first + 2) +
                    "=PRODUCT('id of " + name + "','" + name + "','',());\n" + ref(first + 3) +
                    "=PRODUCT_DEFINITION_SHAPE('',''," + ref(first) + ");\n";
  for (std::size_t k = 0; k < shapes.size(); ++k)
    out += ref(first + 4 + static_cast<int>(k)) + "=SHAPE_DEFINITION_REPRESENTATION(" + ref(first + 3) + "," +
           ref(shapes[k]) + ");\n";
  return out;
}

/// A use of a component in an assembly, without a place: it takes the number `first`.
inline std::string use_text(int first, const std::string& name, int assembly, int component) {
  return ref(first) + "=NEXT_ASSEMBLY_USAGE_OCCURRENCE('id','" + name + "',''," + ref(assembly) + "," + ref(component) +
         ",$);\n";
}

/// The place of the use `first`: it takes the numbers up to `first` + 4.
inline std::string place_text(int first, int rep1, int rep2, int item1, int item2) {
  return ref(first + 1) + "=PRODUCT_DEFINITION_SHAPE('',''," + ref(first) + ");\n" + ref(first + 2) +
         "=CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(" + ref(first + 3) + "," + ref(first + 1) + ");\n" + ref(first + 3) +
         "=(REPRESENTATION_RELATIONSHIP('',''," + ref(rep1) + "," + ref(rep2) +
         ")REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(" + ref(first + 4) +
         ")SHAPE_REPRESENTATION_RELATIONSHIP());\n" + ref(first + 4) + "=ITEM_DEFINED_TRANSFORMATION('',''," +
         ref(item1) + "," + ref(item2) + ");\n";
}

/// A mapped item `first` of a representation, and its map `first` + 1.
inline std::string mapped_text(int first, int shape, int origin, int target) {
  return ref(first) + "=MAPPED_ITEM(''," + ref(first + 1) + "," + ref(target) + ");\n" + ref(first + 1) +
         "=REPRESENTATION_MAP(" + ref(origin) + "," + ref(shape) + ");\n";
}

/// A colour of an item: a styled item `first`, of numbers up to `first` + 6; `colour` is the text of the last one.
/// `more` are attributes after the item.
inline std::string style_text(int first, const std::string& item, const std::string& colour,
                              const std::string& kind = "STYLED_ITEM", const std::string& more = "") {
  const auto id = [first](int k) { return ref(first + k); };
  return id(0) + "=" + kind + "('',(" + id(1) + ")," + item + more + ");\n" + id(1) +
         "=PRESENTATION_STYLE_ASSIGNMENT((NULL_STYLE(.NULL.)," + id(2) + "));\n" + id(2) +
         "=SURFACE_STYLE_USAGE(.BOTH.," + id(3) + ");\n" + id(3) + "=SURFACE_SIDE_STYLE('',(" + id(4) + "));\n" +
         id(4) + "=SURFACE_STYLE_FILL_AREA(" + id(5) + ");\n" + id(5) + "=FILL_AREA_STYLE('',(" + id(6) + "));\n" +
         id(6) + "=FILL_AREA_STYLE_COLOUR(''," + id(7) + ");\n" + id(7) + "=" + colour + ";\n";
}

/// The tree of these instances and the basic ones.
inline StepTree tree_of(const std::string& data) {
  const StepTextFile file(step_basics + data);
  return value_of(read_step_tree(file.index));
}

}  // namespace tessera::test
