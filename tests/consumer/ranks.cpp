// The ranks of MPI as parts of a model, with only the public header of tessera::mpi.

#include <tessera/mpi.h>

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  int result = 1;
  if (const auto transport = tessera::make_mpi_transport(MPI_COMM_WORLD)) result = (*transport)->agree({}).ok() ? 0 : 1;
  MPI_Finalize();
  return result;
}
