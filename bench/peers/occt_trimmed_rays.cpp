// Casts the same random rays at the trimmed faces of CAD files with OpenCASCADE's IntCurvesFace_ShapeIntersector and
// with Tessera's exact rays, each on one thread, and compares all hits of each ray. A hit that one of them lacks is
// explained (peers/ray_differences.h); those that are not are printed and make the exit status 1.
//
// Times: processor time per ray, the best of three turns, without what is prepared once. OpenCASCADE finds all hits of
// a ray; Tessera is timed for all hits and for the closest one.

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

namespace tessera::bench { namespace {

using test::value_of;

constexpr char usage[] =
    "tessera_peer_occt_trimmed_rays [--rays N] [FILE...]\n\n"
    "All hits of random rays at trimmed CAD files beside OpenCASCADE's, one thread: differences by cause, and times.\n"
    "Without files: all of the folder TESSERA_TEST_DATA. About 5 minutes.\n"
    "  --rays N  casts N rays at each file [2000]\n"
    "Exit status 1 if a difference is not explained, if all() has no hit where closest() has one, or if rays cross\n"
    "closed solids an odd number of times.\n";

constexpr double tolerance = 1e-7;      // of OpenCASCADE's intersector: its Precision::Confusion()
constexpr std::size_t max_printed = 5;  // differences of a file

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
    intersector_.Load(all, tolerance);
  }

  /// Returns whether OpenCASCADE ends without an exception.
  bool cast(const Ray& ray) {
    const Vec3 &o = ray.origin, &d = ray.direction;
    try {
      intersector_.Perform(gp_Lin(gp_Pnt(o.x, o.y, o.z), gp_Dir(d.x, d.y, d.z)), 0.0, RealLast());
    } catch (const Standard_Failure&) {
      return false;
    }
    return true;
  }

  /// The hits of the ray that was cast last.
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
};

/// The figures of a file.
struct Row {
  std::size_t ours = 0, theirs = 0;              ///< hits
  std::array<std::size_t, ray_causes> causes{};  ///< hits that one of both lacks
  std::size_t failed = 0;                        ///< hits of rays at which OpenCASCADE throws an exception
  std::size_t lost = 0;                          ///< rays with a closest hit, for which all() has none
  std::size_t our_odd = 0, their_odd = 0;        ///< rays that cross closed solids an odd number of times
  double apart = 0;                              ///< the largest distance of two equal hits
  double their_seconds = 0, all_seconds = 0, closest_seconds = 0;  ///< of all rays
  bool is_good() const { return causes[static_cast<std::size_t>(RayCause::unexplained)] + lost + our_odd == 0; }
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
        faces_(value_of(RayScene::make(set_, {.edges = false}))) {}

  Row run(std::size_t count) {
    const std::vector<Ray> rays = rays_at(scene_.box(), count);
    TheirRays peer(case_);
    HitLists lists;
    std::vector<Hit> nearest(count);
    bool good = true;
    const auto theirs = [&] {
      return seconds_of([&] {
        for (const Ray& ray : rays) (void)peer.cast(ray);
      });
    };
    const auto all = [&] { return seconds_of([&] { good = scene_.all(rays, lists).ok() && good; }); };
    const auto closest = [&] { return seconds_of([&] { good = scene_.closest(rays, nearest).ok() && good; }); };
    const std::vector<double> best = best_interleaved(3, {theirs, all, closest}, 0.02);
    if (!good) throw std::runtime_error("rays failed");
    Row row;
    row.their_seconds = best[0], row.all_seconds = best[1], row.closest_seconds = best[2];
    compare(rays, lists, nearest, peer, row);
    return row;
  }
  const TrimmedCase& model() const { return case_; }

 private:
  /// The hits of a ray. If it passes an edge, all() moves it aside; its hits are then those of the ray where it is.
  std::vector<FaceHit> hits(const Ray& ray, std::span<const Hit> found, const Hit& nearest) const {
    HitLists unmoved;
    if (nearest.flags.edge || found.empty() || found[0].flags.edge) {
      if (!faces_.all(std::span(&ray, 1), unmoved).ok()) throw std::runtime_error("a ray failed");
      found = unmoved.hits;
    }
    std::vector<FaceHit> hits;
    for (const Hit& hit : found)
      hits.push_back({hit.surface, hit.t, case_.faces[hit.surface]->theirs({hit.u, hit.v}),
                      std::abs(dot(hit.normal, ray.direction))});
    return hits;
  }

  void compare(const std::vector<Ray>& rays, const HitLists& lists, const std::vector<Hit>& nearest, TheirRays& peer,
               Row& row) const {
    const RayReferee referee(case_, tolerance);
    const bool closed = std::ranges::all_of(case_.model.shapes, test::is_closed);
    for (std::size_t k = 0; k < rays.size(); ++k) {
      const std::span<const Hit> found(lists.hits.data() + lists.first[k], lists.first[k + 1] - lists.first[k]);
      const std::vector<FaceHit> ours = hits(rays[k], found, nearest[k]);
      row.ours += ours.size();
      row.lost += found.empty() && nearest[k].kind == HitKind::hit;
      if (closed) row.our_odd += found.size() % 2;
      if (!peer.cast(rays[k])) {
        row.failed += ours.size();
        continue;
      }
      const std::vector<FaceHit> theirs = peer.hits(rays[k]);
      if (closed) row.their_odd += theirs.size() % 2;
      row.theirs += theirs.size();
      const RayOutcome outcome = referee.compare(rays[k], ours, theirs);
      row.apart = std::max(row.apart, outcome.apart);
      for (const RayDifference& difference : outcome.differences)
        if (++row.causes[static_cast<std::size_t>(difference.cause)] <= max_printed &&
            difference.cause == RayCause::unexplained)
          print(case_, rays[k], difference);
    }
  }

  TrimmedCase case_;
  PatchSet set_;
  RayScene scene_, faces_;
};

void print_head() {
  std::printf(
      "Hits of both, the largest distance of two equal hits; hits that one lacks: an edge is nearer than its "
      "tolerance,\n"
      "the ray is tangent, OpenCASCADE has it twice, misses it, contradicts itself, throws; unexplained. Rays: with a\n"
      "closest hit but none in all(); with odd counts at closed solids, of both. Microseconds per ray: OpenCASCADE, "
      "all\n"
      "hits, closest hit; how many times OpenCASCADE's time.\n%-40s %5s %6s %6s %7s | %4s %4s %5s %6s %7s %6s %7s | "
      "%4s "
      "%3s %5s | %8s %6s %7s | %7s %7s\n",
      "file", "faces", "ours", "theirs", "apart", "edge", "tang", "twice", "missed", "refuted", "throws", "unexpl.",
      "lost", "odd", "their", "theirs", "all", "closest", "all", "closest");
}

void print(const std::string& name, std::size_t faces, std::size_t rays, const Row& row) {
  const double each = 1e6 / static_cast<double>(rays);
  const auto count = [&](RayCause cause) { return row.causes[static_cast<std::size_t>(cause)]; };
  std::printf(
      "%-40.40s %5zu %6zu %6zu %7.1e | %4zu %4zu %5zu %6zu %7zu %6zu %7zu | %4zu %3zu %5zu | %8.1f %6.2f %7.2f | %7.1f "
      "%7.1f\n",
      name.c_str(), faces, row.ours, row.theirs, row.apart, count(RayCause::edge), count(RayCause::tangent),
      count(RayCause::twice), count(RayCause::missed), count(RayCause::refuted), row.failed,
      count(RayCause::unexplained), row.lost, row.our_odd, row.their_odd, row.their_seconds * each,
      row.all_seconds * each, row.closest_seconds * each, row.their_seconds / row.all_seconds,
      row.their_seconds / row.closest_seconds);
  std::fflush(stdout);
}

/// The sums of all files, and their ratios.
class Summary {
 public:
  void add(const Row& row) {
    all_.push_back(row.their_seconds / row.all_seconds);
    closest_.push_back(row.their_seconds / row.closest_seconds);
    good_ = good_ && row.is_good();
  }
  bool is_good() const { return good_; }
  void print() {
    if (all_.empty()) return;
    std::ranges::sort(all_), std::ranges::sort(closest_);
    std::printf("%zu files; ratios, least and median: all hits %.1f, %.1f; closest hits %.1f, %.1f\n", all_.size(),
                all_[0], all_[all_.size() / 2], closest_[0], closest_[closest_.size() / 2]);
  }

 private:
  std::vector<double> all_, closest_;
  bool good_ = true;
};

Row report(const std::filesystem::path& file, std::size_t rays) {
  const std::string name = file.filename().string();
  std::fprintf(stderr, "%s\n", name.c_str());
  Comparison comparison(file);
  const Row row = comparison.run(rays);
  print(name, comparison.model().faces.size(), rays, row);
  const double rate = static_cast<double>(rays) / row.their_seconds;
  add_result({"hits of rays at trimmed faces: " + name, "OpenCASCADE " OCC_VERSION_COMPLETE,
              "IntCurvesFace_ShapeIntersector", rate, "all hits", row.their_seconds / row.all_seconds});
  return row;
}

int run(Options options) {
  const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
  if (options.files.empty()) options.files = test::real_cad_files();
  if (options.files.empty()) throw std::runtime_error("name files, or set TESSERA_TEST_DATA");
  print_head();
  Summary summary;
  for (const std::filesystem::path& file : options.files) {
    try {
      summary.add(report(file, options.rays));
    } catch (const Standard_Failure& failure) {
      std::printf("%s: OpenCASCADE: %s %s\n", file.filename().c_str(), failure.DynamicType()->Name(),
                  failure.GetMessageString());
    } catch (const std::runtime_error& error) {
      std::printf("no rays: %s\n", error.what());
    }
  }
  summary.print();
  return summary.is_good() ? 0 : 1;
}

}}  // namespace tessera::bench

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
