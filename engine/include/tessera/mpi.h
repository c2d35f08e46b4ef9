#pragma once
// Messages between the ranks of MPI, each of which is a part of a model, and a counter that they share. Includes MPI's
// own header.
//
// MPI must be initialised before these calls and not be finalised before the objects are destroyed. Each call of a
// transport, each make() and each destructor is a meeting of all ranks of the communicator: a rank that cannot go on
// ends all by MPI_Abort(). Threads: one at a time, of a level that MPI was initialised for.

#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <memory>

#include "tessera/status.h"
#include "tessera/transport.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// The largest piece that a message is sent in: MPI counts bytes by int.
inline constexpr std::size_t max_mpi_piece = std::size_t{1} << 30;

/// Makes the end of this rank: part k is rank k of the communicator. Larger messages are sent in pieces of
/// `piece_bytes`, 8 to max_mpi_piece. Maxima are found by MPI_Allreduce().
///
/// Errors, of this call and of the transport's: io_error (MPI's own), invalid_argument (MPI is not initialised; no
/// communicator, or one between two groups; piece_bytes), out_of_memory. The errors are MPI's as far as it returns any:
/// most implementations end all ranks when one is lost.
Result<std::unique_ptr<Transport>> make_mpi_transport(MPI_Comm communicator, std::size_t piece_bytes = max_mpi_piece);

/// A number that all ranks count with, such as that of the next tile to draw. It lies in rank 0's memory; other ranks
/// do not wait for it there, unless MPI makes progress only within rank 0's calls.
class SharedCounter {
 public:
  /// Makes a counter at 0. Errors: as make_mpi_transport().
  static Result<SharedCounter> make(MPI_Comm communicator);

  SharedCounter(SharedCounter&&) noexcept;
  SharedCounter& operator=(SharedCounter&&) = delete;
  ~SharedCounter();

  /// Returns the number and adds 1 to it: each rank gets another one. No meeting. Errors: io_error (MPI's own).
  Result<std::uint64_t> next();

  class [[gnu::visibility("hidden")]] Window;

 private:
  explicit SharedCounter(std::unique_ptr<Window> window);
  std::unique_ptr<Window> window_;
};

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
