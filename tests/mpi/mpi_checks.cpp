// The checks of every transport on the ranks of MPI, and those of the shared counter. mpirun starts it; the exit status
// is 0 if all pass.

#include <cstdio>
#include <string>

#include "parts/transport_checks.h"
#include "tessera/mpi.h"

namespace tessera::test { namespace {

Status check_wrong_arguments() {
  const auto is_refused = [](const auto& made) { return made.status().code() == StatusCode::invalid_argument; };
  if (!is_refused(make_mpi_transport(MPI_COMM_NULL)) || !is_refused(SharedCounter::make(MPI_COMM_NULL)))
    return wrong("MPI_COMM_NULL is taken");
  for (const std::size_t bytes : {std::size_t{7}, max_mpi_piece + 1})
    if (!is_refused(make_mpi_transport(MPI_COMM_WORLD, bytes))) return wrong("pieces of " + std::to_string(bytes));
  return {};
}

/// All ranks together take each number once.
Status check_counter() {
  constexpr std::uint64_t numbers = 1000;
  auto counter = SharedCounter::make(MPI_COMM_WORLD);
  if (!counter) return counter.status();
  std::uint64_t taken[] = {0, 0};  // how many, and their sum
  for (;;) {
    const Result<std::uint64_t> number = counter->next();
    if (!number) return number.status();
    if (*number >= numbers) break;
    ++taken[0], taken[1] += *number;
  }
  MPI_Allreduce(MPI_IN_PLACE, taken, 2, MPI_UINT64_T, MPI_SUM, MPI_COMM_WORLD);
  const bool is_right = taken[0] == numbers && taken[1] == numbers * (numbers - 1) / 2;
  return is_right ? Status() : wrong("numbers are taken twice or not at all");
}

/// Returns whether the check has passed in all ranks; a rank where it has not says so.
bool passes(const std::string& name, const Status& status) {
  int rank = 0, failed = status.ok() ? 0 : 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (failed != 0) std::fprintf(stderr, "rank %d: %s: %s\n", rank, name.c_str(), status.message().c_str());
  MPI_Allreduce(MPI_IN_PLACE, &failed, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
  return failed == 0;
}

bool check_all() {
  bool all = passes("wrong arguments", check_wrong_arguments());
  all = passes("counter", check_counter()) && all;
  for (const std::size_t piece_bytes : {max_mpi_piece, std::size_t{1000}}) {
    for (const TransportCheck& check : transport_checks) {
      const auto transport = make_mpi_transport(MPI_COMM_WORLD, piece_bytes);
      const std::string name = check.name + (" in pieces of " + std::to_string(piece_bytes));
      all = passes(name, transport ? check.run(**transport) : transport.status()) && all;
    }
  }
  return all;
}

}}  // namespace tessera::test

int main(int argc, char** argv) {
  const bool is_early = tessera::make_mpi_transport(MPI_COMM_WORLD).ok();
  MPI_Init(&argc, &argv);
  const bool all = tessera::test::check_all() && !is_early;
  MPI_Finalize();
  return all ? 0 : 1;
}
