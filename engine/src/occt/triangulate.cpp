#include <opencascade/BRepAdaptor_Curve.hxx>
#include <opencascade/BRepAdaptor_Surface.hxx>
#include <opencascade/BRep_Builder.hxx>
#include <opencascade/BRep_Tool.hxx>
#include <opencascade/BndLib_Add3dCurve.hxx>
#include <opencascade/BndLib_AddSurface.hxx>
#include <opencascade/Bnd_Box.hxx>
#include <opencascade/Poly_TriangulationParameters.hxx>
#include <opencascade/TopoDS.hxx>
#include <opencascade/TopoDS_Compound.hxx>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/text.h"
#include "occt/edge_polygons.h"
#include "occt/face_triangulation.h"
#include "occt/guarded_calls.h"
#include "occt/part_shape.h"
#include "occt/shape_numbers.h"
#include "occt/stored_meshes.h"
#include "occt/unmet_edges.h"
#include "parallel/call_progress.h"
#include "parallel/caller_arena.h"
#include "tessera/model.h"
#include "tessera/occt_mesh.h"
#include "tessera/tessellation.h"
#include "tessera/topology.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

using opencascade::handle;

/// The part of the deflection that curves may be fitted with, so that they have few pieces. Borders move by it along u
/// and along v.
constexpr double fit_share = 1.0 / 256, left_share = 1 - 2 * fit_share;

/// OpenCASCADE counts nodes and triangles in int.
constexpr std::uint64_t most_triangles = std::uint64_t{1} << 30;

constexpr double stage_ends[] = {0.4, 0.6, 0.8, 0.9};

/// The faces of a shape, each TShape where it comes first. `repeats`: whether some stand at several places.
TopoDS_Shape distinct_faces(const TopoDS_Shape& shape, bool& repeats) {
  TopoDS_Compound faces;
  const BRep_Builder builder;
  builder.MakeCompound(faces);
  ShapeNumbers seen(ShapeNumbers::Places::count_as_one);
  for_shapes(shape, TopAbs_FACE, [&](const TopoDS_Shape& face) {
    const std::size_t before = seen.size();
    seen.add(face);
    if (seen.size() > before)
      builder.Add(faces, face);
    else
      repeats = true;
  });
  return faces;
}

/// The largest side of the boxes of a face's edges; of the face's own box if it has none.
double size_of(const TopoDS_Face& face) {
  double size = 0;
  const auto extend = [&](const Bnd_Box& box) {
    if (box.IsVoid() || box.IsOpen()) return;
    const gp_XYZ sides = box.CornerMax().XYZ() - box.CornerMin().XYZ();
    size = std::max({size, sides.X(), sides.Y(), sides.Z()});
  };
  for_shapes(face, TopAbs_EDGE, [&](const TopoDS_Shape& found) {
    const TopoDS_Edge& edge = TopoDS::Edge(found);
    Bnd_Box box;
    if (!BRep_Tool::Degenerated(edge) && BRep_Tool::IsGeometric(edge))
      BndLib_Add3dCurve::Add(BRepAdaptor_Curve(edge), 0, box);
    extend(box);
  });
  if (size > 0) return size;
  Bnd_Box box;
  BndLib_AddSurface::Add(BRepAdaptor_Surface(face), 0, box);
  extend(box);
  return size;
}

class Triangulator {
 public:
  Triangulator(const TopoDS_Shape& shape, const OcctMeshOptions& options, const Execution& execution)
      : given_(shape), options_(options), progress_(execution, stage_ends) {
    described_.shape = distinct_faces(shape, repeats_);
    if (options.relative) return;
    described_.fit_tolerance = fit_share * options.deflection;
    described_.spline_shift = {fit_share * options.deflection, fit_share * options.angle.value_or(0.5)};
  }

  Result<OcctMeshReport> run() {
    if (described_.shape.NbChildren() == 0) return Status(StatusCode::invalid_argument, "the shape has no faces");
    if (Status status = convert(); !status.ok()) return status;
    Result<PatchSet> set = make_patch_set(shape_);
    if (!set) return set.status();
    const Result<TessellationOptions> wanted = plan_options(*set);
    if (!wanted) return wanted.status();
    const Result<Tessellation> plan = make_plan(*set, *wanted);
    if (!plan) return plan.status();
    Result<Mesh> mesh = plan->allocate();
    if (!mesh) return mesh.status();
    if (Status status = plan->run(*set, mesh->views(), progress_.loops()); !status.ok()) return status;
    if (Status status = put(*set, *plan, *mesh); !status.ok()) return status;
    state_faults(*set, *plan);
    if (Status status = find_open(*plan, *mesh); !status.ok()) return status;
    (void)progress_.finish({});
    return std::move(report_);
  }

 private:
  /// Makes a shape of ours of the faces.
  Status convert() {
    PlacedPart placed;
    placed.shape = described_.shape;
    Result<PartShape> part = PartShape::make(described_, placed, 0, {.cancel = progress_.loops().cancel});
    if (!part) return part.status();
    const auto convert = [&](std::size_t face) {
      part->convert(face);
      return Status();
    };
    if (Status status = each_on_threads(part->face_count(), 1, progress_.loops(), convert); !status.ok()) return status;
    std::move(*part).finish(shape_, sources_, lacks_);
    return shape_.faces.empty() ? Status(lacks_.first_code, lacks_.left_out[0]) : Status();
  }

  Result<TessellationOptions> plan_options(const PatchSet& set) {
    TessellationOptions to;
    to.angle = options_.angle;
    if (to.angle) {
      to.angle = std::min(*to.angle, std::numbers::pi / 2);
      to.angle_rate = static_cast<int>(std::clamp(std::ceil(std::numbers::pi / *to.angle), 1.0, 64.0));
    }
    to.max_triangles = std::min(options_.max_triangles, most_triangles);
    to.joining.edge_vertices = true;
    to.parameters = VertexParameters::patch;
    tolerances_.assign(sources_.faces.size(), options_.deflection);
    if (!options_.relative) {
      to.tolerance = left_share * options_.deflection;
      take_shifts(set, to);
      return to;
    }
    const auto find = [&](std::size_t k) {
      tolerances_[k] *= size_of(sources_.faces[k].face);
      return Status();
    };
    if (Status status = for_faces(find); !status.ok()) return status;
    const double largest = *std::ranges::max_element(tolerances_);
    for (double& tolerance : tolerances_)
      if (!(tolerance > 0)) tolerance = largest > 0 ? largest : options_.deflection;
    to.surface_tolerances.assign(tolerances_.begin(), tolerances_.begin() + std::ptrdiff_t(set.surface_count()));
    return to;
  }

  /// Leaves to surfaces that have moved the rest of the deflection, and to all the rest of the angle.
  void take_shifts(const PatchSet& set, TessellationOptions& to) {
    for (const SplineShift& shift : lacks_.shifts) {
      shift_.distance = std::max(shift_.distance, shift.distance);
      shift_.angle = std::max(shift_.angle, shift.angle);
    }
    if (!(shift_.distance > 0)) return;
    if (to.angle) *to.angle -= 2 * shift_.angle;
    for (std::size_t k = 0; k < set.surface_count(); ++k)
      to.surface_tolerances.push_back(*to.tolerance - lacks_.shifts[k].distance);
    to.tolerance.reset();
  }

  /// Makes a plan; where floats do not keep the deflection, one of positions in double.
  Result<Tessellation> make_plan(const PatchSet& set, TessellationOptions wanted) {
    Result<Tessellation> plan = Tessellation::make(set, wanted, progress_.loops());
    const bool is_refused = !plan && plan.status().code() == StatusCode::invalid_argument;
    if (!is_refused && (!plan || plan->patches_beyond_tolerance().empty())) return plan;
    // Rounding takes most of the deflection, if anything does.
    const double rounding = 0x1p-20 * set.model_box().diagonal();
    if (*std::ranges::min_element(tolerances_) > rounding) return plan;
    wanted.precision = Precision::double_precision;
    return Tessellation::make(set, wanted, {.cancel = progress_.loops().cancel});
  }

  Status for_faces(FunctionRef<Status(std::size_t)> body) {
    return each_on_threads(sources_.faces.size(), 2, progress_.loops(), body);
  }

  /// How far borders and a fitted surface may be from the face's own.
  double moved(std::size_t face) const {
    return 2 * described_.fit_tolerance + lacks_.fit_errors[face] + lacks_.shifts[face].distance;
  }

  Status put(const PatchSet& set, const Tessellation& plan, const Mesh& mesh) {
    const Result<std::vector<EdgeVertex>> on_edges = edge_vertices(plan);
    if (!on_edges) return on_edges.status();
    FaceTriangulations triangulations(set, plan, mesh, *on_edges, shape_, sources_);
    std::vector<handle<Poly_Triangulation>> made(sources_.faces.size());
    const handle<Poly_TriangulationParameters> parameters =
        new Poly_TriangulationParameters(options_.deflection, options_.angle.value_or(-1));
    const auto make = [&](std::size_t k) {
      made[k] = triangulations.make(k);
      if (made[k].IsNull()) return Status();
      const double bound = triangulations.bound(k) + moved(k);
      made[k]->Deflection(std::isfinite(bound) ? std::max(bound, tolerances_[k]) : tolerances_[k]);
      made[k]->Parameters(parameters);
      return Status();
    };
    if (Status status = for_faces(make); !status.ok()) return status;
    const Result<EdgePolygons> edges =
        edge_polygons(set, triangulations, made, shape_, sources_, *on_edges, {.cancel = progress_.loops().cancel});
    if (!edges) return edges.status();
    if (Status status = store(sources_, made, edges->polygons); !status.ok()) return status;
    for (const std::uint32_t face : edges->lacking)
      report_.faults.push_back(
          {sources_.faces[face].face, "an edge of it has no polygon, or a part of one: its border does not follow it"});
    for (std::size_t k = 0; k < made.size(); ++k) {
      if (made[k].IsNull()) {
        report_.faults.push_back({sources_.faces[k].face, "it has no triangles: it is too thin for the deflection"});
        continue;
      }
      ++report_.faces;
      report_.nodes += static_cast<std::size_t>(made[k]->NbNodes());
      report_.triangles += static_cast<std::size_t>(made[k]->NbTriangles());
    }
    return {};
  }

  /// Finds whether a side of a triangle is alone. Borders that the plan counts as open may still meet.
  Status find_open(const Tessellation& plan, const Mesh& mesh) {
    if (repeats_) return find_open_anywhere(plan);
    report_.closed = plan.open_edges() == 0 && plan.crossed_patches().empty() && report_.left_out.empty();
    if (report_.closed) return {};
    const Result<MeshReport> found = check(mesh);
    if (!found) return found.status();
    report_.closed = found->open_edges == 0 && report_.left_out.empty();
    if (!report_.closed) list_open_edges();
    return {};
  }

  /// Copies of a face meet others than the first one does, which the plan knows nothing of.
  Status find_open_anywhere(const Tessellation& plan) {
    UnmetEdges unmet = unmet_edges(given_);
    report_.open_edges = std::move(unmet.edges);
    for (const TopoDS_Face& face : unmet.faces)
      report_.faults.push_back({face, "it has nodes elsewhere along an edge than another face there"});
    report_.closed = report_.open_edges.empty() && plan.crossed_patches().empty() && report_.left_out.empty();
    return {};
  }

  double bound_with_shifts(const PatchSet& set, const Tessellation& plan) const {
    if (!(shift_.distance > 0)) return plan.bound();
    double most = 0;
    for (std::size_t k = 0; k < set.patch_count(); ++k)
      most = std::max(most, double(plan.bounds()[k]) + lacks_.shifts[set.source(k).surface].distance);
    return most;
  }

  void state_faults(const PatchSet& set, const Tessellation& plan) {
    report_.bound = bound_with_shifts(set, plan) + 2 * described_.fit_tolerance + lacks_.worst_fit;
    report_.gap = plan.gap();
    report_.angle = plan.angle() + 2 * shift_.angle;
    report_.certified = plan.certified() && lacks_.worst_fit == 0;
    report_.patches_without_angle = plan.patches_without_angle();
    for (std::size_t k = 0; k < lacks_.left_out.size(); ++k)
      report_.left_out.push_back({lacks_.faces_left_out[k], lacks_.left_out[k]});
    for (std::size_t k = 0; k < lacks_.whole.size(); ++k)
      report_.faults.push_back({lacks_.faces_whole[k], lacks_.whole[k]});
    const auto add = [&](std::size_t face, std::string reason) {
      report_.faults.push_back({sources_.faces[face].face, std::move(reason)});
    };
    for (const Status& fault : set.trim_faults())
      add(static_cast<std::size_t>(fault.index()), "it is whole, its loops cannot be used: " + fault.message());
    std::vector<double> beyond(sources_.faces.size(), 0);
    for (const std::uint32_t patch : plan.patches_beyond_tolerance()) {
      double& worst = beyond[set.source(patch).surface];
      worst = std::max(worst, double(plan.bounds()[patch]));
    }
    for (const std::uint32_t patch : plan.crossed_patches()) beyond[set.source(patch).surface] = HUGE_VAL;
    for (std::size_t k = 0; k < beyond.size(); ++k)
      if (lacks_.fit_errors[k] > 0 && !(beyond[k] > 0))
        add(k, "its surface is fitted by splines, to within " + text(lacks_.fit_errors[k]));
      else if (beyond[k] > 0)
        add(k, std::isinf(beyond[k]) ? "a part of it has no triangles: its border crosses itself"
                                     : "its triangles are proven to be within " + text(beyond[k]) + " only");
  }

  void list_open_edges() {
    std::vector<std::uint32_t> uses(shape_.edges.size(), 0);
    for (const ShapeFace& face : shape_.faces)
      for (const TrimLoop& loop : edge_loops(face))
        for (const Coedge& coedge : loop.coedges) ++uses[coedge.edge];
    for (std::size_t k = 0; k < uses.size(); ++k)
      if (uses[k] == 1 && !shape_.edges[k].degenerate) report_.open_edges.push_back(sources_.edges[k].edge);
  }

  const TopoDS_Shape& given_;
  const OcctMeshOptions& options_;
  CallProgress progress_;
  bool repeats_ = false;      ///< whether faces of the shape stand at several places
  DescribedShape described_;  ///< a compound of the faces
  Shape shape_;
  OcctShape sources_;
  Shortcomings lacks_;
  std::vector<double> tolerances_;  ///< by face
  SplineShift shift_;               ///< the largest of all surfaces
  OcctMeshReport report_;
};

Status check_request(const TopoDS_Shape& shape, const OcctMeshOptions& options) {
  const auto bad = [](std::string message) { return Status(StatusCode::invalid_argument, std::move(message)); };
  if (!(options.deflection > 0) || !std::isfinite(options.deflection))
    return bad("the deflection must be above 0, found " + text(options.deflection));
  if (options.angle && !(*options.angle > 0)) return bad("the angle must be above 0, found " + text(*options.angle));
  if (shape.IsNull()) return bad("the shape is null");
  return {};
}

}  // namespace

Result<OcctMeshReport> triangulate(const TopoDS_Shape& shape, const OcctMeshOptions& options,
                                   const Execution& execution) {
  return guarded_occt([&]() -> Result<OcctMeshReport> {
    if (Status status = check_request(shape, options); !status.ok()) return status;
    const auto run = [&] { return Triangulator(shape, options, execution).run(); };
    if (options.parallel) return run();
    Result<OcctMeshReport> made = Status(StatusCode::internal, "not run");
    in_own_arena(1, [&] { made = guarded_occt(run); });
    return made;
  });
}

}}  // namespace tessera::abi_0_1
