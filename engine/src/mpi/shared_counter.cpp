#include "mpi/mpi_call.h"
#include "tessera/guard.h"
#include "tessera/mpi.h"

namespace tessera { inline namespace abi_0_1 {

/// Memory of rank 0 that all ranks reach.
class SharedCounter::Window {
 public:
  Window() = default;
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;
  ~Window() {
    if (window_ == MPI_WIN_NULL || !mpi_is_running()) return;
    if (is_locked_) MPI_Win_unlock_all(window_);
    MPI_Win_free(&window_);
  }

  Status open(MPI_Comm communicator) {
    if (Status status = communicator_.copy(communicator); !status.ok()) return status;
    int rank = 0;
    if (Status status = mpi_status("MPI_Comm_rank", MPI_Comm_rank(communicator_, &rank)); !status.ok()) return status;
    const MPI_Aint bytes = rank == 0 ? sizeof(std::uint64_t) : 0;
    std::uint64_t* number = nullptr;
    int code = MPI_Win_allocate(bytes, sizeof(std::uint64_t), MPI_INFO_NULL, communicator_, &number, &window_);
    if (Status status = mpi_status("MPI_Win_allocate", code); !status.ok()) return status;
    MPI_Win_set_errhandler(window_, MPI_ERRORS_RETURN);
    code = MPI_Win_lock_all(MPI_MODE_NOCHECK, window_);
    if (Status status = mpi_status("MPI_Win_lock_all", code); !status.ok()) return status;
    is_locked_ = true;
    if (rank == 0) *number = 0;
    if (Status status = mpi_status("MPI_Win_sync", MPI_Win_sync(window_)); !status.ok()) return status;
    return mpi_status("MPI_Barrier", MPI_Barrier(communicator_));
  }

  Result<std::uint64_t> next() {
    const std::uint64_t one = 1;
    std::uint64_t before = 0;
    int code = MPI_Fetch_and_op(&one, &before, MPI_UINT64_T, /*target_rank=*/0, /*target_disp=*/0, MPI_SUM, window_);
    if (Status status = mpi_status("MPI_Fetch_and_op", code); !status.ok()) return status;
    code = MPI_Win_flush(0, window_);
    if (Status status = mpi_status("MPI_Win_flush", code); !status.ok()) return status;
    return before;
  }

 private:
  OwnCommunicator communicator_;
  MPI_Win window_ = MPI_WIN_NULL;
  bool is_locked_ = false;
};

SharedCounter::SharedCounter(std::unique_ptr<Window> window) : window_(std::move(window)) {}
SharedCounter::SharedCounter(SharedCounter&&) noexcept = default;
SharedCounter::~SharedCounter() = default;

Result<SharedCounter> SharedCounter::make(MPI_Comm communicator) {
  return guarded([&]() -> Result<SharedCounter> {
    auto window = std::make_unique<Window>();
    if (Status status = window->open(communicator); !status.ok()) return status;
    return SharedCounter(std::move(window));
  });
}

Result<std::uint64_t> SharedCounter::next() {
  return guarded([&] { return window_->next(); });
}

}}  // namespace tessera::abi_0_1
