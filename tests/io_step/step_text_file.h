#pragma once
// STEP texts of a few instances, with their index.

#include <string>
#include <utility>

#include "io/step/step_index.h"
#include "support/synthetic_sets.h"

namespace tessera::test {

/// A text whose DATA section begins in line 4. Not copied: the index refers to the text.
struct StepTextFile {
  explicit StepTextFile(const std::string& data)
      : text("ISO-10303-21;\nHEADER;ENDSEC;\nDATA;\n" + data + "ENDSEC;\nEND-ISO-10303-21;\n"),
        index(value_of(StepIndex::make(text))) {}
  StepTextFile(const StepTextFile&) = delete;
  StepTextFile& operator=(const StepTextFile&) = delete;

  std::string text;
  StepIndex index;
};

/// Points, directions and placements that the tests share: #20 is the placement of tilted_frame().
inline const std::string step_axes =
    "#1=CARTESIAN_POINT('',(3.,-1.,2.));\n#2=DIRECTION('',(2.,1.,2.));\n#3=DIRECTION('',(1.,0.,0.));\n"
    "#20=AXIS2_PLACEMENT_3D('',#1,#2,#3);\n#21=AXIS1_PLACEMENT('',#1,#2);\n"
    "#22=DIRECTION('',(0.,3.,4.));\n#23=VECTOR('',#22,2.5);\n#24=LINE('',#1,#23);\n";

}  // namespace tessera::test
