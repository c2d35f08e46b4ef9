#include "tessera_mpi/mpi_team.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

#include "tessera/part_hits.h"

namespace tessera::cli {
namespace {

int error_output = STDERR_FILENO;

/// A band of a picture, as it is sent: its number and its bytes.
void append_band(Message& message, std::uint64_t band, std::span<const std::uint8_t> rgb) {
  const auto number = std::as_bytes(std::span(&band, 1)), bytes = std::as_bytes(rgb);
  message.insert(message.end(), number.begin(), number.end());
  message.insert(message.end(), bytes.begin(), bytes.end());
}

/// The bytes of a band of an image; the last one may be lower than the others.
std::span<std::uint8_t> band_of(render::Image& image, std::uint64_t band) {
  const std::size_t row = 3 * static_cast<std::size_t>(image.width), begin = band * render::band_height * row;
  return std::span(image.rgb).subspan(begin, std::min(render::band_height * row, image.rgb.size() - begin));
}

void take_bands(const Message& message, render::Image& image) {
  for (std::size_t at = 0; at < message.size();) {
    std::uint64_t band = 0;
    std::memcpy(&band, message.data() + at, sizeof(band));
    const std::span<std::uint8_t> bytes = band_of(image, band);
    std::memcpy(bytes.data(), message.data() + at + sizeof(band), bytes.size());
    at += sizeof(band) + bytes.size();
  }
}

/// Whether all ranks have this error: it names one of them.
bool is_of_all(const Status& status) { return status.message().starts_with("part "); }

}  // namespace

void end_all_ranks(const Status& status) {
  const std::string text = "tessera_mpi: " + status.message() + "\n";
  [[maybe_unused]] const ssize_t written = ::write(error_output, text.data(), text.size());
  remove_temporaries();
  MPI_Abort(MPI_COMM_WORLD, 1);
  ::_exit(1);
}

void be_silent() {
  const int nowhere = ::open("/dev/null", O_WRONLY);
  error_output = ::dup(STDERR_FILENO);
  ::dup2(nowhere, STDOUT_FILENO);
  ::dup2(nowhere, STDERR_FILENO);
  ::close(nowhere);
}

Result<std::unique_ptr<MpiTeam>> MpiTeam::make() {
  Result<std::unique_ptr<Transport>> transport = make_mpi_transport(MPI_COMM_WORLD);
  if (!transport) return transport.status();
  return std::unique_ptr<MpiTeam>(new MpiTeam(*std::move(transport)));
}

/// An error of one rank becomes that of all.
Status MpiTeam::agree(const Status& own) {
  const Status all = transport_->agree(own);
  if (!all.ok() && !is_of_all(all)) end_all_ranks(all);
  job_has_failed_ = !all.ok();
  return all;
}

Status MpiTeam::end_job(const Status& own) {
  const bool is_known = std::exchange(job_has_failed_, false);
  const Status all = is_known ? own : agree(own);
  job_has_failed_ = false;
  return own.ok() ? all : own;
}

Result<std::string> MpiTeam::text_of_leader(const std::string& text) {
  std::vector<Message> messages(transport_->part_count());
  const auto bytes = std::as_bytes(std::span(text));
  if (leads()) std::ranges::fill(messages, Message(bytes.begin(), bytes.end()));
  const Result<std::vector<Message>> all = transport_->exchange(std::move(messages));
  if (!all) return all.status();
  return std::string(reinterpret_cast<const char*>(all->front().data()), all->front().size());
}

PartRun MpiTeam::run_of(std::size_t patches) const {
  return run_of_part(patches, transport_->part(), transport_->part_count());
}

Result<Box3> MpiTeam::common_box(const Box3& own) {
  if (Status status = agree({}); !status.ok()) return status;
  double sides[] = {-own.lower.x, -own.lower.y, -own.lower.z, own.upper.x, own.upper.y, own.upper.z};
  if (Status status = transport_->reduce_max(sides); !status.ok()) end_all_ranks(status);
  return Box3{{-sides[0], -sides[1], -sides[2]}, {sides[3], sides[4], sides[5]}};
}

Result<std::vector<Message>> MpiTeam::send_to_leader(Message message) {
  std::vector<Message> messages(transport_->part_count());
  messages[0] = std::move(message);
  Result<std::vector<Message>> all = transport_->exchange(std::move(messages));
  if (!all) end_all_ranks(all.status());
  return all;
}

Result<std::vector<std::string>> MpiTeam::gather(const Status& own, std::string text) {
  if (Status status = agree(own); !status.ok()) return status;
  const auto bytes = std::as_bytes(std::span(text));
  const Result<std::vector<Message>> all = send_to_leader(Message(bytes.begin(), bytes.end()));
  std::vector<std::string> texts;
  for (const Message& sent : *all) texts.emplace_back(reinterpret_cast<const char*>(sent.data()), sent.size());
  return texts;
}

Result<render::Image> MpiTeam::draw(const RayScene& scene, const Box3& box, const render::Settings& settings,
                                    const Execution& execution) {
  if (Status status = agree({}); !status.ok()) return status;
  Result<SharedCounter> counter = SharedCounter::make(MPI_COMM_WORLD);
  if (!counter) end_all_ranks(counter.status());
  std::vector<std::uint64_t> bands;
  const auto next_band = [&]() -> Result<std::uint64_t> {
    const Result<std::uint64_t> band = counter->next();
    if (band) bands.push_back(*band);
    return band;
  };
  Result<render::Image> image = render::render_bands(scene, box, settings, next_band, execution);
  if (Status status = agree(image.status()); !status.ok()) return status;
  bands.pop_back();  // below the picture
  Message message;
  for (const std::uint64_t band : bands)
    if (!leads()) append_band(message, band, band_of(*image, band));
  const Result<std::vector<Message>> all = send_to_leader(std::move(message));
  if (leads())
    for (const Message& sent : *all) take_bands(sent, *image);
  return image;
}

/// Gives the leader the hits of all runs, each from its place to its place: copies of long lists take as long as rays.
void MpiTeam::gather_hits(std::span<Hit> hits) const {
  std::vector<int> counts, places;
  for (std::size_t rank = 0; rank < transport_->part_count(); ++rank) {
    const PartRun run = run_of_part(hits.size(), rank, transport_->part_count());
    counts.push_back(static_cast<int>(run.end - run.begin)), places.push_back(static_cast<int>(run.begin));
  }
  MPI_Datatype hit = MPI_DATATYPE_NULL;
  MPI_Type_contiguous(sizeof(Hit), MPI_BYTE, &hit);
  MPI_Type_commit(&hit);
  const int own = counts[transport_->part()];
  const void* const from = leads() ? MPI_IN_PLACE : hits.data() + run_of(hits.size()).begin;
  MPI_Gatherv(from, own, hit, hits.data(), counts.data(), places.data(), hit, 0, MPI_COMM_WORLD);
  MPI_Type_free(&hit);
}

/// Finds the hits of this rank's run of the rays, and gives them to the leader.
Status MpiTeam::closest(const RayScene& scene, std::optional<std::uint64_t> first_patch, std::span<const Ray> rays,
                        std::span<Hit> hits, const Execution& execution) {
  constexpr std::size_t max_rays = std::numeric_limits<int>::max();  // gather_hits() counts in int
  const PartRun run = run_of(rays.size());
  const std::span<Hit> own = hits.subspan(run.begin, run.end - run.begin);
  Status status;
  if (rays.size() > max_rays) {
    status = agree(Status(StatusCode::unsupported, "there are " + std::to_string(rays.size()) +
                                                       " rays; ranks share at most " + std::to_string(max_rays)));
  } else if (first_patch) {
    const Result<std::vector<Hit>> merged = closest_in_parts(*transport_, scene, *first_patch, rays, execution);
    status = merged.status();
    if (merged) std::ranges::copy(*merged, own.begin());
  } else {
    status = agree(scene.closest(rays.subspan(run.begin, own.size()), own, execution));
  }
  if (!status.ok() && !is_of_all(status)) end_all_ranks(status);
  job_has_failed_ = !status.ok();
  if (!status.ok()) return status;
  gather_hits(hits);
  return {};
}

}  // namespace tessera::cli
