#include <algorithm>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "mpi/mpi_call.h"
#include "parts/largest.h"
#include "tessera/guard.h"
#include "tessera/mpi.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

extern "C" void largest_doubles(void* in, void* in_out, int* count, MPI_Datatype*) {
  const double* const a = static_cast<const double*>(in);
  double* const b = static_cast<double*>(in_out);
  for (int k = 0; k < *count; ++k) b[k] = larger_of(a[k], b[k]);
}

/// The sends and receives of one exchange.
class Requests {
 public:
  Requests(MPI_Comm communicator, std::size_t piece_bytes) : communicator_(communicator), piece_bytes_(piece_bytes) {}
  Requests(const Requests&) = delete;
  Requests& operator=(const Requests&) = delete;

  Status receive(Message& message, int from) {
    return in_pieces(message, [&](std::byte* begin, int size, MPI_Request* request) {
      return mpi_status("MPI_Irecv", MPI_Irecv(begin, size, MPI_BYTE, from, 0, communicator_, request));
    });
  }
  Status send(Message& message, int to) {
    return in_pieces(message, [&](std::byte* begin, int size, MPI_Request* request) {
      return mpi_status("MPI_Isend", MPI_Isend(begin, size, MPI_BYTE, to, 0, communicator_, request));
    });
  }
  Status wait() {
    // By hundreds: the count is an int.
    for (std::size_t k = 0; k < all_.size(); k += 100) {
      const int count = static_cast<int>(std::min<std::size_t>(100, all_.size() - k));
      const int code = MPI_Waitall(count, all_.data() + k, MPI_STATUSES_IGNORE);
      if (Status status = mpi_status("MPI_Waitall", code); !status.ok()) return status;
    }
    return {};
  }

 private:
  template <class Start>
  Status in_pieces(Message& message, const Start& start) {
    for (std::size_t at = 0; at < message.size(); at += piece_bytes_) {
      const std::size_t size = std::min(piece_bytes_, message.size() - at);
      all_.push_back(MPI_REQUEST_NULL);
      if (Status status = start(message.data() + at, static_cast<int>(size), &all_.back()); !status.ok()) return status;
    }
    return {};
  }

  MPI_Comm communicator_;
  std::size_t piece_bytes_;
  std::vector<MPI_Request> all_;
};

class MpiTransport final : public Transport {
 public:
  MpiTransport(std::unique_ptr<OwnCommunicator> communicator, std::size_t rank, std::size_t size,
               std::size_t piece_bytes)
      : Transport(rank, size), communicator_(std::move(communicator)), piece_bytes_(piece_bytes) {}
  ~MpiTransport() override {
    if (largest_ != MPI_OP_NULL && mpi_is_running()) MPI_Op_free(&largest_);
  }

  Status make_operation() {
    return mpi_status("MPI_Op_create", MPI_Op_create(largest_doubles, /*commute=*/1, &largest_));
  }

 private:
  MPI_Comm comm() const { return *communicator_; }

  Result<std::vector<Message>> exchange_messages(std::vector<Message> messages) override {
    std::vector<std::uint64_t> sent(part_count()), taken(part_count());
    for (std::size_t k = 0; k < part_count(); ++k) sent[k] = messages[k].size();
    const int code = MPI_Alltoall(sent.data(), 1, MPI_UINT64_T, taken.data(), 1, MPI_UINT64_T, comm());
    if (Status status = mpi_status("MPI_Alltoall", code); !status.ok()) return status;
    std::vector<Message> all(part_count());
    all[part()] = std::move(messages[part()]);
    Requests requests(comm(), piece_bytes_);
    Status status;
    // From the next rank on, so that not all send to rank 0 first.
    for (std::size_t step = 1; step < part_count() && status.ok(); ++step) {
      const std::size_t from = (part() + part_count() - step) % part_count();
      all[from].resize(taken[from]);
      status = requests.receive(all[from], static_cast<int>(from));
    }
    for (std::size_t step = 1; step < part_count() && status.ok(); ++step) {
      const std::size_t to = (part() + step) % part_count();
      status = requests.send(messages[to], static_cast<int>(to));
    }
    if (status.ok()) status = requests.wait();
    if (!status.ok()) return status;
    return all;
  }

  Result<SharedMessages> share_message(Message message) override {
    const std::uint64_t own = message.size();
    std::vector<std::uint64_t> sizes(part_count());
    const int code = MPI_Allgather(&own, 1, MPI_UINT64_T, sizes.data(), 1, MPI_UINT64_T, comm());
    if (Status status = mpi_status("MPI_Allgather", code); !status.ok()) return status;
    const auto all = std::make_shared<std::vector<Message>>(part_count());
    for (std::size_t k = 0; k < part_count(); ++k) (*all)[k].resize(sizes[k]);
    (*all)[part()] = std::move(message);
    const std::uint64_t total = std::accumulate(sizes.begin(), sizes.end(), std::uint64_t{0});
    Status status = total <= piece_bytes_ ? gather(sizes, *all) : broadcast(*all);
    if (!status.ok()) return status;
    return SharedMessages(all);
  }

  /// Gives small messages to all in one call.
  Status gather(std::span<const std::uint64_t> sizes, std::vector<Message>& all) {
    std::vector<int> counts(sizes.begin(), sizes.end()), places(sizes.size());
    std::exclusive_scan(counts.begin(), counts.end(), places.begin(), 0);
    Message joined(static_cast<std::size_t>(places.back()) + sizes.back());
    const Message& own = all[part()];
    const int code = MPI_Allgatherv(own.data(), counts[part()], MPI_BYTE, joined.data(), counts.data(), places.data(),
                                    MPI_BYTE, comm());
    if (Status status = mpi_status("MPI_Allgatherv", code); !status.ok()) return status;
    for (std::size_t k = 0; k < all.size(); ++k) std::copy_n(joined.begin() + places[k], counts[k], all[k].begin());
    return {};
  }

  /// Gives each message to all, piece by piece.
  Status broadcast(std::vector<Message>& all) {
    for (std::size_t from = 0; from < all.size(); ++from) {
      for (std::size_t at = 0; at < all[from].size(); at += piece_bytes_) {
        const std::size_t size = std::min(piece_bytes_, all[from].size() - at);
        const int code =
            MPI_Bcast(all[from].data() + at, static_cast<int>(size), MPI_BYTE, static_cast<int>(from), comm());
        if (Status status = mpi_status("MPI_Bcast", code); !status.ok()) return status;
      }
    }
    return {};
  }

  Status reduce_values(std::span<double> values) override {
    std::uint64_t range[] = {values.size(), ~std::uint64_t{values.size()}};
    int code = MPI_Allreduce(MPI_IN_PLACE, range, 2, MPI_UINT64_T, MPI_MAX, comm());
    if (Status status = mpi_status("MPI_Allreduce", code); !status.ok()) return status;
    if (range[0] != ~range[1])
      return Status(StatusCode::count_mismatch, "parts give from " + std::to_string(~range[1]) + " to " +
                                                    std::to_string(range[0]) + " numbers, expected as many of each");
    if (part_count() == 1)
      for (double& value : values) value = larger_of(value, value);
    const std::size_t piece = piece_bytes_ / sizeof(double);
    for (std::size_t at = 0; at < values.size(); at += piece) {
      const auto count = static_cast<int>(std::min(piece, values.size() - at));
      code = MPI_Allreduce(MPI_IN_PLACE, values.data() + at, count, MPI_DOUBLE, largest_, comm());
      if (Status status = mpi_status("MPI_Allreduce", code); !status.ok()) return status;
    }
    return {};
  }

  std::unique_ptr<OwnCommunicator> communicator_;
  std::size_t piece_bytes_;
  MPI_Op largest_ = MPI_OP_NULL;
};

}  // namespace

Result<std::unique_ptr<Transport>> make_mpi_transport(MPI_Comm communicator, std::size_t piece_bytes) {
  return guarded([&]() -> Result<std::unique_ptr<Transport>> {
    if (piece_bytes < sizeof(double) || piece_bytes > max_mpi_piece)
      return Status(StatusCode::invalid_argument, "piece_bytes is " + std::to_string(piece_bytes) + ", expected 8 to " +
                                                      std::to_string(max_mpi_piece));
    auto own = std::make_unique<OwnCommunicator>();
    if (Status status = own->copy(communicator); !status.ok()) return status;
    int rank = 0, size = 0;
    if (Status status = mpi_status("MPI_Comm_rank", MPI_Comm_rank(*own, &rank)); !status.ok()) return status;
    if (Status status = mpi_status("MPI_Comm_size", MPI_Comm_size(*own, &size)); !status.ok()) return status;
    auto transport = std::make_unique<MpiTransport>(std::move(own), static_cast<std::size_t>(rank),
                                                    static_cast<std::size_t>(size), piece_bytes);
    if (Status status = transport->make_operation(); !status.ok()) return status;
    return std::unique_ptr<Transport>(std::move(transport));
  });
}

}}  // namespace tessera::abi_0_1
