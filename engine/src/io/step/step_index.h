#pragma once
// The instances of a STEP file (ISO 10303-21, "Part 21", editions 1 to 3), found in one pass over its text.
//
//   #12=CARTESIAN_POINT('',(0.,0.,0.));
//   #13=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tessera/execution.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// An instance: its number, and its record, the text after "=" and before ";".
struct StepInstance {
  std::uint64_t number;
  std::uint64_t begin;   ///< of the record in the text
  std::uint32_t length;  ///< of the record
  std::uint32_t kind;    ///< index into StepIndex::kinds(), or several_kinds
};

/// A fault of a file that leaves the other instances usable.
struct StepRemark {
  std::size_t line;  ///< from 1
  std::string text;
};

/// The instances of a file's DATA sections by their numbers. Const calls from any number of threads.
class StepIndex {
 public:
  static constexpr std::uint32_t several_kinds = 0xffffffff;  ///< "(A()B())"
  static constexpr std::size_t max_remarks = 20;              ///< more are counted only

  /// Finds the instances, in several threads if the text is long. Of instances with one number the first is kept.
  ///
  /// - `text`: of the whole file; must outlive the index.
  ///
  /// Errors: parse_error (no DATA section), unsupported (2^32 - 1 instances), cancelled, out_of_memory. Memory: 36
  /// bytes for each instance.
  static Result<StepIndex> make(std::string_view text, const Execution& execution = {});

  std::span<const StepInstance> instances() const { return instances_; }  ///< numbers rise
  /// Returns the instance with this number, or nullptr.
  const StepInstance* find(std::uint64_t number) const;
  /// Returns the kind of the instance with this number; empty if there is none, or if it is of several kinds.
  std::string_view kind_of(std::uint64_t number) const;
  std::string_view record(const StepInstance& of) const {
    return text_.substr(static_cast<std::size_t>(of.begin), of.length);
  }
  std::span<const std::string_view> kinds() const { return kinds_; }  ///< distinct names, such as "ADVANCED_FACE"
  /// Returns the places in instances() of those of one kind alone.
  std::span<const std::uint32_t> of_kind(std::string_view kind) const;
  /// Returns the number of instances of the kind kinds()[kind] alone.
  std::size_t count_of(std::size_t kind) const { return first_of_kind_[kind + 1] - first_of_kind_[kind]; }
  /// Returns the places in instances() of those of several kinds that have a part of this one. Reads the text of all
  /// of several kinds, but for splines.
  std::vector<std::uint32_t> with_part(std::string_view kind) const;
  /// Returns the line of a place in the text, from 1.
  std::size_t line(std::uint64_t place) const;

  std::span<const StepRemark> remarks() const { return remarks_; }
  std::size_t remark_count() const { return remark_count_; }

 private:
  friend class StepIndexMaker;
  void count_lines();
  bool sort_by_places();
  void sort_instances();
  void list_kinds();
  void remark(std::uint64_t place, std::string text);

  std::string_view text_;
  std::vector<StepInstance> instances_;
  std::vector<std::string_view> kinds_;
  std::vector<std::uint32_t> by_kind_, first_of_kind_;  ///< places, and where those of each kind begin
  static constexpr std::size_t line_block = std::size_t{1} << 16;
  std::vector<std::size_t> lines_before_;  ///< line ends before each block of so many bytes
  std::vector<StepRemark> remarks_;
  std::size_t remark_count_ = 0;
};

}}  // namespace tessera::abi_0_1
