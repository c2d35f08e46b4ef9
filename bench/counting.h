#pragma once
// Counts instructions instead of time, for machines where times vary: under valgrind's callgrind each case of the
// counted set does its work once to warm up, and once more to be counted. tools/perf count starts it and reads its
// files.

#include <span>
#include <string>
#include <string_view>

namespace tessera::bench {

/// The counted set, "operation/surface/degree/size": every path once, on one thread, as small as possible without
/// making the overhead count. Names are stable: the baselines hold them.
std::span<const std::string_view> counted_cases();

/// Whether this process counts. Set once, before the cases run.
bool counting();
void start_counting();
/// Whether valgrind runs this process, and this program was built to talk to it.
bool under_valgrind();

/// Sets the case that the next counts belong to.
void name_count(const std::string& name);
/// Enclose the work to count, in the thread that does it; callgrind writes a file for each pair.
void begin_count();
void end_count();

}  // namespace tessera::bench
