#include "tess/trimmed/trimmed_face.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tess/cells/f64_points.h"
#include "tess/trimmed/patch_points.h"
#include "tess/trimmed/trimmed_patch.h"
#include "tessera/guard.h"

namespace tessera::inline abi_0_1 {
namespace {

// Triangles of the band may be wider than a cell, so cells take less than half of the tolerance.
constexpr double cell_share = 0.45, sliver_share = 0.25;
constexpr double band_share = 2.2;  // a usual bound of the band's triangles over that of cells
constexpr int max_attempts = 16;

class VertexTail;

class FaceMesher {
 public:
  FaceMesher(const PatchGrid& grid, const RepairedLoops& loops, double tolerance, const Vec3& origin)
      : grid_(grid), loops_(loops), tolerance_(tolerance), origin_(origin) {}
  Result<TrimmedFaceMesh> mesh();

 private:
  struct Patch {
    ChordBound chord;
    SpeedBound speed;
    Rates rates;
    double rounding = 0;
    double shrink = 1;  ///< the share of cell_share that is left to the cells
    double sliver = 0;
    std::vector<std::uint32_t> pieces;
  };

  Status bound_patches();
  Status choose_rates(std::size_t patch);
  void assign_pieces();
  Status mesh_patch(std::size_t patch, TrimmedFaceMesh& out, double& bound, bool& keeps);
  bool cut(std::size_t patch);
  int side_rate(std::size_t a, std::size_t b, bool along_u) const;
  void write(std::size_t patch, TrimmedFaceMesh& out);
  void write_grid(PatchPoints& points, VertexTail& tail);
  void reserve(Mesh& mesh) const;

  const PatchGrid& grid_;
  const RepairedLoops& loops_;
  double tolerance_;
  Vec3 origin_;
  std::vector<Patch> patches_;
  PatchSides sides_u_, sides_v_;  ///< lines u = const; lines v = const
  PatchCutter cutter_;
  std::vector<double> lines_u_, lines_v_;  ///< of a patch's grid, in its own parameters
  std::vector<std::uint32_t> numbers_;     ///< by vertex of the patch, its number in the mesh
};

Status FaceMesher::bound_patches() {
  patches_.resize(grid_.patches().size());
  for (std::size_t k = 0; k < patches_.size(); ++k) {
    const BezierPatch& bezier = grid_.patches()[k];
    Patch& patch = patches_[k];
    patch.chord = ChordBound(bezier);
    patch.speed = SpeedBound::of(bezier);
    // Parameters of a vertex in its patch are off by three roundings.
    patch.rounding = f64_vertex_rounding(bezier, origin_) + 0x1p-51 * (patch.speed.u + patch.speed.v);
    if (!(patch.rounding < tolerance_ / 4))
      return Status(StatusCode::invalid_argument, "the tolerance must be above " + std::to_string(4 * patch.rounding),
                    static_cast<std::ptrdiff_t>(k));
    if (Status status = choose_rates(k); !status.ok()) return status;
  }
  return {};
}

Status FaceMesher::choose_rates(std::size_t k) {
  Patch& patch = patches_[k];
  const auto rates = patch.chord.cheapest(cell_share * patch.shrink * tolerance_, max_rate);
  if (!rates)
    return Status(StatusCode::invalid_argument, "the tolerance needs more than 4096 segments across a patch",
                  static_cast<std::ptrdiff_t>(k));
  patch.rates = *rates;
  // Slivers get the rest that flat patches leave.
  const double left = 0.95 * tolerance_ - patch.rounding - band_share * patch.chord.distance(*rates);
  patch.sliver = std::max(sliver_share * tolerance_, left);
  return {};
}

// Pieces along a line belong to no patch: they count as sides.
void FaceMesher::assign_pieces() {
  const auto interval = [](std::span<const double> lines, double lower, double upper) {
    const auto above = std::upper_bound(lines.begin(), lines.end(), lower);
    const auto k = static_cast<std::size_t>(above - lines.begin()) - 1;
    return lower == upper && lines[k] == lower ? lines.size() : k;
  };
  for (std::uint32_t k = 0; k < loops_.pieces.size(); ++k) {
    const TrimPiece& piece = loops_.pieces[k];
    const std::size_t a = interval(grid_.breaks_u(), piece.lower_u(), piece.upper_u());
    const std::size_t b = interval(grid_.breaks_v(), piece.lower_v(), piece.upper_v());
    if (a < grid_.count_u() && b < grid_.count_v()) patches_[a * grid_.count_v() + b].pieces.push_back(k);
  }
}

/// The rate of a side: what the patches on both sides of the line need.
int FaceMesher::side_rate(std::size_t a, std::size_t b, bool along_u) const {
  int rate = 1;
  for (std::size_t back = 0; back < 2; ++back) {
    const std::size_t i = along_u ? a : a - back, j = along_u ? b - back : b;
    if (i >= grid_.count_u() || j >= grid_.count_v()) continue;  // also beyond the first line
    const Rates& rates = patches_[i * grid_.count_v() + j].rates;
    rate = std::max(rate, along_u ? rates.u : rates.v);
  }
  return rate;
}

bool FaceMesher::cut(std::size_t k) {
  const Patch& patch = patches_[k];
  const std::size_t a = k / grid_.count_v(), b = k % grid_.count_v();
  const Domain domain = grid_.patch_domain(k);
  for (double share = 1; share > 0.01; share /= 4) {
    cutter_.begin({domain, &patch.chord, patch.speed, patch.rates, patch.sliver * share, share});
    for (const bool last : {false, true}) {
      const std::size_t along_v = a + last, along_u = b + last;
      cutter_.add_side(sides_u_.points(along_v, b, side_rate(along_v, b, false)), last ? domain.u1 : domain.u0, false,
                       !last);
      cutter_.add_side(sides_v_.points(along_u, a, side_rate(a, along_u, true)), last ? domain.v1 : domain.v0, true,
                       !last);
    }
    for (const std::uint32_t piece : patch.pieces) cutter_.add_piece(loops_.pieces[piece]);
    if (cutter_.cut()) return true;
    if (patch.pieces.empty()) return false;
  }
  return false;
}

/// Vertices at the end of a mesh, with room for as many as a patch can have.
class VertexTail {
 public:
  VertexTail(Mesh& mesh, std::size_t most) : mesh_(mesh), count_(mesh.vertex_count()) {
    mesh.positions.resize(3 * (count_ + most));
    mesh.parameters.resize(2 * (count_ + most));
  }
  ~VertexTail() {
    mesh_.positions.resize(3 * count_);
    mesh_.parameters.resize(2 * count_);
  }
  VertexTail(const VertexTail&) = delete;
  VertexTail& operator=(const VertexTail&) = delete;

  std::uint32_t put(const ParameterPoint& at, const Vec3& position) {
    float* p = &mesh_.positions[3 * count_];
    p[0] = static_cast<float>(position.x), p[1] = static_cast<float>(position.y), p[2] = static_cast<float>(position.z);
    float* q = &mesh_.parameters[2 * count_];
    q[0] = static_cast<float>(at.u), q[1] = static_cast<float>(at.v);
    return static_cast<std::uint32_t>(count_++);
  }

 private:
  Mesh& mesh_;
  std::size_t count_;
};

// Vertices of the grid come first, line by line; then the points of loops that triangles use.
void FaceMesher::write(std::size_t k, TrimmedFaceMesh& out) {
  const std::size_t old = out.mesh.triangle_count();
  CutCells& cells = cutter_.cells();
  const std::size_t count = cells.band().size() + 2 * cells.whole_count();
  out.mesh.patches.resize(old + count, static_cast<std::uint32_t>(k));
  out.mesh.indices.resize(3 * (old + count));
  PatchPoints points(grid_.patches()[k], origin_);
  VertexTail tail(out.mesh, cutter_.vertex_count());
  write_grid(points, tail);
  const auto number = [&](std::uint32_t vertex) {
    std::uint32_t& known = numbers_[vertex];
    if (known != no_place) [[likely]]
      return known;
    const ParameterPoint at = cutter_.local(vertex);
    return known = tail.put(at, points.at(at));
  };
  std::uint32_t* index = &out.mesh.indices[3 * old];
  cells.for_whole(
      [&](std::uint32_t, std::uint32_t, std::uint32_t p, std::uint32_t q, std::uint32_t r, std::uint32_t s) {
        for (const std::uint32_t vertex : {p, q, r, p, r, s}) *index++ = number(vertex);
      });
  for (const CutCells::Triangle& triangle : cells.band())
    for (const std::uint32_t vertex : triangle) *index++ = number(vertex);
}

void FaceMesher::write_grid(PatchPoints& points, VertexTail& tail) {
  numbers_.assign(cutter_.vertex_count(), no_place);
  const std::span<const std::uint32_t> vertices = cutter_.cells().grid_vertices();
  const std::size_t first = cutter_.vertex_count() - vertices.size();
  cutter_.local_lines(lines_u_, lines_v_);
  points.set_lines(lines_v_);
  std::uint32_t line = no_place;
  for (std::size_t n = 0; n < vertices.size(); ++n) {
    const GridPlace place = cutter_.grid().place_of_vertex(vertices[n]);
    if (place.i != line) points.begin_row(lines_u_[line = place.i]);
    numbers_[first + n] = tail.put({lines_u_[place.i], lines_v_[place.j]}, points.in_row(place.j));
  }
}

// Reserves for as many triangles as the cells of all patches have, and a tenth more.
void FaceMesher::reserve(Mesh& mesh) const {
  double cells = 0, vertices = 0;
  for (const Patch& patch : patches_) {
    cells += double(patch.rates.u) * patch.rates.v;
    vertices += static_cast<double>(patch.rates.vertices());
  }
  const auto triangles = static_cast<std::size_t>(2.2 * cells), points = static_cast<std::size_t>(1.1 * vertices);
  mesh.indices.reserve(3 * triangles);
  mesh.patches.reserve(triangles);
  mesh.positions.reserve(3 * points);
  mesh.parameters.reserve(2 * points);
}

// `keeps`: whether all patches so far keep the tolerance; else nothing more is written.
Status FaceMesher::mesh_patch(std::size_t k, TrimmedFaceMesh& out, double& bound, bool& keeps) {
  if (!cut(k))
    return Status(StatusCode::unsupported, "the loops of a face cross themselves or each other",
                  static_cast<std::ptrdiff_t>(k));
  const bool is_empty =
      cutter_.vertex_count() == 0 || (cutter_.cells().band().empty() && cutter_.cells().whole_count() == 0);
  ++(is_empty ? out.patches_left_out : patches_[k].pieces.empty() ? out.whole_patches : out.cut_patches);
  if (is_empty) return {};
  bound = cutter_.chord_bound() + cutter_.sliver_bound() + patches_[k].rounding;
  keeps = keeps && bound <= tolerance_;
  if (keeps) write(k, out);
  return {};
}

// Where a triangle of the band is too wide, its patch gets more cells, and all patches get new sides.
Result<TrimmedFaceMesh> FaceMesher::mesh() {
  if (!(tolerance_ > 0) || !std::isfinite(tolerance_))
    return Status(StatusCode::invalid_argument, "the tolerance must be finite and above 0");
  if (Status status = bound_patches(); !status.ok()) return status;
  assign_pieces();
  sides_u_.set(loops_.pieces, &ParameterPoint::u, grid_.breaks_u(), grid_.breaks_v(), loops_.starts_inside);
  sides_v_.set(loops_.pieces, &ParameterPoint::v, grid_.breaks_v(), grid_.breaks_u(), loops_.starts_inside);
  for (int attempt = 0; attempt < max_attempts; ++attempt) {
    TrimmedFaceMesh out;
    out.mesh.origin = origin_;
    reserve(out.mesh);
    bool keeps = true;
    for (std::size_t k = 0; k < patches_.size(); ++k) {
      double bound = 0;
      if (Status status = mesh_patch(k, out, bound, keeps); !status.ok()) return status;
      out.bound = std::max(out.bound, bound);
      if (bound <= tolerance_) continue;
      patches_[k].shrink *= 0.85 * tolerance_ / bound;
      if (Status status = choose_rates(k); !status.ok()) return status;
    }
    if (keeps) return out;
  }
  return Status(StatusCode::internal, "the triangles at the loops exceed the tolerance");
}

}  // namespace

Result<TrimmedFaceMesh> mesh_trimmed_face(const PatchGrid& grid, const RepairedLoops& loops, double tolerance,
                                          const Vec3& origin) {
  return guarded([&]() -> Result<TrimmedFaceMesh> { return FaceMesher(grid, loops, tolerance, origin).mesh(); });
}

}  // namespace tessera::inline abi_0_1
