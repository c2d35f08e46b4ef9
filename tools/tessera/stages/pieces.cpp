#include "stages/pieces.h"
#include "io/mesh/mesh_pieces.h"

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <system_error>

#include "console/memory.h"
#include "console/output.h"
#include "console/progress.h"
#include "tessera/io.h"
#include "tessera/part_mesh.h"
#include "tessera/surface_file.h"
#include "tessera/transport.h"

namespace tessera::cli {
namespace {

namespace fs = std::filesystem;

/// Reads runs of a file, and keeps its warnings and the number of trimmed surfaces as long as `counting` is on.
class PieceReader {
 public:
  PieceReader(const SurfaceFile& file, bool untrimmed) : file_(file), untrimmed_(untrimmed) {}

  SurfaceSource source() {
    return {file_.size(), [this](std::uint64_t first, std::uint64_t end) { return read(first, end); }};
  }

  bool counting = false;
  std::vector<std::string> warnings;
  std::size_t trimmed = 0;

 private:
  Result<Model> read(std::uint64_t first, std::uint64_t end) {
    if (interrupted()) return Status(StatusCode::cancelled, "cancelled by the caller");
    Result<Model> model = file_.read(first, end);
    if (!model) return model;
    for (ModelSurface& surface : model->surfaces) {
      trimmed += counting && !surface.trims->empty();
      if (untrimmed_) surface.trims = {};
    }
    if (counting) warnings.insert(warnings.end(), model->warnings.begin(), model->warnings.end());
    return model;
  }

  const SurfaceFile& file_;
  bool untrimmed_;
};

/// Surfaces from places all over a file, to learn what a piece takes.
Result<Model> read_sample(const SurfaceSource& source) {
  constexpr std::uint64_t places = 16, length = 64;
  Model sample;
  std::uint64_t end = 0;
  for (std::uint64_t k = 0; k < places; ++k) {
    const std::uint64_t first = std::max(end, source.count * k / places);
    end = std::min(source.count, first + length);
    Result<Model> read = source.read(first, end);
    if (!read) return read;
    sample.surfaces.insert(sample.surfaces.end(), read->surfaces.begin(), read->surfaces.end());
  }
  return sample;
}

/// The bytes that a surface of a sample takes while a piece is meshed.
Result<double> bytes_per_surface(const Model& sample, TessellationOptions options, const FitOptions& fit) {
  const Result<SurfaceExtents> extents = surface_extents(sample, fit);
  if (!extents) return extents.status();
  if (options.relative && options.tolerance) options.tolerance = *options.tolerance * extents->box().diagonal();
  options.relative = false;
  const std::size_t count = sample.surfaces.size();
  const Result<ModelPart> part = part_of(sample, *extents, 0, count, 0);
  if (!part) return part.status();
  const Result<PartMesh> mesh = tessellate_part(*part, options, {}, fit);
  if (!mesh) return mesh.status();
  // Control points, blocks and plan of a patch; twice the mesh, which is cut out of that with the surfaces around.
  constexpr double patch_bytes = 3000;
  const bool doubles = options.precision == Precision::double_precision;
  const double vertex_bytes = doubles ? 56 : 32, triangle_bytes = 16, quad_bytes = 20;
  return (double(mesh->own.patches) * patch_bytes +
          2 * (double(mesh->own.vertices) * vertex_bytes + double(mesh->own.triangles) * triangle_bytes +
               double(mesh->own.quads) * quad_bytes)) /
         double(count);
}

/// How many pieces of at most options.piece_bytes there are.
Result<std::size_t> count_pieces(const SurfaceSource& source, const TessellateOptions& options) {
  const Result<Model> sample = read_sample(source);
  if (!sample) return sample.status();
  constexpr double unknown = 5000;  // if the sample cannot be meshed, the mesh of the whole says why
  const Result<double> learned = bytes_per_surface(*sample, plan_options(options.mesh), options.load.fit);
  const double bytes = learned ? *learned : unknown;
  const double pieces = std::ceil(bytes * double(source.count) / double(options.piece_bytes));
  if (pieces <= max_parts) return static_cast<std::size_t>(std::clamp(pieces, 1.0, double(source.count)));
  return Status(StatusCode::invalid_argument, "the model takes " + readable(pieces, 3) + " pieces of " +
                                                  readable_bytes(options.piece_bytes) + ", the limit is " +
                                                  std::to_string(max_parts));
}

/// Where pieces go: one .ply, or files with an index. Without end() nothing remains.
class PieceWriter {
 public:
  static Result<PieceWriter> make(const std::string& path) {
    Result<OutputFile> out = open_output(path);
    if (!out) return out.status();
    PieceWriter writer(path);
    if (is_index(path)) return writer;  // `out` has shown that the place can be written
    Result<PlyStream> stream = PlyStream::make(*std::move(out));
    if (!stream) return stream.status();
    writer.stream_.emplace(*std::move(stream));
    return writer;
  }
  PieceWriter(PieceWriter&&) noexcept = default;
  PieceWriter& operator=(PieceWriter&&) = delete;
  ~PieceWriter() {
    std::error_code ignored;
    for (const fs::path& file : files_) fs::remove(file, ignored);
  }

  Status write(const PartMesh& piece) {
    if (stream_) return stream_->append(piece.mesh, piece.own.patches);
    if (piece.mesh.positions.empty()) return {};
    if (files_.empty()) content_ = MeshTotals::of(piece.mesh);
    const std::size_t number = files_.size();
    files_.push_back(vtp_piece_path(path_, number));
    const std::uint64_t first_patch = patches_;
    patches_ += piece.own.patches;
    return write_vtp_piece(piece.mesh, content_, path_, number, first_patch);
  }

  Status end() {
    if (stream_) return stream_->commit();
    if (files_.empty()) return Status(StatusCode::invalid_argument, path_ + ": the mesh has no vertices");
    const Status status = write_pvtp(content_, path_, files_.size());
    if (status.ok()) files_.clear();
    return status;
  }

 private:
  explicit PieceWriter(std::string path) : path_(std::move(path)) {}

  std::string path_;
  std::optional<PlyStream> stream_;
  MeshTotals content_;
  std::vector<fs::path> files_;
  std::uint64_t patches_ = 0;
};

void add_piece(const PartMesh& piece, Meshed& made) {
  made.size.vertices += piece.own.vertices;
  made.size.triangles += piece.own.triangles;
  made.size.quads += piece.own.quads;
  made.patches += piece.own.patches;
  made.bound = std::max(made.bound, piece.bound);
  made.gap = std::max(made.gap, piece.gap);
  made.proven &= piece.certified;
}

/// The runs of all pieces, with the surfaces around each.
Result<std::vector<PartOutline>> find_pieces(const SurfaceSource& source, const TessellateOptions& options,
                                             std::size_t pieces) {
  std::vector<PartOutline> outlines(pieces);
  Progress progress("finding neighbours");
  const Status status = run_parts(pieces, [&](Transport& transport) -> Status {
    progress.tell(double(transport.part()) / double(pieces));
    const PartRun run = run_of_part(source.count, transport.part(), pieces);
    Result<PartOutline> outline = find_part(source, run, plan_options(options.mesh), transport, options.load.fit);
    if (outline) outlines[transport.part()] = *std::move(outline);
    return outline.status();
  });
  if (!status.ok()) return status;
  return outlines;
}

/// Meshes one piece after the other.
Status write_pieces(const SurfaceSource& source, std::span<const PartOutline> outlines,
                    const TessellateOptions& options, const FilePlan& plan, PieceWriter& writer, Meshed& made,
                    Timings& timings) {
  for (std::size_t k = 0; k < outlines.size(); ++k) {
    Result<PartMesh> piece = [&]() -> Result<PartMesh> {
      const Result<ModelPart> part = timings.measure("read", [&] { return load_part(source, outlines[k]); });
      if (!part) return part.status();
      const auto phase = timings.phase("evaluate");
      Progress progress("piece " + std::to_string(k + 1) + " of " + std::to_string(outlines.size()));
      return tessellate_part(*part, plan.options, progress.execution(), options.load.fit);
    }();
    if (!piece) return piece.status();
    if (plan.has_double_sums) add_double_sums(piece->mesh);
    add_piece(*piece, made);
    const std::uint64_t triangles = made.size.triangles + 2 * made.size.quads;
    if (!options.mesh.grid && triangles > options.mesh.certified.max_triangles)
      return {StatusCode::invalid_argument, "the pieces up to " + std::to_string(k + 1) + " take " +
                                                counted(triangles, "triangle") + ", the limit is " +
                                                std::to_string(options.mesh.certified.max_triangles)};
    const Status written = timings.measure("write", [&] { return writer.write(*piece); });
    if (!written.ok()) return written;
  }
  return timings.measure("write", [&] { return writer.end(); });
}

/// Makes all threads share one heap. Each piece finds its neighbours on a thread of its own; glibc would keep what
/// these have freed in up to eight heaps per processor: 95 MB instead of 23 MB for 27 pieces of 8 MB.
void share_heap() {
#ifdef __GLIBC__
  ::mallopt(M_ARENA_MAX, 1);
#endif
}

}  // namespace

void add_in_pieces(Command& command, TessellateOptions& options) {
  Option& pieces = command.add(
      "--in-pieces", "SIZE",
      "For models larger than memory: read a .bpt or .g2 file, and write .ply or .pvtp, in pieces that take about this "
      "much memory, like 2G; the program takes about 16M beside, and 0.2M per piece",
      [&options](const std::string& text) { options.piece_bytes = parse_bytes("--in-pieces", text); });
  for (const char* const other :
       {"--triangles", "--fewest", "--max-memory", "--crease", "--share-vertices", "--input-format", "--format"})
    pieces.exclude(command.option(other));
}

bool is_index(const std::string& path) { return lower_extension(path) == ".pvtp"; }

void check_pieces(const TessellateOptions& options, const Plan& plan) {
  for (const Job& job : plan.jobs) {
    if (options.piece_bytes == 0) {
      if (is_index(job.output)) throw UsageError("--output", ".pvtp is written with --in-pieces SIZE only");
      continue;
    }
    if (job.inputs.size() != 1) throw UsageError("--in-pieces", "each output is made of one file");
    for (const auto& [path, known] : {std::pair(job.inputs[0], std::vector<std::string>{".bpt", ".g2"}),
                                      std::pair(job.output, std::vector<std::string>{".ply", ".pvtp"})})
      if (std::ranges::find(known, lower_extension(path)) == known.end())
        throw UsageError("--in-pieces", path + ": expected " + known[0] + " or " + known[1]);
  }
}

Result<InPieces> mesh_in_pieces(const Job& job, const TessellateOptions& options, Timings& timings) {
  share_heap();
  Result<PieceWriter> writer = PieceWriter::make(job.output);
  if (!writer) return writer.status();
  const Result<SurfaceFile> file = timings.measure("open", [&] { return SurfaceFile::open(job.inputs[0]); });
  if (!file) return file.status();
  PieceReader reader(*file, options.pack.untrimmed);
  InPieces result;
  const Status status = [&]() -> Status {
    Result<std::vector<PartOutline>> outlines = [&]() -> Result<std::vector<PartOutline>> {
      const auto phase = timings.phase("find");
      const Result<std::size_t> pieces = count_pieces(reader.source(), options);
      if (!pieces) return pieces.status();
      result.pieces = *pieces;
      reader.counting = true;
      return find_pieces(reader.source(), options, *pieces);
    }();
    reader.counting = false;
    if (!outlines) return outlines.status();
    result.made.fit_error = outlines->front().fit_error;
    const Box3& box = outlines->front().box;
    const FilePlan plan = plan_for_file(options.mesh, box, job.output);
    const Status written = write_pieces(reader.source(), *outlines, options, plan, *writer, result.made, timings);
    add_file(plan, options.mesh, box, result.made);
    return written;
  }();
  if (!status.ok())
    return status.message().find(job.inputs[0]) == std::string::npos ? in_file(job.inputs[0], status) : status;
  result.surfaces = file->size();
  result.trimmed = reader.trimmed;
  result.warnings = std::move(reader.warnings);
  return result;
}

Report report_of(const Job& job, const InPieces& result, MeshOptions options) {
  options.certified.angle.reset();  // pieces keep angles and pixels, too, but don't tell which
  options.pixels = 0;
  Loaded read;
  read.files = job.inputs;
  Report report = report_of(job, read);
  report.add("pieces", result.pieces, counted(result.pieces, "piece") + ", ");
  add_mesh_facts(report, options, result.made);
  report.add("surfaces", result.surfaces);
  report.add("patches", result.made.patches);
  report.add("trimmed_surfaces", result.trimmed);
  report.add("fit_error", fit_json(result.made.fit_error), fit_line(result.made.fit_error));
  report.add("warnings", result.warnings);
  return report;
}

}  // namespace tessera::cli
