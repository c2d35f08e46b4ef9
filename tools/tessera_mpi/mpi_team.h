#pragma once
// The ranks of MPI as a team.

#include <memory>
#include <string>
#include <vector>

#include "batch/team.h"
#include "commands/commands.h"
#include "tessera/mpi.h"
#include "tessera/status.h"

namespace tessera::cli {

/// A rank of MPI_COMM_WORLD. Rank 0 leads.
class MpiTeam final : public Team {
 public:
  /// Errors: those of make_mpi_transport().
  static Result<std::unique_ptr<MpiTeam>> make();

  Transport& transport() { return *transport_; }
  /// Returns the leader's text in every rank. Errors: those of Transport::exchange().
  Result<std::string> text_of_leader(const std::string& text);
  bool leads() const override { return transport_->part() == 0; }
  Result<render::Image> draw(const RayScene& scene, const Box3& box, const render::Settings& settings,
                             const Execution& execution) override;
  Status closest(const RayScene& scene, std::optional<std::uint64_t> first_patch, std::span<const Ray> rays,
                 std::span<Hit> hits, const Execution& execution) override;
  PartRun run_of(std::size_t patches) const override;
  Result<Box3> common_box(const Box3& own) override;
  Result<std::vector<std::string>> gather(const Status& own, std::string text) override;
  Status end_job(const Status& own) override;

 private:
  explicit MpiTeam(std::unique_ptr<Transport> transport) : transport_(std::move(transport)) {}

  Status agree(const Status& own);
  Result<std::vector<Message>> send_to_leader(Message message);
  void gather_hits(std::span<Hit> hits) const;

  std::unique_ptr<Transport> transport_;
  bool job_has_failed_ = false;  ///< all know it
};

/// Adds `tessellate`, whose ranks are the parts of a model.
void add_tessellate_by_ranks(Command& tool, Session& session, MpiTeam& team);

/// Prints an error that the other ranks do not know, and ends them all.
[[noreturn]] void end_all_ranks(const Status& status);

/// Sends what this rank prints nowhere but the message of end_all_ranks(): one rank reports.
void be_silent();

}  // namespace tessera::cli
