#pragma once
// The attributes of one instance of a STEP file, with errors that name it: "#12 CIRCLE in line 7: ...".

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "io/step/step_index.h"
#include "io/step/step_record.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// An instance while it is read. The first error stays in status(), and what is read from then on is 0 or empty; so a
/// caller reads all attributes and then asks once.
class StepEntity {
 public:
  /// The index must outlive the entity.
  explicit StepEntity(const StepIndex& index) : index_(index) {}
  StepEntity(const StepIndex& index, std::uint64_t number) : index_(index) { read(number); }
  /// Reads an instance; memory is reused. Errors, in status(): parse_error (no such instance, a malformed record).
  void read(std::uint64_t number);

  const Status& status() const { return status_; }
  /// Tells whether the instance is of the kind, or has a part of it.
  bool is(std::string_view kind) const { return status_.ok() && record_.part(kind) != StepRecord::npos; }
  /// Tells whether the instance is "(A()B())".
  bool has_parts() const { return instance_ != nullptr && instance_->kind == StepIndex::several_kinds; }
  /// Returns an error that names the instance and its line.
  Status error(std::string_view what, StatusCode code = StatusCode::parse_error) const;
  /// Returns `status` if it is ok, or else the error with the name of the instance.
  Status named(const Status& status) const { return status.ok() ? status : error(status.message(), status.code()); }
  void fail(std::string_view what, StatusCode code = StatusCode::parse_error);  ///< sets status()

  /// Returns the place of the k-th attribute of a part, or of the record itself if it has no parts.
  std::size_t attribute(std::size_t k) { return attribute(0, k); }
  std::size_t attribute(std::size_t part, std::size_t k);
  std::size_t part(std::string_view kind) const { return record_.part(kind); }
  const StepRecord& record() const { return record_; }  ///< empty if it is malformed or missing
  /// Tells whether a value is left out, $ or *.
  bool is_omitted(std::size_t at) const;
  StepKind kind_of(std::size_t at) const { return at < record_.size() ? record_[at].kind : StepKind::omitted; }
  /// Returns the places of the values of a list; none and an error if it is no list.
  std::vector<std::size_t> list(std::size_t at);

  double real(std::size_t at);  ///< a finite number, also within a typed value such as LENGTH_MEASURE(1.)
  /// A number above 0; `what` names it, such as "radius".
  double positive(std::size_t at, std::string_view what);
  int integer(std::size_t at);
  bool logical(std::size_t at);                  ///< .T. or .F.
  std::string_view enumeration(std::size_t at);  ///< without the dots
  std::string_view string(std::size_t at);       ///< as it is in the file: see step_text(); empty if left out
  std::uint64_t reference(std::size_t at);       ///< to an instance of the file
  std::vector<double> reals(std::size_t at);     ///< a list
  /// Reads a list of numbers, as many as fit into `out`. Returns how many it has.
  std::size_t reals(std::size_t at, std::span<double> out);
  std::vector<std::uint64_t> references(std::size_t at);  ///< a list

 private:
  std::string name() const;
  void unexpected(std::size_t at, std::string_view wanted);

  const StepIndex& index_;
  const StepInstance* instance_ = nullptr;
  std::uint64_t number_ = 0;
  StepRecord record_;
  Status status_;
};

/// Tells whether an instance is of the kind, or has a part of it. Reads its record only if it has parts.
bool is_step_kind(const StepIndex& index, std::uint64_t number, std::string_view kind);

}}  // namespace tessera::abi_0_1
