// The trimming loops of a surface: lists of curves in its parameters.

#include "io/json/json_kinds.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

bool read_flag(const JsonValue& value) {
  if (!value.is(JsonKind::boolean)) value.fail_expected("true or false");
  return value.number() != 0;
}

TrimLoop read_loop(const JsonValue& value) {
  const Fields fields(value, {"curves", "hole"});
  TrimLoop loop;
  for (const JsonValue curve : array(fields.at("curves"), "an array of curves"))
    loop.curves.push_back(read_parameter_curve(curve));
  loop.hole = fields.get("hole", false, read_flag);
  return loop;
}

}  // namespace

std::vector<TrimLoop> read_trims(const JsonValue& value) {
  std::vector<TrimLoop> loops;
  for (const JsonValue loop : array(value, "an array of loops", 0)) loops.push_back(read_loop(loop));
  return loops;
}

}}  // namespace tessera::abi_0_1
