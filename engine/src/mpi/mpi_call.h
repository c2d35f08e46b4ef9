#pragma once
// Calls of MPI whose errors are values.

#include <mpi.h>

#include <string>

#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

/// Returns "MPI_Call: MPI's own words" for an error code of MPI; success for MPI_SUCCESS.
inline Status mpi_status(const char* call, int code) {
  if (code == MPI_SUCCESS) return {};
  char text[MPI_MAX_ERROR_STRING] = "";
  int length = 0;
  MPI_Error_string(code, text, &length);
  return Status(StatusCode::io_error,
                std::string(call) + ": " + std::string(text, static_cast<std::size_t>(length < 0 ? 0 : length)));
}

/// Whether MPI can be called.
inline bool mpi_is_running() {
  int initialised = 0, finalised = 0;
  MPI_Initialized(&initialised);
  MPI_Finalized(&finalised);
  return initialised != 0 && finalised == 0;
}

/// A communicator of one's own with the ranks of another, whose errors are returned.
class OwnCommunicator {
 public:
  OwnCommunicator() = default;
  OwnCommunicator(const OwnCommunicator&) = delete;
  OwnCommunicator& operator=(const OwnCommunicator&) = delete;
  ~OwnCommunicator() {
    if (value_ != MPI_COMM_NULL && mpi_is_running()) MPI_Comm_free(&value_);
  }

  /// A meeting of all ranks. Errors: invalid_argument, io_error.
  Status copy(MPI_Comm other) {
    const auto bad = [](const char* why) { return Status(StatusCode::invalid_argument, why); };
    if (!mpi_is_running()) return bad("MPI is not initialised, or is finalised");
    if (other == MPI_COMM_NULL) return bad("the communicator is MPI_COMM_NULL");
    int is_between_groups = 0;
    if (Status status = mpi_status("MPI_Comm_test_inter", MPI_Comm_test_inter(other, &is_between_groups)); !status.ok())
      return status;
    if (is_between_groups != 0) return bad("the communicator is between two groups, expected one within a group");
    if (Status status = mpi_status("MPI_Comm_dup", MPI_Comm_dup(other, &value_)); !status.ok()) return status;
    return mpi_status("MPI_Comm_set_errhandler", MPI_Comm_set_errhandler(value_, MPI_ERRORS_RETURN));
  }

  operator MPI_Comm() const { return value_; }

 private:
  MPI_Comm value_ = MPI_COMM_NULL;
};

}}  // namespace tessera::abi_0_1
