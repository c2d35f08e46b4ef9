// The instances of STEP texts: what is found, what is left out with a remark, and several threads.

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <string>
#include <vector>

#include "io/step/step_index.h"
#include "io/step/step_record.h"
#include "support/random_patches.h"
#include "support/synthetic_sets.h"

namespace tessera::test { namespace {

std::string file_of(const std::string& data) {
  return "ISO-10303-21;\nHEADER;\nFILE_NAME('#1=A();','2026',(''),(''),'','','');\nENDSEC;\nDATA;\n" + data +
         "ENDSEC;\nEND-ISO-10303-21;\n";
}

/// "#1=A(1);#2=(B()C());", as the index has them.
std::string found_in(const StepIndex& index) {
  std::string out;
  for (const StepInstance& one : index.instances())
    out += '#' + std::to_string(one.number) + '=' + std::string(index.record(one)) + ';';
  return out;
}
std::string found_in(const std::string& text) { return found_in(value_of(StepIndex::make(text))); }

TEST(StepIndex, FindsInstancesWhateverLiesBetween) {
  EXPECT_EQ(found_in(file_of("#1=A('x');#3 = B(#1,(2.,$));\n#7\n=/* c */ (C()D(*)) ;")),
            "#1=A('x');#3=B(#1,(2.,$));#7=(C()D(*)) ;");
  EXPECT_EQ(found_in(file_of("/* #1=A(); */#2=B('/*');#3=C('it''s; #9=D();','\n#4=E();');#5=F(\"0;\");")),
            "#2=B('/*');#3=C('it''s; #9=D();','\n#4=E();');#5=F(\"0;\");");
  EXPECT_EQ(found_in(file_of("#1=A(1 / 2);#2=!MINE();")), "#1=A(1 / 2);#2=!MINE();");
}

TEST(StepIndex, SortsByNumberAndKeepsTheFirstOfEqualOnes) {
  const std::string text = file_of("#30=A();\n#2=B();\n#30=C();\n#7=B();\n");
  const StepIndex index = value_of(StepIndex::make(text));
  EXPECT_EQ(found_in(index), "#2=B();#7=B();#30=A();");
  ASSERT_EQ(index.remarks().size(), 1u);
  EXPECT_EQ(index.remarks()[0].line, 8u);
  EXPECT_EQ(index.remarks()[0].text, "#30 occurs again: the first one counts");
  EXPECT_EQ(index.find(7)->number, 7u);
  for (const std::uint64_t missing : {0u, 1u, 3u, 29u, 31u}) EXPECT_EQ(index.find(missing), nullptr);
  EXPECT_EQ(index.of_kind("B").size(), 2u);
  EXPECT_EQ(index.of_kind("C").size(), 0u);
  EXPECT_EQ(index.of_kind("NONE").size(), 0u);
}

TEST(StepIndex, FindsPartsOfInstancesOfSeveralKinds) {
  const std::string text = file_of("#1=(A()BC(1))\n;#2=BC();#3=( X( ')BC(' ) );#4=(BC ()X());#5=(A()BCD());#6=(BC(;\n");
  const StepIndex index = value_of(StepIndex::make(text));
  std::string found;
  for (const std::uint32_t place : index.with_part("BC"))
    found += std::to_string(index.instances()[place].number) + ' ';
  EXPECT_EQ(found, "1 4 ");
  EXPECT_TRUE(index.with_part("NONE").empty());
}

TEST(StepIndex, TakesSeveralSectionsAndSkipsOthers) {
  const std::string text =
      "ISO-10303-21;HEADER;ENDSEC;ANCHOR;<a>=#1;ENDSEC;REFERENCE;#9=<b.stp#c>;ENDSEC;DATA('one',('S'));#1=A();ENDSEC;"
      "DATA;#2=B();ENDSEC;END-ISO-10303-21;SIGNATURE;#3=C();ENDSEC;";
  EXPECT_EQ(found_in(text), "#1=A();#2=B();");
}

TEST(StepIndex, TakesScopes) {
  EXPECT_EQ(found_in(file_of("#1=&SCOPE #2=A(); #3=B(#2); ENDSCOPE /#2,#3/ C(#2);#4=D();")),
            "#1=C(#2);#2=A();#3=B(#2);#4=D();");
  EXPECT_EQ(value_of(StepIndex::make(file_of("#1=&SCOPE #2=A();"))).remark_count(), 1u);
}

TEST(StepIndex, RemarksNameLines) {
  const auto remarks = [](const std::string& text) {
    std::string out;
    const StepIndex index = value_of(StepIndex::make(text));
    for (const StepRemark& one : index.remarks()) out += std::to_string(one.line) + ": " + one.text + '\n';
    return out;
  };
  EXPECT_EQ(remarks(file_of("#1=A();\n#2=5;\nHELLO;\n#=B();\n")),
            "7: #2 is no instance: it is left out\n"
            "8: expected an instance, such as #1=..., found \"HELLO;\n#=B();\nENDSEC\"\n"
            "9: an instance without a number is no instance: it is left out\n");
  EXPECT_EQ(remarks("DATA;\n#1=A();\n#2=B('x"), "3: the file ends within #2\n");
  EXPECT_EQ(remarks("DATA;#1=A();/* no end"), "");
  EXPECT_EQ(remarks("DATA;#99999999999999999999999=A();"),
            "1: an instance without a number is no instance: it is left out\n");
  std::string many = "DATA;";
  for (int k = 0; k < 50; ++k) many += "#1=A();";
  const StepIndex index = value_of(StepIndex::make(many));
  EXPECT_EQ(index.remarks().size(), StepIndex::max_remarks);
  EXPECT_EQ(index.remark_count(), 49u);
}

TEST(StepIndex, CountsLinesOfLongTexts) {
  std::string text = "DATA;\n";
  std::vector<std::size_t> begins{0, text.size()};
  Random random(6);
  while (text.size() < 300000) {
    text += std::string(random() % 900, ' ') + '\n';
    begins.push_back(text.size());
  }
  const StepIndex index = value_of(StepIndex::make(text));
  for (std::size_t k = 0; k < begins.size(); ++k) ASSERT_EQ(index.line(begins[k]), k + 1);
  EXPECT_EQ(index.line(text.size()), begins.size());
  EXPECT_EQ(value_of(StepIndex::make("DATA;")).line(0), 1u);
}

TEST(StepIndex, WithoutData) {
  for (const char* const text :
       {"", " ", "solid x", "ISO-10303-21;HEADER;ENDSEC;", "#1=A();", ";;;'", "/*", "DAT", "/"})
    EXPECT_EQ(StepIndex::make(text).status().code(), StatusCode::parse_error) << text;
  EXPECT_EQ(value_of(StepIndex::make("DATA;")).instances().size(), 0u);
  const std::atomic<bool> cancel = true;
  const std::string long_text = file_of(std::string(5u << 20, ' '));
  tbb::task_arena arena(3);
  arena.execute(
      [&] { EXPECT_EQ(StepIndex::make(long_text, {.cancel = &cancel}).status().code(), StatusCode::cancelled); });
}

/// Long texts whose strings and comments look like instances, so that pieces begin at wrong places.
TEST(StepIndex, ThreadsFindWhatOneFinds) {
  std::string data;
  for (int k = 1; data.size() < (6u << 20); ++k) {
    const std::string number = std::to_string(k);
    data += '#' + number + "=POINT('',(1.5,2.5,-" + number + ".));\n";
    if (k % 5000 == 0)
      data += "#" + std::to_string(k + 9000000) + "=NOTE('" + std::string(300000, '-') +
              "\n#1=FALSE();\n#2=" + "FALSE('');\n');\n";
    if (k % 7001 == 0) data += "/*\n#3=FALSE();\n" + std::string(200000, ' ') + "\n#4=FALSE();\n*/\n";
    if (k % 9001 == 0) data += "#" + number + "=TWICE();\n";
  }
  const std::string text = file_of(data);
  std::string expected;
  tbb::task_arena(1).execute([&] { expected = found_in(text); });
  EXPECT_EQ(expected.find("FALSE();;"), std::string::npos);
  for (const int threads : {2, 3, 8})
    tbb::task_arena(threads).execute([&] { EXPECT_TRUE(found_in(text) == expected) << threads; });
}

TEST(StepIndex, AnyBytesEnd) {
  const std::string sound = file_of(
      "#1=A('it''s \\X2\\00FC\\X0\\',(1.5,$,*),.T.,\"0F\");\n#2=(B(#1)C());/* c */#3=&SCOPE #4=D(); ENDSCOPE /#4/ "
      "E(#4);\n");
  const std::string bytes = "#=();,'\"/*\\.$&\n0A\xff";
  Random random(4);
  StepRecord record;
  std::size_t sections = 0, records = 0;
  for (int round = 0; round < 20000; ++round) {
    std::string text = sound;
    for (std::uint64_t k = random() % 6; k-- > 0;) {
      const std::size_t at = random() % text.size();
      if (random() % 2 == 0)
        text[at] = bytes[random() % bytes.size()];
      else if (random() % 2 == 0)
        text.insert(at, 1, bytes[random() % bytes.size()]);
      else
        text.erase(at, 1 + random() % 4);
    }
    if (random() % 8 == 0) text.resize(random() % text.size());
    const Result<StepIndex> index = StepIndex::make(text);
    if (!index) continue;
    ++sections;
    for (const StepInstance& one : index->instances()) {
      records += record.read(index->record(one)).ok();
      for (std::size_t k = 0; k < record.size(); ++k) {
        ASSERT_GT(record[k].end, k);
        ASSERT_LE(record[k].end, record.size());
        (void)step_text(record[k].text);
      }
    }
  }
  EXPECT_GT(sections, 10000u);
  EXPECT_GT(records, 20000u);
}

}}  // namespace tessera::test
