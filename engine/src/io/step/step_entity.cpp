#include "io/step/step_entity.h"

#include <cmath>

#include "base/text.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Says what a value is, for messages.
std::string described(const StepValue& value) {
  switch (value.kind) {
    case StepKind::omitted:
      return "$";
    case StepKind::derived:
      return "*";
    case StepKind::integer:
      return "an integer";
    case StepKind::real:
      return std::isfinite(value.number) ? "a real number" : "a number beyond the range of double";
    case StepKind::text:
      return "a text";
    case StepKind::binary:
      return "a binary value";
    case StepKind::enumeration:
      return "." + std::string(value.text.substr(0, 40)) + ".";
    case StepKind::reference:
      return "#" + std::to_string(value.reference);
    case StepKind::list:
      return "a list";
    case StepKind::typed:
      break;
  }
  return std::string(value.text.substr(0, 40)) + "(..)";
}

}  // namespace

void StepEntity::read(std::uint64_t number) {
  number_ = number, status_ = {}, instance_ = index_.find(number);
  if (instance_ == nullptr) {
    (void)record_.read("");
    status_ = Status(StatusCode::parse_error, "#" + std::to_string(number) + " is not in the file");
  } else if (const Status status = record_.read(index_.record(*instance_)); !status.ok()) {
    fail(status.message());
  }
}

std::string StepEntity::name() const {
  std::string out = "#" + std::to_string(number_);
  if (instance_ == nullptr) return out;
  out += ' ';
  if (!has_parts()) return out += index_.kinds()[instance_->kind];
  for (std::size_t at = 0; at < record_.size(); at = record_[at].end) {
    if (!record_[at].text.starts_with("RATIONAL_") && !record_[at].text.starts_with("B_SPLINE_")) continue;
    return out += record_[at].text;
  }
  return out += record_.size() > 0 ? record_[0].text : std::string_view("of several kinds");
}

Status StepEntity::error(std::string_view what, StatusCode code) const {
  const std::string place = instance_ == nullptr ? "" : " in line " + std::to_string(index_.line(instance_->begin));
  return {code, name() + place + ": " + std::string(what)};
}

void StepEntity::fail(std::string_view what, StatusCode code) {
  if (status_.ok()) status_ = error(what, code);
}

void StepEntity::unexpected(std::size_t at, std::string_view wanted) {
  if (!status_.ok()) return;
  fail("expected " + std::string(wanted) + ", found " + described(record_[at]));
}

std::size_t StepEntity::attribute(std::size_t part, std::size_t k) {
  if (!status_.ok()) return StepRecord::npos;
  if (part >= record_.size()) return fail("a part that its kind must have is missing"), StepRecord::npos;
  const std::size_t at = record_.within(part, k);
  if (at != 0) return at;
  fail("expected at least " + counted(k + 1, "attribute") + ", found " + std::to_string(record_.count(part)));
  return StepRecord::npos;
}

bool StepEntity::is_omitted(std::size_t at) const {
  return kind_of(at) == StepKind::omitted || kind_of(at) == StepKind::derived;
}

std::vector<std::size_t> StepEntity::list(std::size_t at) {
  std::vector<std::size_t> out;
  if (!status_.ok()) return out;
  if (kind_of(at) != StepKind::list) return unexpected(at, "a list"), out;
  for (std::size_t k = at + 1; k < record_[at].end; k = record_[k].end) out.push_back(k);
  return out;
}

double StepEntity::real(std::size_t at) {
  if (!status_.ok()) return 0;
  if (kind_of(at) == StepKind::typed && record_.count(at) == 1) ++at;
  const bool is_number = kind_of(at) == StepKind::real || kind_of(at) == StepKind::integer;
  if (!is_number || !std::isfinite(record_[at].number)) return unexpected(at, "a finite number"), 0;
  return record_[at].number;
}

double StepEntity::positive(std::size_t at, std::string_view what) {
  const double value = real(at);
  if (!(value > 0)) fail("its " + std::string(what) + " is " + text(value) + ", expected a number above 0");
  return value;
}

int StepEntity::integer(std::size_t at) {
  if (!status_.ok()) return 0;
  if (kind_of(at) != StepKind::integer || !(std::abs(record_[at].number) < 0x1p31))
    return unexpected(at, "an integer"), 0;
  return static_cast<int>(record_[at].number);
}

std::string_view StepEntity::enumeration(std::size_t at) {
  if (!status_.ok()) return {};
  if (kind_of(at) != StepKind::enumeration) return unexpected(at, "a word between dots"), std::string_view();
  return record_[at].text;
}

bool StepEntity::logical(std::size_t at) {
  const std::string_view word = enumeration(at);
  if (word != "T" && word != "F") unexpected(at, ".T. or .F.");
  return word == "T";
}

std::string_view StepEntity::string(std::size_t at) {
  if (!status_.ok() || is_omitted(at)) return {};
  if (kind_of(at) != StepKind::text) return unexpected(at, "a text"), std::string_view();
  return record_[at].text;
}

std::uint64_t StepEntity::reference(std::size_t at) {
  if (!status_.ok()) return 0;
  if (kind_of(at) != StepKind::reference) return unexpected(at, "a reference to an instance"), 0;
  const std::uint64_t to = record_[at].reference;
  if (index_.find(to) == nullptr) return fail("refers to #" + std::to_string(to) + ", which is not in the file"), 0;
  return to;
}

std::vector<double> StepEntity::reals(std::size_t at) {
  std::vector<double> out;
  for (const std::size_t k : list(at)) out.push_back(real(k));
  return out;
}

std::size_t StepEntity::reals(std::size_t at, std::span<double> out) {
  if (!status_.ok()) return 0;
  if (kind_of(at) != StepKind::list) return unexpected(at, "a list"), 0;
  std::size_t count = 0;
  for (std::size_t k = at + 1; k < record_[at].end; k = record_[k].end, ++count)
    if (count < out.size()) out[count] = real(k);
  return count;
}

std::vector<std::uint64_t> StepEntity::references(std::size_t at) {
  std::vector<std::uint64_t> out;
  for (const std::size_t k : list(at)) out.push_back(reference(k));
  return out;
}

bool is_step_kind(const StepIndex& index, std::uint64_t number, std::string_view kind) {
  const std::string_view alone = index.kind_of(number);
  return alone == kind || (alone.empty() && StepEntity(index, number).is(kind));
}

}}  // namespace tessera::abi_0_1
