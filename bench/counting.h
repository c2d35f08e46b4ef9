#pragma once
// Instructions instead of time, on machines where time says little: under valgrind's callgrind each case of the counted
// set does its work once to warm up, and once more to be counted. tools/perf count starts it and reads what it leaves.

#include <span>
#include <string>
#include <string_view>

namespace tessera::bench {

/// The counted set, "operation/surface/degree/size": every path once, on one thread, as small as it can be without that
/// what is not of the path counts. Names are stable: the baselines hold them.
std::span<const std::string_view> counted_cases();

/// Whether this process counts. Set once, before the cases run.
bool counting();
void start_counting();
/// Whether valgrind runs this process, and this program was built to talk to it.
bool under_valgrind();

/// The case whose count the following ends.
void name_count(const std::string& name);
/// Around what is counted, in the thread that does it; callgrind writes a file of its own for each pair.
void begin_count();
void end_count();

}  // namespace tessera::bench
