// Values of records and texts of STEP files.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "io/step/step_record.h"

namespace tessera::test { namespace {

/// A record written again from its values.
std::string written(const StepRecord& record, std::size_t at) {
  const StepValue& value = record[at];
  const auto inner = [&] {
    std::string out = "(";
    for (std::size_t k = at + 1; k < value.end; k = record[k].end) out += (k > at + 1 ? "," : "") + written(record, k);
    return out + ')';
  };
  switch (value.kind) {
    case StepKind::omitted:
      return "$";
    case StepKind::derived:
      return "*";
    case StepKind::integer:
      return std::to_string(static_cast<long long>(value.number));
    case StepKind::real:
      return std::to_string(value.number);
    case StepKind::text:
      return "'" + std::string(value.text) + "'";
    case StepKind::binary:
      return '"' + std::string(value.text) + '"';
    case StepKind::enumeration:
      return '.' + std::string(value.text) + '.';
    case StepKind::reference:
      return '#' + std::to_string(value.reference);
    case StepKind::list:
      return inner();
    case StepKind::typed:
      return std::string(value.text) + inner();
  }
  return "?";
}
std::string read_again(const std::string& text) {
  StepRecord record;
  if (const Status status = record.read(text); !status.ok()) return std::string(status.message());
  std::string out;
  for (std::size_t at = 0; at < record.size(); at = record[at].end) out += written(record, at);
  return out;
}

TEST(StepRecord, ReadsValuesOfEachKind) {
  EXPECT_EQ(read_again("A ( $ , * , -12 , +3, 'it''s' , \"0F\" , .T. , #42 , ( ) , (( 1 ) , 2 ) , LENGTH ( 2.5 ) ) "),
            "A($,*,-12,3,'it''s',\"0F\",.T.,#42,(),((1),2),LENGTH(2.500000))");
  EXPECT_EQ(read_again("(A(1)B()C(D(2)))"), "A(1)B()C(D(2))");
  EXPECT_EQ(read_again("P(/* c */1.,.5,1.E+2,-1.5e-1)"), "P(1.000000,0.500000,100.000000,-0.150000)");
  EXPECT_EQ(read_again("!MINE()"), "!MINE()");
  EXPECT_EQ(read_again("A(1,(#2,),)"), "A(1,(#2))");  // as some programs write lists
}

TEST(StepRecord, FindsPartsAndValues) {
  StepRecord record;
  ASSERT_TRUE(record.read("(A(1,(2,3),4)B()C('x'))").ok());
  const std::size_t a = record.part("A");
  ASSERT_EQ(a, 0u);
  EXPECT_EQ(record.count(a), 3u);
  EXPECT_EQ(record[record.within(a, 2)].number, 4);
  EXPECT_EQ(record.within(a, 3), 0u);
  EXPECT_EQ(record.count(record.within(a, 1)), 2u);
  EXPECT_EQ(record.count(record.part("B")), 0u);
  EXPECT_EQ(record[record.within(record.part("C"), 0)].text, "x");
  EXPECT_EQ(record.part("D"), StepRecord::npos);
}

TEST(StepRecord, RefusesWhatIsMalformed) {
  for (
      const char* const text :
      {"",        "A",     "A(",       "A(1",  "A(,1)",  "A(1 2)", "A()x",        "A())",    "()",
       "(A)",     "(A(1)", "A('x)",    "A(#)", "A(.T)",  "A(nan)", "A(-nan)",     "A(-inf)", "A(-)",
       "A(1,,2)", "(1)",   "A(1)B(2)", "#5",   "A(\"0)", "A(@)",   "(A(1),B(2))", "A(B)",    "A(#99999999999999999999)",
       "A(--1)",  "A(%)"})
    EXPECT_TRUE(read_again(text).starts_with("expected ")) << text << ": " << read_again(text);
  StepRecord record;
  EXPECT_EQ(record.read("A(1,?)").index(), 4);
  EXPECT_EQ(record.size(), 0u);
  EXPECT_TRUE(record.read("A(1e999)").ok());
  EXPECT_TRUE(std::isnan(record[1].number));
}

TEST(StepRecord, DeepListsDoNotOverflowTheStack) {
  constexpr std::size_t depth = 300000;
  StepRecord record;
  EXPECT_TRUE(record.read("A" + std::string(depth, '(') + std::string(depth, ')')).ok());
  EXPECT_EQ(record.size(), depth);
  EXPECT_FALSE(record.read("A" + std::string(depth, '(')).ok());
}

TEST(StepText, IsUtf8) {
  EXPECT_EQ(step_text("it''s \\\\ a"), "it's \\ a");
  EXPECT_EQ(step_text("M\\X\\FCller"), "M\xc3\xbcller");
  EXPECT_EQ(step_text("\\X2\\00FC4E2D\\X0\\!"), "\xc3\xbc\xe4\xb8\xad!");
  EXPECT_EQ(step_text("\\X4\\0001F600\\X0\\"), "\xf0\x9f\x98\x80");
  EXPECT_EQ(step_text("\\X2\\D83DDE00\\X0\\"), "\xf0\x9f\x98\x80");
  EXPECT_EQ(step_text("\\PA\\\\S\\|"), "\xc3\xbc");
  EXPECT_EQ(step_text("M\xfcller \xc3\xbc"), "M\xc3\xbcller \xc3\xbc");
  for (const char* const malformed :
       {"\\X", "\\X2\\00F\\X0\\", "\\X2\\00FC", "\\X\\G0", "\\Q\\", "\\S\\", "\\X4\\FFFFFFFF\\X0\\"})
    EXPECT_EQ(step_text(malformed), malformed);
  EXPECT_EQ(step_text("\xf5\x80\x80\x80\xe4\xb8"), "\xc3\xb5\xc2\x80\xc2\x80\xc2\x80\xc3\xa4\xc2\xb8");
  EXPECT_EQ(step_text(""), "");
}

}}  // namespace tessera::test
