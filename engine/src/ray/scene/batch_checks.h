#pragma once
// Checks the views of a call on a batch of rays or points.

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>

#include "base/text.h"
#include "eval/grid_checks.h"
#include "tessera/status.h"
#include "tessera/strided_view.h"

namespace tessera { inline namespace abi_0_1 {

/// Checks views one after the other and keeps the first error.
class BatchChecks {
 public:
  /// `outputs`: records that are written for each.
  explicit BatchChecks(std::size_t records, std::size_t outputs = 1)
      : records_(records), outputs_(records > no_limit / outputs ? no_limit : records * outputs), checks_(records) {}

  /// A view of stride 0 has one record for the whole batch.
  template <class T, int N>
  void input(const char* name, VectorView<T, N> view) {
    const std::size_t records = view.stride == 0 ? std::min<std::size_t>(records_, 1) : records_;
    if (view.stride == 0) view.stride = 1;
    if (view.size < records && error_.ok())
      error_ = Status(StatusCode::count_mismatch, std::string(name) + " needs " + counted(records_, "record") +
                                                      ", or one of stride 0, found " + std::to_string(view.size));
    if (error_.ok()) checks_.add(name, view, records);
  }
  /// Ignores a view without memory, which is not wanted.
  template <class T, int N>
  void output(const char* name, const VectorView<T, N>& view) {
    if (std::ranges::all_of(view.component, [](const auto* memory) { return memory == nullptr; })) return;
    checks_.add(name, view, outputs_);
    has_output_ = true;
  }
  /// Returns the first error, also if no output is wanted. Without records nothing is checked.
  Status status() const {
    if (records_ == 0) return {};
    if (!error_.ok()) return error_;
    if (Status status = checks_.status(); !status.ok()) return status;
    return has_output_ ? Status() : Status(StatusCode::invalid_argument, "no output is requested");
  }

 private:
  static constexpr std::size_t no_limit = std::numeric_limits<std::size_t>::max();
  std::size_t records_, outputs_;
  ViewChecks checks_;
  Status error_;
  bool has_output_ = false;
};

}}  // namespace tessera::abi_0_1
