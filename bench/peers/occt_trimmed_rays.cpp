// Casts the same random rays at the trimmed faces of CAD files with OpenCASCADE's IntCurvesFace_ShapeIntersector and
// with Tessera's exact rays, each on one thread, and compares all hits of each ray. A hit that one of them lacks is
// explained (peers/ray_differences.h); those that are not are printed and make the exit status 1.
//
// Times: processor time per ray, without what is prepared once. OpenCASCADE finds all hits of a ray, so it is timed
// once; Tessera finds all hits, or the closest one, best of three.

#include <tbb/global_control.h>
#include <BRep_Builder.hxx>
#include <IntCurvesFace_ShapeIntersector.hxx>
#include <Standard_Failure.hxx>
#include <Standard_Version.hxx>
#include <TopoDS_Compound.hxx>
#include <gp_Lin.hxx>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string_view>

#include "io_occt/cad_shapes.h"
#include "peers/interleaved.h"
#include "peers/ray_differences.h"
#include "peers/results.h"
#include "support/ray_classes.h"
#include "support/solid_rays.h"
#include "support/synthetic_sets.h"
#include "tessera/ray_scene.h"

namespace tessera::bench {
namespace {

using test::value_of;

constexpr char usage[] =
    "tessera_peer_occt_trimmed_rays [--rays N] [FILE...]\n\n"
    "All hits of random rays at trimmed CAD files beside OpenCASCADE's, one thread: differences by cause, and times.\n"
    "Without files: all of the folder TESSERA_TEST_DATA. About 5 minutes.\n"
    "  --rays N     casts N rays at each file, fewer if OpenCASCADE takes more than 10 s [2000]\n"
    "Exit status 1 if a difference is not explained.\n";

constexpr double max_seconds = 10, tolerance = 1e-7;

struct Options {
  std::size_t rays = 2000;
  std::vector<std::filesystem::path> files;
};

/// Rays from outside of the box at points in it.
std::vector<Ray> rays_at(const Box3& box, std::size_t count) {
  test::Random random(1);
  std::vector<Ray> rays(count);
  const Vec3 d = box.upper - box.lower;
  for (Ray& ray : rays) {
    const auto part = [&] { return test::uniform(random, 0, 1); };
    const Vec3 at = box.lower + Vec3{part() * d.x, part() * d.y, part() * d.z};
    ray.origin = box.centre() + 1.5 * box.diagonal() * test::rays::unit_vector(random);
    ray.direction = normalized(at - ray.origin);
  }
  return rays;
}

/// OpenCASCADE's hits.
class TheirRays {
 public:
  explicit TheirRays(const TrimmedCase& one) : case_(one) {
    BRep_Builder builder;
    TopoDS_Compound all;
    builder.MakeCompound(all);
    for (std::size_t k = 0; k < one.faces.size(); ++k) {
      builder.Add(all, one.faces[k]->face());
      index_[one.faces[k]->face().TShape().get()] = k;
    }
    seconds_ = seconds_of([&] { intersector_.Load(all, tolerance); });
  }
  double load_seconds() const { return seconds_; }

  /// Returns the seconds of a ray.
  double cast(const Ray& ray) {
    const Vec3 &o = ray.origin, &d = ray.direction;
    const gp_Lin line(gp_Pnt(o.x, o.y, o.z), gp_Dir(d.x, d.y, d.z));
    return seconds_of([&] { intersector_.Perform(line, 0.0, RealLast()); });
  }

  std::vector<FaceHit> hits(const Ray& ray) const {
    std::vector<FaceHit> found;
    for (int k = 1; intersector_.IsDone() && k <= intersector_.NbPnt(); ++k) {
      FaceHit& hit = found.emplace_back();
      hit.face = index_.at(intersector_.Face(k).TShape().get());
      hit.t = intersector_.WParameter(k);
      hit.at = {intersector_.UParameter(k), intersector_.VParameter(k)};
      hit.slope = std::abs(dot(case_.faces[hit.face]->normal(hit.at), ray.direction));
    }
    std::ranges::sort(found, {}, &FaceHit::t);
    return found;
  }

 private:
  const TrimmedCase& case_;
  IntCurvesFace_ShapeIntersector intersector_;
  std::map<const void*, std::size_t> index_;
  double seconds_ = 0;
};

/// The figures of a file.
struct Row {
  std::size_t rays = 0, ours = 0, theirs = 0, same = 0;
  std::size_t our_odd = 0, their_odd = 0;  ///< rays that cross closed solids an odd number of times
  double apart = 0;
  std::array<std::size_t, ray_causes> causes{};
  double their_seconds = 0, all_seconds = 0, closest_seconds = 0;  ///< of all rays
};

void print(const TrimmedCase& one, const Ray& ray, const RayDifference& difference) {
  const auto& [hit, is_ours, cause] = difference;
  const TrueFace& face = *one.faces[hit.face];
  std::printf(
      "  %s lacks a hit: ray (%.17g %.17g %.17g) + t (%.17g %.17g %.17g), t %.12g, face %zu, (%.12g, %.12g), slope "
      "%.2e, "
      "%.2e from the border, %s\n",
      is_ours ? "OpenCASCADE" : "Tessera", ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x, ray.direction.y,
      ray.direction.z, hit.t, hit.face, hit.at[0], hit.at[1], hit.slope, face.distance_from_border(face.point(hit.at)),
      face.contains(hit.at) ? "inside" : "outside");
}

class Comparison {
 public:
  Comparison(const std::filesystem::path& file)
      : case_(read_case(file)),
        set_(value_of(make_patch_set(case_.model))),
        scene_(value_of(RayScene::make(set_))),
        faces_(value_of(RayScene::make(set_, {.seams = false}))) {}

  Row run(std::size_t count) {
    std::vector<Ray> rays = rays_at(scene_.box(), count);
    std::vector<std::vector<FaceHit>> theirs;
    TheirRays peer(case_);
    Row row;
    while (theirs.size() < count && row.their_seconds < max_seconds) {
      row.their_seconds += peer.cast(rays[theirs.size()]);
      theirs.push_back(peer.hits(rays[theirs.size()]));
    }
    rays.resize(theirs.size());
    row.rays = rays.size();
    HitLists lists;
    time_ours(rays, lists, row);
    compare(rays, lists, theirs, row);
    return row;
  }
  const TrimmedCase& model() const { return case_; }
  const PatchSet& set() const { return set_; }

 private:
  void time_ours(const std::vector<Ray>& rays, HitLists& lists, Row& row) const {
    std::vector<Hit> nearest(rays.size());
    bool good = true;
    const auto all = [&] { return seconds_of([&] { good = scene_.all(rays, lists).ok() && good; }); };
    const auto closest = [&] { return seconds_of([&] { good = scene_.closest(rays, nearest).ok() && good; }); };
    const std::vector<double> best = best_interleaved(3, {all, closest}, 0.02);
    if (!good) throw std::runtime_error("rays failed");
    row.all_seconds = best[0], row.closest_seconds = best[1];
  }

  /// The hits of a ray. Those of a ray that passes an edge are of the ray moved aside, so they are replaced by those of
  /// the ray where it is.
  std::vector<FaceHit> hits(const Ray& ray, std::span<const Hit> found) const {
    HitLists unmoved;
    if (std::ranges::any_of(found, [](const Hit& hit) { return hit.flags.seam; })) {
      if (!faces_.all(std::span(&ray, 1), unmoved).ok()) throw std::runtime_error("a ray failed");
      found = unmoved.hits;
    }
    std::vector<FaceHit> hits;
    for (const Hit& hit : found)
      hits.push_back({hit.surface, hit.t, case_.faces[hit.surface]->theirs({hit.u, hit.v}),
                      std::abs(dot(hit.normal, ray.direction))});
    return hits;
  }

  void compare(const std::vector<Ray>& rays, const HitLists& lists, const std::vector<std::vector<FaceHit>>& theirs,
               Row& row) const {
    const RayReferee referee(case_, tolerance);
    const bool closed = std::ranges::all_of(case_.model.shapes, test::is_closed);
    for (std::size_t k = 0; k < rays.size(); ++k) {
      const std::span<const Hit> found(lists.hits.data() + lists.first[k], lists.first[k + 1] - lists.first[k]);
      const std::vector<FaceHit> ours = hits(rays[k], found);
      const RayOutcome outcome = referee.compare(rays[k], ours, theirs[k]);
      row.ours += ours.size(), row.theirs += theirs[k].size(), row.same += outcome.same;
      row.apart = std::max(row.apart, outcome.apart);
      for (const RayDifference& difference : outcome.differences) {
        ++row.causes[static_cast<std::size_t>(difference.cause)];
        if (difference.cause == RayCause::unexplained) print(case_, rays[k], difference);
      }
      if (closed) row.our_odd += found.size() % 2, row.their_odd += theirs[k].size() % 2;
    }
  }

  TrimmedCase case_;
  PatchSet set_;
  RayScene scene_, faces_;
};

/// Returns whether all differences are explained.
bool report(const std::filesystem::path& file, std::size_t rays) {
  std::fprintf(stderr, "%s\n", file.filename().c_str());
  Comparison comparison(file);
  const Row row = comparison.run(rays);
  const double each = 1e6 / static_cast<double>(row.rays);
  std::printf("%-40.40s %5zu %5zu %6zu %6zu %7.1e | ", file.filename().c_str(), comparison.model().faces.size(),
              row.rays, row.ours, row.theirs, row.apart);
  for (const std::size_t count : row.causes) std::printf("%4zu ", count);
  std::printf("| %3zu %3zu | %8.1f %6.2f %6.2f | %7.1f %7.1f\n", row.our_odd, row.their_odd, row.their_seconds * each,
              row.all_seconds * each, row.closest_seconds * each, row.their_seconds / row.all_seconds,
              row.their_seconds / row.closest_seconds);
  for (const Status& fault : comparison.set().trim_faults()) std::printf("  fault: %s\n", fault.message().c_str());
  std::fflush(stdout);
  return row.causes[static_cast<std::size_t>(RayCause::unexplained)] == 0;
}

int run(Options options) {
  const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
  if (options.files.empty()) options.files = test::real_cad_files();
  if (options.files.empty()) throw std::runtime_error("name files, or set TESSERA_TEST_DATA");
  bool good = true;
  for (const std::filesystem::path& file : options.files) {
    try {
      good = report(file, options.rays) && good;
    } catch (const Standard_Failure& failure) {
      std::printf("%s: OpenCASCADE: %s %s\n", file.filename().c_str(), failure.DynamicType()->Name(),
                  failure.GetMessageString());
    } catch (const std::runtime_error& error) {
      std::printf("no rays: %s\n", error.what());
    }
  }
  return good ? 0 : 1;
}

}  // namespace
}  // namespace tessera::bench

int main(int argc, char** argv) {
  tessera::bench::Options options;
  for (int k = 1; k < argc; ++k) {
    const std::string_view argument = argv[k];
    if (argument == "--help" || argument == "-h") return std::fputs(tessera::bench::usage, stdout) < 0;
    if (argument == "--rays" && k + 1 < argc) {
      const std::string_view text = argv[++k];
      const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), options.rays);
      if (error != std::errc() || end != text.data() + text.size() || options.rays == 0) {
        std::fprintf(stderr, "--rays is a number above 0, not '%s'\n", argv[k]);
        return 2;
      }
    } else if (argument.starts_with('-')) {
      std::fprintf(stderr, "unknown option '%s'\n%s", argv[k], tessera::bench::usage);
      return 2;
    } else {
      options.files.emplace_back(argument);
    }
  }
  try {
    return tessera::bench::run(std::move(options));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "occt_trimmed_rays: %s\n", error.what());
  }
  return 1;
}
