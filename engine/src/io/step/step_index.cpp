#include "io/step/step_index.h"

#include <algorithm>
#include <charconv>
#include <ranges>
#include <utility>

#include "base/text.h"
#include "io/step/step_record.h"
#include "io/step/step_scan.h"
#include "parallel/caller_arena.h"
#include "parallel/parallel_for.h"
#include "tessera/guard.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Counts line ends, by searches, which look at many characters at once.
std::size_t line_ends(std::string_view text) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string_view::npos; ++at) ++count;
  return count;
}

}  // namespace

/// Reads the sections of a file. Long runs of instances are scanned in pieces by several threads, each from where an
/// instance seems to begin. A piece counts if the one before ends just there; otherwise its text is scanned again.
class StepIndexMaker {
 public:
  StepIndexMaker(std::string_view text, StepIndex& index) : text_(text), index_(index) {
    index_.text_ = text;
    index_.count_lines();
  }

  Status make(const Execution& execution) {
    if (Status status = scan_pieces(execution); !status.ok()) return status;
    for (std::size_t at = skip_blanks(text_, 0); at < text_.size();) {
      if (Status status = report(at, execution); !status.ok()) return status;
      at = text_[at] == '#' ? instances(at) : statement(at);
    }
    if (execution.progress && pieces_.empty()) execution.progress(1);
    if (!has_data_) return {StatusCode::parse_error, "no DATA section was found: this is not a STEP file"};
    if (index_.instances_.size() > max_instances)
      return {StatusCode::unsupported, "a STEP file of more than 2^32 - 2 instances"};
    if (!scopes_.empty()) index_.remark(text_.size(), "a scope is not closed by ENDSCOPE");
    index_.kinds_ = kinds_.names();
    index_.sort_instances();
    index_.list_kinds();
    return {};
  }

 private:
  static constexpr std::size_t max_instances = 0xfffffffe;
  static constexpr std::size_t piece_bytes = std::size_t{1} << 20;

  Status scan_pieces(const Execution& execution) {
    const std::size_t data = std::min(text_.find("DATA"), text_.size());
    const std::size_t count = arena_threads() > 1 ? (text_.size() - data) / piece_bytes : 0;
    pieces_.resize(count);
    if (count == 0) return {};
    return parallel_for(count, 1, execution, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        const std::size_t from = data + k * piece_bytes, to = k + 1 < count ? from + piece_bytes : text_.size();
        pieces_[k] = scan_instances(text_, likely_instance(text_, from, to), to);
      }
    });
  }

  /// Reports a place of the text about once for each piece. Errors: cancelled.
  Status report(std::size_t at, const Execution& execution) {
    if (at < next_report_) return {};
    next_report_ = at + piece_bytes;
    if (execution.cancel && execution.cancel->load(std::memory_order_relaxed))
      return {StatusCode::cancelled, "cancelled by the caller"};
    if (execution.progress && pieces_.empty())
      execution.progress(static_cast<double>(at) / static_cast<double>(text_.size()));
    return {};
  }

  /// Takes instances from a place on. Returns the place of the next statement.
  std::size_t instances(std::size_t at) {
    if (!is_data_) return skip_statement(at);
    while (next_piece_ < pieces_.size() && pieces_[next_piece_].begin < at) ++next_piece_;
    const bool fits = next_piece_ < pieces_.size() && pieces_[next_piece_].begin == at;
    const std::size_t next = next_piece_ < pieces_.size() ? pieces_[next_piece_].begin : at + piece_bytes;
    const std::size_t limit = std::min(next, text_.size());
    const StepRun run = fits ? std::move(pieces_[next_piece_++]) : scan_instances(text_, at, limit);
    std::vector<std::uint32_t> kinds;  // by kind of the run; both are in the order in which kinds are met
    for (const std::string_view name : run.kinds.names()) kinds.push_back(kinds_.index_of(name));
    for (StepInstance instance : run.instances) {
      if (instance.kind != StepIndex::several_kinds) instance.kind = kinds[instance.kind];
      index_.instances_.push_back(instance);
    }
    return run.end == at ? odd_instance(at) : run.end;
  }

  /// Reads "#1=&SCOPE", or passes over what is no instance.
  std::size_t odd_instance(std::size_t at) {
    const std::size_t end = end_of_statement(text_, at);
    const std::size_t scope = text_.substr(at, end - at).find("&SCOPE");
    std::uint64_t number = 0;
    const auto [last, error] = std::from_chars(text_.data() + at + 1, text_.data() + end, number);
    if (scope != std::string_view::npos && error == std::errc()) {
      scopes_.push_back(number);
      return skip_blanks(text_, at + scope + std::string_view("&SCOPE").size());
    }
    const std::string name = error == std::errc() ? "#" + std::to_string(number) : "an instance without a number";
    index_.remark(at, end == text_.size() ? "the file ends within " + name : name + " is no instance: it is left out");
    return end == text_.size() ? end : skip_blanks(text_, end + 1);
  }

  std::size_t skip_statement(std::size_t at) {
    const std::size_t end = end_of_statement(text_, at);
    return end == text_.size() ? end : skip_blanks(text_, end + 1);
  }

  /// Reads a statement that is no instance: sections begin and end by them.
  std::size_t statement(std::size_t at) {
    const auto begins = [&](std::string_view word) { return text_.substr(at, word.size()) == word; };
    if (begins("ENDSCOPE")) return end_scope(at);
    if (begins("ENDSEC")) {
      is_data_ = false;
    } else if (!is_data_ && begins("DATA")) {
      is_data_ = has_data_ = true;
    } else if (begins("END-ISO-10303-21")) {
      return text_.size();
    } else if (is_data_) {
      index_.remark(at, "expected an instance, such as #1=..., found \"" + std::string(text_.substr(at, 20)) + "\"");
    }
    return skip_statement(at);
  }

  /// Reads "ENDSCOPE /#1,#2/ KIND(..);": the record of the instance that the scope belongs to.
  std::size_t end_scope(std::size_t at) {
    std::size_t record = skip_blanks(text_, at + std::string_view("ENDSCOPE").size());
    if (record < text_.size() && text_[record] == '/')
      record = skip_blanks(text_, std::min(text_.find('/', record + 1), text_.size() - 1) + 1);
    if (scopes_.empty()) return skip_statement(at);
    const std::uint64_t number = scopes_.back();
    scopes_.pop_back();
    const std::size_t end = end_of_statement(text_, record);
    const std::size_t open = std::min(text_.find('(', record), end);
    if (open < end) {
      const std::string_view kind = text_.substr(record, open - record);
      const std::uint32_t index = kind.empty() ? StepIndex::several_kinds : kinds_.index_of(kind);
      index_.instances_.push_back({number, record, static_cast<std::uint32_t>(end - record), index});
    }
    return end == text_.size() ? end : skip_blanks(text_, end + 1);
  }

  std::string_view text_;
  StepIndex& index_;
  std::vector<StepRun> pieces_;
  std::size_t next_piece_ = 0, next_report_ = piece_bytes;
  KindNames kinds_;
  bool is_data_ = false, has_data_ = false;
  std::vector<std::uint64_t> scopes_;  ///< numbers of the instances whose scopes are open
};

Result<StepIndex> StepIndex::make(std::string_view text, const Execution& execution) {
  return guarded([&]() -> Result<StepIndex> {
    StepIndex index;
    if (Status status = StepIndexMaker(text, index).make(execution); !status.ok()) return status;
    return index;
  });
}

const StepInstance* StepIndex::find(std::uint64_t number) const {
  // Most files number their instances without gaps.
  const std::uint64_t first = instances_.empty() ? 0 : instances_.front().number;
  const std::uint64_t guess = number - first;
  if (guess < instances_.size())
    if (const StepInstance& guessed = instances_[static_cast<std::size_t>(guess)]; guessed.number == number)
      return &guessed;
  const auto found = std::ranges::lower_bound(instances_, number, {}, &StepInstance::number);
  return found != instances_.end() && found->number == number ? &*found : nullptr;
}

std::string_view StepIndex::kind_of(std::uint64_t number) const {
  const StepInstance* const instance = find(number);
  return instance == nullptr || instance->kind == several_kinds ? std::string_view() : kinds_[instance->kind];
}

std::span<const std::uint32_t> StepIndex::of_kind(std::string_view kind) const {
  const auto found = std::ranges::find(kinds_, kind);
  if (found == kinds_.end()) return {};
  const auto k = static_cast<std::size_t>(found - kinds_.begin());
  return std::span(by_kind_).subspan(first_of_kind_[k], first_of_kind_[k + 1] - first_of_kind_[k]);
}

std::vector<std::uint32_t> StepIndex::with_part(std::string_view kind) const {
  std::vector<std::uint32_t> out;
  StepRecord values;
  for (std::uint32_t k = 0; k < instances_.size(); ++k) {
    if (instances_[k].kind != several_kinds) continue;
    const std::string_view text = record(instances_[k]);
    const std::string_view first = text.substr(std::min(skip_blanks(text, 1), text.size()));
    // Parts stand in the order of the alphabet. Most of the text in parts is that of splines.
    if (first.starts_with("B_SPLINE_") || first.starts_with("BOUNDED_")) continue;
    if (text.find(kind) == std::string_view::npos) continue;
    if (values.read(text).ok() && values.part(kind) != StepRecord::npos) out.push_back(k);
  }
  return out;
}

std::size_t StepIndex::line(std::uint64_t place) const {
  const auto end = static_cast<std::size_t>(std::min<std::uint64_t>(place, text_.size()));
  const std::size_t block = end / line_block, begin = block * line_block;
  return 1 + lines_before_[block] + line_ends(text_.substr(begin, end - begin));
}

void StepIndex::count_lines() {
  std::size_t lines = 0;
  for (std::size_t at = 0; at <= text_.size(); at += line_block) {
    lines_before_.push_back(lines);
    lines += line_ends(text_.substr(at, line_block));
  }
}

/// Sorts instances by counting, if their numbers differ and have few gaps. Returns whether they do.
bool StepIndex::sort_by_places() {
  constexpr std::uint32_t none = 0xffffffff;
  const auto [least, most] = std::ranges::minmax(instances_ | std::views::transform(&StepInstance::number));
  if (most - least >= 2 * instances_.size()) return false;
  std::vector<std::uint32_t> places(static_cast<std::size_t>(most - least) + 1, none);
  for (std::uint32_t k = 0; k < instances_.size(); ++k)
    if (std::exchange(places[static_cast<std::size_t>(instances_[k].number - least)], k) != none) return false;
  std::vector<StepInstance> sorted;
  sorted.reserve(instances_.size());
  for (const std::uint32_t k : places)
    if (k != none) sorted.push_back(instances_[k]);
  instances_ = std::move(sorted);
  return true;
}

/// Sorts by numbers, and leaves out all but the first of each.
void StepIndex::sort_instances() {
  if (!std::ranges::is_sorted(instances_, {}, &StepInstance::number) && !sort_by_places())
    std::ranges::stable_sort(instances_, {}, &StepInstance::number);
  std::size_t kept = 0;
  for (std::size_t k = 0; k < instances_.size(); ++k) {
    if (kept > 0 && instances_[kept - 1].number == instances_[k].number) {
      remark(instances_[k].begin, "#" + std::to_string(instances_[k].number) + " occurs again: the first one counts");
      continue;
    }
    instances_[kept++] = instances_[k];
  }
  instances_.resize(kept);
}

void StepIndex::list_kinds() {
  first_of_kind_.assign(kinds_.size() + 1, 0);
  for (const StepInstance& one : instances_)
    if (one.kind != several_kinds) ++first_of_kind_[one.kind + 1];
  for (std::size_t k = 0; k < kinds_.size(); ++k) first_of_kind_[k + 1] += first_of_kind_[k];
  by_kind_.resize(first_of_kind_.back());
  std::vector<std::uint32_t> next(first_of_kind_.begin(), first_of_kind_.end() - 1);
  for (std::uint32_t k = 0; k < instances_.size(); ++k)
    if (const std::uint32_t kind = instances_[k].kind; kind != several_kinds) by_kind_[next[kind]++] = k;
}

void StepIndex::remark(std::uint64_t place, std::string text) {
  if (remark_count_++ < max_remarks) remarks_.push_back({line(place), std::move(text)});
}

}}  // namespace tessera::abi_0_1
