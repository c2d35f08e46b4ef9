#include "io/step/step_contents.h"

#include <gtest/gtest.h>

#include "support/synthetic_sets.h"

namespace tessera::test { namespace {

TEST(StepContents, CountsEntitiesByKind) {
  const StepIndex index = value_of(StepIndex::make(
      "ISO-10303-21;\nHEADER;FILE_NAME('BLOCK(',$);ENDSEC;\nDATA;\n#1=BLOCK('it''s #2=SPHERE(',#2,1.,2.,.T.);\n"
      "/* #3=TORUS(); */#4 = ( LENGTH_UNIT() NAMED_UNIT(*) ) ;#5=CSG_SOLID('',#1);\n#6=\nBLOCK('');ENDSEC;"));
  const StepKinds kinds = step_kinds(index);
  EXPECT_EQ(kinds, (StepKinds{{"BLOCK", 2}, {"CSG_SOLID", 1}, {"LENGTH_UNIT", 1}, {"NAMED_UNIT", 1}}));
  EXPECT_EQ(unread_shapes(kinds), "1 CSG_SOLID, 2 BLOCK");
  EXPECT_EQ(contents_of({{"PERSON", 2}, {"DATE", 3}}), "3 DATE, 2 PERSON");
  EXPECT_EQ(contents_of({}), "");
}

}}  // namespace tessera::test
