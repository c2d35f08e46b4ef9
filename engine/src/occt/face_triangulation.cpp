#include "occt/face_triangulation.h"

#include <opencascade/gp_Trsf.hxx>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "exact/arcs.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

using opencascade::handle;

/// Turns our parameters along one direction of a face into OpenCASCADE's. Vertices of a grid often have equal ones.
class TheirParameter {
 public:
  explicit TheirParameter(const OcctParameter& of) {
    if (of.arcs) arcs_.emplace(of.arcs->from, of.arcs->to);
  }
  double operator()(double ours) {
    if (!arcs_) return ours;
    if (ours != last_) last_ = ours, angle_ = arcs_->angle(ours);
    return angle_;
  }

 private:
  std::optional<Arcs> arcs_;
  double last_ = std::numeric_limits<double>::quiet_NaN(), angle_ = 0;
};

}  // namespace

FaceTriangulations::FaceTriangulations(const PatchSet& set, const Tessellation& plan, const Mesh& mesh,
                                       std::span<const EdgeVertex> on_edges, const Shape& shape,
                                       const OcctShape& sources)
    : set_(set), plan_(plan), mesh_(mesh), shape_(shape), sources_(sources) {
  first_patch_.assign(shape.faces.size() + 1, 0);
  const auto count = static_cast<std::uint32_t>(set.patch_count());
  for (std::uint32_t patch = 0; patch < count; ++patch) ++first_patch_[set.source(patch).surface + 1];
  for (std::size_t k = 1; k < first_patch_.size(); ++k) first_patch_[k] += first_patch_[k - 1];
  patches_.resize(count);
  std::vector<std::uint32_t> next(first_patch_.begin(), first_patch_.end() - 1);
  for (std::uint32_t patch = 0; patch < count; ++patch) patches_[next[set.source(patch).surface]++] = patch;
  same_.resize(mesh.vertex_count());
  nodes_.assign(mesh.vertex_count(), 0);
  linked_.resize(mesh.vertex_count());
  std::iota(linked_.begin(), linked_.end(), std::uint32_t{0});
  for (std::size_t k = 0; k < on_edges.size(); ++k) {
    const EdgeVertex& one = on_edges[k];
    nodes_[one.vertex] = 1;
    if (k > 0 && on_edges[k - 1].use == one.use && on_edges[k - 1].s == one.s)
      linked_[one.vertex] = std::min(one.vertex, linked_[on_edges[k - 1].vertex]);
    if (shape.edges[one.edge].degenerate) poles_.push_back({set.source(one.patch).surface, one.vertex});
  }
  std::ranges::sort(poles_);
}

double FaceTriangulations::bound(std::size_t face) const {
  double bound = 0;
  for (const std::uint32_t patch : patches(face)) bound = std::max(bound, double(plan_.bounds()[patch]));
  return bound;
}

/// Makes one face.
class FaceTriangulations::Maker {
 public:
  Maker(FaceTriangulations& all, std::size_t face)
      : all_(all),
        mesh_(all.mesh_),
        face_(face),
        source_(all.sources_.faces[face]),
        along_u_(source_.along_u),
        along_v_(source_.along_v),
        domain_(std::get<BSplineSurface>(all.shape_.faces[face].surface).domain()) {}

  handle<Poly_Triangulation> run() {
    merge();
    mark();
    if (triangles_.empty()) return {};
    number();
    made_ = new Poly_Triangulation(nodes_, static_cast<int>(triangles_.size()), true, true);
    put_triangles();
    put_nodes();
    return made_;
  }

 private:
  using Corners = std::array<std::uint32_t, 3>;

  std::span<const std::uint32_t> patches() const { return all_.patches(face_); }
  template <class Visit>
  void for_vertices(Visit visit) const {
    for (const std::uint32_t patch : patches()) {
      const auto end = static_cast<std::uint32_t>(all_.plan_.before(patch + 1).vertices);
      for (auto k = static_cast<std::uint32_t>(all_.plan_.before(patch).vertices); k < end; ++k) visit(patch, k);
    }
  }

  /// A vertex that may be one with others.
  struct Candidate {
    std::uint32_t vertex;
    ParameterPoint at;
  };
  /// Finds the vertices that stand for others: those on edges and on sides of patches may.
  void merge() {
    for_vertices([&](std::uint32_t, std::uint32_t k) { all_.same_[k] = k; });
    const auto poles = std::ranges::equal_range(all_.poles_, face_, {}, [](const auto& pole) { return pole[0]; });
    for (const auto& pole : poles)
      if (!is_pole(pole[1])) poles_.push_back(pole[1]);
    std::vector<Candidate> some;
    some.reserve(64);
    for_vertices([&](std::uint32_t patch, std::uint32_t k) {
      if (all_.nodes_[k] != 0 || is_on_side(k)) some.push_back({k, parameters(patch, k)});
    });
    std::vector<std::uint32_t> table(std::bit_ceil(2 * some.size() + 1), no_id);  // into `some`
    for (std::uint32_t k = 0; k < some.size(); ++k) {
      const std::uint32_t vertex = some[k].vertex, linked = all_.linked_[vertex];
      std::size_t slot = hash(vertex) & (table.size() - 1);
      while (table[slot] != no_id && !are_same(some[table[slot]], some[k])) slot = (slot + 1) & (table.size() - 1);
      if (table[slot] != no_id) {
        all_.same_[vertex] = all_.same_[some[table[slot]].vertex];
        continue;
      }
      table[slot] = k;
      if (linked == vertex) continue;
      const Candidate& other = *std::ranges::lower_bound(some, linked, {}, &Candidate::vertex);
      if (are_near(some[k].at, other.at, 0.25)) all_.same_[vertex] = all_.same_[linked];
    }
    for_vertices([&](std::uint32_t, std::uint32_t k) {
      if (all_.same_[k] != k) all_.nodes_[all_.same_[k]] |= all_.nodes_[k];
    });
  }
  bool is_on_side(std::uint32_t vertex) const {
    const float u = mesh_.parameters[2 * std::size_t{vertex}], v = mesh_.parameters[2 * std::size_t{vertex} + 1];
    return u <= 0 || u >= 1 || v <= 0 || v >= 1;
  }
  /// The parameters of the face's surface, in ours.
  ParameterPoint parameters(std::uint32_t patch, std::uint32_t vertex) const {
    const Domain& of = all_.set_.source(patch).domain;
    return {of.u_at(double(mesh_.parameters[2 * std::size_t{vertex}])),
            of.v_at(double(mesh_.parameters[2 * std::size_t{vertex} + 1]))};
  }
  gp_Pnt2d their_parameters(const ParameterPoint& ours) {
    double u = std::clamp(ours.u, domain_.u0, domain_.u1), v = std::clamp(ours.v, domain_.v0, domain_.v1);
    if (source_.is_turned) std::swap(u, v);  // see OcctFace
    return {along_u_(u), along_v_(v)};
  }
  /// Calls with(p) for the coordinates of a vertex as the mesh has them: in double, or in float relative to its origin.
  template <class With>
  auto with_position(std::uint32_t vertex, With with) const {
    const std::size_t at = 3 * std::size_t{vertex};
    return mesh_.model_positions.empty() ? with(&mesh_.positions[at]) : with(&mesh_.model_positions[at]);
  }
  bool have_one_place(std::uint32_t a, std::uint32_t b) const {
    const std::ptrdiff_t other = 3 * (std::ptrdiff_t{b} - std::ptrdiff_t{a});
    return with_position(
        a, [&](const auto* p) { return p[0] == p[other] && p[1] == p[other + 1] && p[2] == p[other + 2]; });
  }
  gp_Pnt position(std::uint32_t vertex) const {
    const Vec3 origin = mesh_.model_positions.empty() ? mesh_.origin : Vec3{};
    return with_position(vertex, [&](const auto* p) {
      return gp_Pnt(origin.x + double(p[0]), origin.y + double(p[1]), origin.z + double(p[2]));
    });
  }
  bool is_pole(std::uint32_t vertex) const {
    return std::ranges::any_of(poles_, [&](std::uint32_t pole) { return have_one_place(pole, vertex); });
  }
  std::size_t hash(std::uint32_t vertex) const {
    const std::uint64_t sum = with_position(vertex, [](const auto* p) {
      std::uint64_t of = 0;
      for (int c = 0; c < 3; ++c)
        of = (of ^ std::bit_cast<std::uint64_t>(double(p[c]) + 0.0)) * 0x9E3779B97F4A7C15u;  // -0 is 0
      return of ^ (of >> 31);
    });
    return static_cast<std::size_t>(sum ^ (sum >> 29));
  }
  /// Whether vertices are one node: those of patches that meet, whose parameters differ by rounding, and those on edges
  /// that edges have joined. Along a seam, parameters differ by the whole range of the face.
  bool are_same(const Candidate& a, const Candidate& b) const {
    if (!have_one_place(a.vertex, b.vertex)) return false;
    if (is_pole(a.vertex)) return true;
    return are_near(a.at, b.at, all_.nodes_[a.vertex] != 0 && all_.nodes_[b.vertex] != 0 ? 0.25 : 0x1p-24);
  }
  /// Whether parameters differ by at most this share of the face's ranges.
  bool are_near(const ParameterPoint& a, const ParameterPoint& b, double share) const {
    return std::abs(a.u - b.u) <= share * (domain_.u1 - domain_.u0) &&
           std::abs(a.v - b.v) <= share * (domain_.v1 - domain_.v0);
  }

  /// Lists the triangles that have a size, and marks their vertices.
  void mark() {
    std::size_t count = 0;
    for (const std::uint32_t patch : patches())
      count += all_.plan_.before(patch + 1).triangles - all_.plan_.before(patch).triangles;
    triangles_.reserve(count);
    for (const std::uint32_t patch : patches()) {
      const std::size_t end = all_.plan_.before(patch + 1).triangles;
      for (std::size_t t = all_.plan_.before(patch).triangles; t < end; ++t) {
        Corners corners;
        for (std::size_t c = 0; c < 3; ++c) corners[c] = all_.same_[mesh_.indices[3 * t + c]];
        const auto [a, b, c] = corners;
        if (a == b || b == c || c == a || have_one_place(a, b) || have_one_place(b, c) || have_one_place(c, a))
          continue;
        for (const std::uint32_t corner : corners) all_.nodes_[corner] = 1;
        triangles_.push_back(corners);
      }
    }
  }
  void number() {
    for_vertices([&](std::uint32_t, std::uint32_t k) {
      if (all_.same_[k] == k && all_.nodes_[k] != 0) all_.nodes_[k] = static_cast<std::uint32_t>(++nodes_);
    });
  }
  void put_triangles() {
    const bool swaps = source_.is_turned;
    const auto node = [&](std::uint32_t vertex) { return static_cast<int>(all_.nodes_[vertex]); };
    for (std::size_t k = 0; k < triangles_.size(); ++k) {
      const auto [a, b, c] = triangles_[k];
      const Poly_Triangle made =
          swaps ? Poly_Triangle(node(a), node(c), node(b)) : Poly_Triangle(node(a), node(b), node(c));
      made_->SetTriangle(static_cast<int>(k) + 1, made);
    }
  }

  void put_nodes() {
    const TopLoc_Location& place = source_.face.Location();
    const bool moves = !place.IsIdentity();
    gp_Trsf back;
    if (moves) back = place.Transformation().Inverted();
    const float sign = source_.is_turned != (moves && back.IsNegative()) ? -1.0f : 1.0f;
    for_vertices([&](std::uint32_t patch, std::uint32_t k) {
      if (all_.same_[k] != k || all_.nodes_[k] == 0) return;
      const int node = static_cast<int>(all_.nodes_[k]);
      const float* const n = &mesh_.normals[3 * std::size_t{k}];
      gp_Pnt at = position(k);
      gp_Vec3f normal(sign * n[0], sign * n[1], sign * n[2]);
      if (moves) {
        at.Transform(back);
        normal = turned(normal, back);
      }
      made_->SetNode(node, at);
      made_->SetUVNode(node, their_parameters(parameters(patch, k)));
      made_->SetNormal(node, normal);
      lacks_normals_ = lacks_normals_ || (n[0] == 0 && n[1] == 0 && n[2] == 0);
    });
    if (lacks_normals_) put_missing_normals();
  }
  static gp_Vec3f turned(const gp_Vec3f& normal, const gp_Trsf& by) {
    gp_Vec vector(double(normal.x()), double(normal.y()), double(normal.z()));
    vector.Transform(by);
    const double size = vector.Magnitude();
    if (!(size > 0)) return normal;
    return gp_Vec3f(static_cast<float>(vector.X() / size), static_cast<float>(vector.Y() / size),
                    static_cast<float>(vector.Z() / size));
  }
  /// Gives nodes where the surface has no normal the one of a triangle there.
  void put_missing_normals() {
    for (int k = 1; k <= made_->NbTriangles(); ++k) {
      int corner[3];
      made_->Triangle(k).Get(corner[0], corner[1], corner[2]);
      for (const int node : corner) {
        gp_Vec3f normal;
        made_->Normal(node, normal);
        if (normal.x() != 0 || normal.y() != 0 || normal.z() != 0) continue;
        const gp_Pnt a = made_->Node(corner[0]), b = made_->Node(corner[1]), c = made_->Node(corner[2]);
        const gp_Vec across = gp_Vec(a, b).Crossed(gp_Vec(a, c));
        if (across.Magnitude() > 0) made_->SetNormal(node, gp_Dir(across));
      }
    }
  }

  FaceTriangulations& all_;
  const Mesh& mesh_;
  std::size_t face_;
  const OcctFace& source_;
  TheirParameter along_u_, along_v_;
  Domain domain_;
  std::vector<std::uint32_t> poles_;  ///< a vertex at each
  std::vector<Corners> triangles_;
  int nodes_ = 0;
  bool lacks_normals_ = false;
  handle<Poly_Triangulation> made_;
};

handle<Poly_Triangulation> FaceTriangulations::make(std::size_t face) { return Maker(*this, face).run(); }

}}  // namespace tessera::abi_0_1
