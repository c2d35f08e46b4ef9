// The regions of faces of STEP files, as Tessera reads them, beside OpenCASCADE's classifiers: random points of each
// face's rectangle. Faces are matched by the numbers of their instances in the file.
//
// A point that Tessera keeps or cuts away is looked up on OpenCASCADE's face, by the same parameters if these give the
// same point, or else by ShapeAnalysis_Surface. BRepTopAdaptor_FClass2d answers first; where it says otherwise,
// BRepClass_FaceClassifier decides. Points on Tessera's borders, and points that OpenCASCADE's face does not hold at
// all, do not count. A point that differs counts as beside a border if it is as near to an edge as edges and loops lie
// apart in either model.
//
// Each file has a process of its own, as OpenCASCADE crashes on some.

#include <tbb/global_control.h>
#include <BRepClass_FaceClassifier.hxx>
#include <BRepTopAdaptor_FClass2d.hxx>
#include <BRep_Tool.hxx>
#include <ShapeAnalysis_Surface.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "io/step/read_step.h"
#include "io/step/step_index.h"
#include "io/step/step_topology.h"
#include "io/step/step_tree.h"
#include "io_occt/cad_file.h"
#include "peers/child_result.h"
#include "support/real_files.h"
#include "tessera/convert.h"
#include "tessera/io.h"
#include "tessera/topology.h"
#include "tessera/trim_region.h"

namespace tessera::bench { namespace {

namespace fs = std::filesystem;

constexpr char usage[] =
    "tessera_peer_occt_step_regions [--points N] [FILE...]\n\n"
    "Compares the regions of the faces of STEP files with OpenCASCADE's, by N random points of each [2000].\n"
    "Without files: all of the folder TESSERA_TEST_DATA.\n"
    "Exit status 1 if a point away from all borders differs, save in known files.\n";

constexpr unsigned seconds_per_file = 300;

struct Counts {
  std::size_t faces = 0, unmatched = 0;  ///< compared; without a partner, or of files with other faces
  std::size_t points = 0, border = 0, elsewhere = 0, beside = 0, farther = 0, quick = 0, wrong = 0, wrong_faces = 0;

  void add(const Counts& o) {
    faces += o.faces, unmatched += o.unmatched, points += o.points, border += o.border, elsewhere += o.elsewhere;
    beside += o.beside, farther += o.farther, quick += o.quick, wrong += o.wrong, wrong_faces += o.wrong_faces;
  }
};

template <class T>
T value_or_throw(Result<T> result) {
  if (!result) throw std::runtime_error(result.status().message());
  return *std::move(result);
}

/// The instances of the faces of each shape of a model, in the model's order; empty where some were left out.
std::vector<std::vector<std::uint64_t>> numbers_of_faces(std::string_view text, const Model& model) {
  const StepIndex index = value_or_throw(StepIndex::make(text));
  const StepTree tree = value_or_throw(read_step_tree(index));
  std::set<std::tuple<std::size_t, std::size_t, bool>> seen;
  std::vector<std::vector<std::uint64_t>> all;
  for (const StepPlacedPart& place : tree.places) {
    if (!seen.emplace(place.part, place.colours, place.is_mirrored()).second) continue;
    const StepTopology topology =
        value_or_throw(StepTopology::make(index, tree.parts[place.part].items, place.is_mirrored(), {}));
    if (topology.faces.empty() || all.size() == model.shapes.size()) continue;
    std::vector<std::uint64_t>& numbers = all.emplace_back();
    for (const StepFace& face : topology.faces) numbers.push_back(face.number);
    if (numbers.size() != model.shapes[all.size() - 1].faces.size()) numbers.clear();
  }
  all.resize(model.shapes.size());
  return all;
}

/// A face of OpenCASCADE's, in its part's space.
class PeerFace {
 public:
  explicit PeerFace(const TopoDS_Face& face)
      : face_(TopoDS::Face(face.Located(TopLoc_Location()).Oriented(TopAbs_FORWARD))),
        surface_(BRep_Tool::Surface(face_)),
        analysis_(surface_),
        quick_(face_, 1e-9) {
    for (TopExp_Explorer at(face_, TopAbs_EDGE); at.More(); at.Next())
      tolerance_ = std::max(tolerance_, BRep_Tool::Tolerance(TopoDS::Edge(at.Current())));
  }

  /// The parameters of a point, tried as they are and swapped; false if the surface does not hold the point.
  bool find(const Vec3& point, double u, double v, double near, gp_Pnt2d& found) {
    const gp_Pnt p(point.x, point.y, point.z);
    for (const gp_Pnt2d& guess : {gp_Pnt2d(u, v), gp_Pnt2d(v, u)}) {
      found = guess;
      if (surface_->Value(guess.X(), guess.Y()).Distance(p) <= near) return true;
    }
    found = analysis_.ValueOfUV(p, 1e-9);
    return surface_->Value(found.X(), found.Y()).Distance(p) <= near;
  }
  TopAbs_State quick(const gp_Pnt2d& at) const { return quick_.Perform(at, true); }
  TopAbs_State exact(const gp_Pnt2d& at) const { return BRepClass_FaceClassifier(face_, at, 1e-9).State(); }
  double tolerance() const { return tolerance_; }

 private:
  TopoDS_Face face_;
  Handle(Geom_Surface) surface_;
  ShapeAnalysis_Surface analysis_;
  BRepTopAdaptor_FClass2d quick_;
  double tolerance_ = 0;  ///< the largest of its edges
};

/// The borders of a face as polygons: its loops on the surface, and its edges.
struct Borders {
  std::vector<std::vector<Vec3>> polygons;
  double deviation = 0;  ///< the largest distance of a loop from its edge, at equal parameters
};

Borders borders_of(const Shape& shape, const ShapeFace& face) {
  constexpr int steps = 400;
  Borders out;
  for (const TrimLoop& loop : edge_loops(face))
    for (std::size_t k = 0; k < loop.curves.size(); ++k) {
      const Curve& curve = loop.curves[k];
      const Coedge* const use = k < loop.coedges.size() ? &loop.coedges[k] : nullptr;
      const BrepEdge* const edge = use != nullptr ? &shape.edges[use->edge] : nullptr;
      const bool has_edge = edge != nullptr && edge->curve && !edge->degenerate;
      const Interval range = has_edge ? edge->range : curve.domain();
      std::vector<Vec3> on_surface, on_edge;
      for (int i = 0; i <= steps; ++i) {
        const double s = range.from + (range.to - range.from) * i / steps;
        const double t = !has_edge        ? s
                         : use->parameter ? position(*use->parameter, s).x
                         : use->reversed  ? curve.domain().from + curve.domain().to - s
                                          : s;
        const Vec3 at = position(curve, t);
        const Result<SurfaceJet> jet = evaluate_jet(face.surface, at.x, at.y);
        if (!jet) continue;
        on_surface.push_back(jet->position);
        if (!has_edge) continue;
        on_edge.push_back(position(*edge->curve, s));
        out.deviation = std::max(out.deviation, length(on_edge.back() - jet->position));
      }
      out.polygons.push_back(std::move(on_surface));
      out.polygons.push_back(std::move(on_edge));
    }
  return out;
}

double distance_from(const Borders& borders, const Vec3& point) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const std::vector<Vec3>& polygon : borders.polygons)
    for (std::size_t k = 1; k < polygon.size(); ++k) {
      const Vec3 &a = polygon[k - 1], along = polygon[k] - a;
      const double square = dot(along, along);
      const double t = square > 0 ? std::clamp(dot(point - a, along) / square, 0.0, 1.0) : 0;
      nearest = std::min(nearest, length(point - a - t * along));
    }
  return nearest;
}

/// The answers of OpenCASCADE's faces of one instance about a point.
struct Answer {
  bool holds = false, quick = false, exact = false;  ///< whether the point is on a surface, and within its region
};

Answer ask(std::deque<PeerFace>& peers, const Vec3& point, double u, double v, double near, bool expected) {
  Answer answer;
  std::vector<gp_Pnt2d> places;
  for (PeerFace& peer : peers) {
    const bool holds = peer.find(point, u, v, std::max(near, peer.tolerance()), places.emplace_back());
    answer.holds |= holds;
    answer.quick |= holds && peer.quick(places.back()) != TopAbs_OUT;
  }
  answer.exact = answer.quick;
  if (!answer.holds || answer.quick == expected) return answer;
  answer.exact = false;
  for (std::size_t k = 0; k < peers.size(); ++k) answer.exact |= peers[k].exact(places[k]) != TopAbs_OUT;
  return answer;
}

/// Compares random points of one face with the faces that OpenCASCADE made of the same instance.
class FaceComparison {
 public:
  FaceComparison(const Shape& shape, const ShapeFace& face, std::deque<PeerFace>& peers, std::string where)
      : shape_(shape), face_(face), peers_(peers), where_(std::move(where)) {
    for (const PeerFace& peer : peers) tolerance_ = std::max(tolerance_, peer.tolerance());
  }

  Counts run(int points) {
    const auto& surface = std::get<BSplineSurface>(face_.surface);
    const PatchGrid grid = value_or_throw(to_bezier(surface));
    const TrimRegion region = value_or_throw(TrimRegion::make(*face_.trims, grid));
    const Domain domain = region.domain();
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> unit(0, 1);
    const double near = 1e-6 * (1 + grid.box().diagonal());
    for (int k = 0; k < points; ++k) {
      const double u = domain.u_at(unit(random)), v = domain.v_at(unit(random));
      const TrimSide side = region.locate(u, v);
      if (side == TrimSide::border) {
        ++counts_.border;
        continue;
      }
      const bool is_inside = side == TrimSide::inside;
      const Vec3 point = evaluate_jet(surface, u, v).position;
      const Answer answer = ask(peers_, point, u, v, near, is_inside);
      ++(answer.holds ? counts_.points : counts_.elsewhere);
      if (!answer.holds || answer.quick == is_inside) continue;
      if (answer.exact == is_inside)
        ++counts_.quick;
      else
        take_difference(point, is_inside);
    }
    counts_.faces = 1, counts_.wrong_faces = counts_.wrong > 0;
    return counts_;
  }

 private:
  void take_difference(const Vec3& point, bool is_inside) {
    if (!borders_) borders_ = borders_of(shape_, face_);
    const double distance = distance_from(*borders_, point);
    if (distance <= 1e-9 + tolerance_ + borders_->deviation) {
      ++counts_.beside;
      counts_.farther += distance > 1e-6 + 2 * borders_->deviation;
      return;
    }
    if (++counts_.wrong > 2) return;
    std::printf("%s: the point %.9g %.9g %.9g is %s, OpenCASCADE's %s; %.3g from the border, tolerance %.3g\n",
                where_.c_str(), point.x, point.y, point.z, is_inside ? "inside" : "outside",
                is_inside ? "outside" : "inside", distance, tolerance_);
  }

  const Shape& shape_;
  const ShapeFace& face_;
  std::deque<PeerFace>& peers_;
  const std::string where_;
  double tolerance_ = 0;            ///< the largest of OpenCASCADE's edges
  std::optional<Borders> borders_;  ///< made where a point differs
  Counts counts_;
};

/// Files that are known to differ away from borders, and who is right.
struct KnownRegion {
  std::string_view file, reason;
};
constexpr KnownRegion known_regions[] = {
    {"oring_nested_holes.step", "OpenCASCADE errs: it gives the face a negative area"},
    {"ap214_repeated_vertex_periodic_lobe.stp", "the file's loop turns around the cylinder, and has no inside"},
    {"ap214_two_side_singular_corner.stp",
     "OpenCASCADE's curve leaves the edge by 0.06, to an area of 0.296; the parabolas enclose 1/3, as Tessera's face "
     "has"},
};
const KnownRegion* known_region(const fs::path& file) {
  const auto is_it = [&](const KnownRegion& one) { return file.native().ends_with(one.file); };
  const auto found = std::ranges::find_if(known_regions, is_it);
  return found == std::end(known_regions) ? nullptr : &*found;
}

Counts compare_file(const fs::path& file, int points) {
  const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
  const std::string text = value_or_throw(read_file(file));
  const Model model = value_or_throw(read_step(text, file.filename()));
  const std::vector<std::vector<std::uint64_t>> numbers = numbers_of_faces(text, model);
  const DescribedShape peer = value_or_throw(load_step(file));
  std::map<std::string, std::deque<PeerFace>> peers;
  std::set<const void*> seen;
  for (TopExp_Explorer at(peer.shape, TopAbs_FACE); at.More(); at.Next()) {
    const auto label = peer.labels.find(identity(at.Current()));
    if (label == peer.labels.end() || !seen.insert(identity(at.Current())).second) continue;
    peers[label->second].emplace_back(TopoDS::Face(at.Current()));
  }
  Counts all;
  for (std::size_t k = 0; k < model.shapes.size(); ++k)
    for (std::size_t face = 0; face < model.shapes[k].faces.size(); ++face) {
      const std::string label = numbers[k].empty() ? "" : "#" + std::to_string(numbers[k][face]);
      const auto found = peers.find(label);
      if (found == peers.end()) {
        ++all.unmatched;
        continue;
      }
      const std::string where = "  " + file.filename().string() + " face " + label;
      try {
        all.add(FaceComparison(model.shapes[k], model.shapes[k].faces[face], found->second, where).run(points));
      } catch (const Standard_Failure& failure) {
        ++all.unmatched;
        std::printf("%s: OpenCASCADE: %s\n", where.c_str(), failure.GetMessageString());
      }
    }
  std::fflush(stdout);
  return all;
}

std::vector<fs::path> all_step_files() {
  const char* const data = std::getenv("TESSERA_TEST_DATA");
  if (data == nullptr) throw std::runtime_error("name files, or set TESSERA_TEST_DATA");
  return test::step_files_below(data);
}

void print(const char* name, const Counts& c) {
  std::printf(
      "%s: %zu faces, %zu without a partner; %zu points, %zu more on borders, %zu not on the other's face; %zu differ "
      "beside a border (%zu of them farther from the file's edges than Tessera's loops), %zu by FClass2d alone, %zu "
      "elsewhere (%zu faces)\n",
      name, c.faces, c.unmatched, c.points, c.border, c.elsewhere, c.beside, c.farther, c.quick, c.wrong,
      c.wrong_faces);
  std::fflush(stdout);
}

bool run(const std::vector<fs::path>& files, int points) {
  Counts all;
  std::size_t compared = 0;
  bool good = true;
  for (const fs::path& file : files) {
    const ChildResult<Counts> found = in_child<Counts>(seconds_per_file, [&] { return compare_file(file, points); });
    if (!found.failure.empty()) {
      std::printf("%s: %s\n", file.filename().c_str(), found.failure.c_str());
      continue;
    }
    ++compared;
    all.add(found.value);
    if (found.value.wrong + found.value.beside + found.value.unmatched + found.value.elsewhere > 0)
      print(file.filename().c_str(), found.value);
    const KnownRegion* const known = known_region(file);
    if (known != nullptr) std::printf("  known: %.*s\n", static_cast<int>(known->reason.size()), known->reason.data());
    good = good && (known != nullptr || found.value.wrong == 0);
  }
  print((std::to_string(compared) + " files").c_str(), all);
  return good;
}

}}  // namespace tessera::bench

int main(int argc, char** argv) {
  std::vector<std::filesystem::path> files;
  int points = 2000;
  for (int k = 1; k < argc; ++k) {
    const std::string_view argument = argv[k];
    if (argument == "--help" || argument == "-h") return std::fputs(tessera::bench::usage, stdout) < 0;
    if (argument == "--points" && k + 1 < argc) {
      points = std::clamp(std::atoi(argv[++k]), 1, 1'000'000);
    } else if (argument.starts_with('-')) {
      std::fprintf(stderr, "unknown option '%s'\n%s", argv[k], tessera::bench::usage);
      return 2;
    } else {
      files.emplace_back(argument);
    }
  }
  try {
    return tessera::bench::run(files.empty() ? tessera::bench::all_step_files() : files, points) ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "occt_step_regions: %s\n", error.what());
  }
  return 1;
}
