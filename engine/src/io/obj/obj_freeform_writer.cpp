// Writes free-form Wavefront OBJ ("Object Files (.obj)", Appendix B1 of the Advanced Visualizer manual): Bezier patches
// with their trims. A surface is one `surf` of all its patches if these share their borders, which keeps its
// parameters; otherwise one `surf` per patch.

#include <array>
#include <string>

#include "io/obj/obj_name.h"
#include "io/spline/model_formats.h"

namespace tessera::inline abi_0_1 {
namespace {

/// The patches of a surface as one net: control point (i, j) of the whole.
class Net {
 public:
  explicit Net(const WrittenSurface& surface)
      : surface_(surface),
        degree_u_(static_cast<std::size_t>(surface.patches.front().degree_u())),
        degree_v_(static_cast<std::size_t>(surface.patches.front().degree_v())),
        pieces_u_(surface.breaks_u.size() - 1),
        pieces_v_(surface.breaks_v.size() - 1) {}

  std::size_t count_u() const { return degree_u_ * pieces_u_ + 1; }
  std::size_t count_v() const { return degree_v_ * pieces_v_ + 1; }
  bool is_rational() const { return surface_.patches.front().is_rational(); }

  struct Place {
    const BezierPatch* patch;
    int i, j;
  };
  /// Where (i, j) is stored. On a common border, it is the patch with the smaller index.
  Place place(std::size_t i, std::size_t j) const {
    const std::size_t a = i == 0 ? 0 : (i - 1) / degree_u_, b = j == 0 ? 0 : (j - 1) / degree_v_;
    return {&surface_.patches[a * pieces_v_ + b], static_cast<int>(i - a * degree_u_),
            static_cast<int>(j - b * degree_v_)};
  }

  /// Whether each patch is its part of the net: degrees are equal, and shared borders have equal points and weights (by
  /// ==).
  bool holds_all() const {
    for (std::size_t k = 0; k < surface_.patches.size(); ++k) {
      const BezierPatch& patch = surface_.patches[k];
      if (static_cast<std::size_t>(patch.degree_u()) != degree_u_ ||
          static_cast<std::size_t>(patch.degree_v()) != degree_v_ || patch.is_rational() != is_rational())
        return false;
      if (!holds(patch, k / pieces_v_ * degree_u_, k % pieces_v_ * degree_v_)) return false;
    }
    return true;
  }

 private:
  /// Checks the first row and column, which another patch may have written.
  bool holds(const BezierPatch& patch, std::size_t first_i, std::size_t first_j) const {
    const auto same = [&](int i, int j) {
      const Place at = place(first_i + static_cast<std::size_t>(i), first_j + static_cast<std::size_t>(j));
      return at.patch->point(at.i, at.j) == patch.point(i, j) && at.patch->weight(at.i, at.j) == patch.weight(i, j);
    };
    for (int j = 0; j <= patch.degree_v(); ++j)
      if (!same(0, j)) return false;
    for (int i = 0; i <= patch.degree_u(); ++i)
      if (!same(i, 0)) return false;
    return true;
  }

  const WrittenSurface& surface_;
  std::size_t degree_u_, degree_v_, pieces_u_, pieces_v_;
};

class ObjSurfaceWriter {
 public:
  explicit ObjSurfaceWriter(OutputFile& out) : out_(out) {}

  /// Returns false if the surface has trims that are left out.
  bool write(const WrittenSurface& surface) {
    write_group(surface.name);
    if (Net(surface).holds_all()) {
      write_surface(surface);
      return true;
    }
    for (std::size_t k = 0; k < surface.patches.size() && !out_.failed(); ++k) {
      const Domain domain = surface.patch_domain(k);
      const std::array breaks_u{domain.u0, domain.u1}, breaks_v{domain.v0, domain.v1};
      write_surface({surface.name, breaks_u, breaks_v, surface.patches.subspan(k, 1), {}});
    }
    return surface.trims.empty();
  }

 private:
  void write_group(std::string_view name) {
    const std::string line = obj_name(name);
    if (line == group_) return;
    group_ = line;
    out_.write("g " + line + "\n");
  }

  void write_surface(const WrittenSurface& surface) {
    const std::size_t first_curve = curves_;
    for (const TrimLoop& loop : surface.trims)
      for (const Curve& curve : loop.curves) write_curve(curve);
    const Net net(surface);
    write_vertices(net);
    const BezierPatch& patch = surface.patches.front();
    out_.write(net.is_rational() ? "cstype rat bezier\ndeg " : "cstype bezier\ndeg ");
    out_.write_number(patch.degree_u());
    write_value(patch.degree_v());
    out_.write("\nsurf");
    for (const double end :
         {surface.breaks_u.front(), surface.breaks_u.back(), surface.breaks_v.front(), surface.breaks_v.back()})
      write_value(end);
    write_indices(vertices_ + 1, net.count_u() * net.count_v());
    vertices_ += net.count_u() * net.count_v();
    write_parameters('u', surface.breaks_u);
    write_parameters('v', surface.breaks_v);
    write_loops(surface.trims, first_curve);
    out_.write("end\n");
  }

  /// Writes vertices along u first.
  void write_vertices(const Net& net) {
    for (std::size_t j = 0; j < net.count_v(); ++j)
      for (std::size_t i = 0; i < net.count_u(); ++i) {
        const Net::Place at = net.place(i, j);
        const Vec3& p = at.patch->point(at.i, at.j);
        out_.write('v');
        for (const double value : {p.x, p.y, p.z}) write_value(value);
        if (net.is_rational()) write_value(at.patch->weight(at.i, at.j));
        out_.write('\n');
      }
  }

  /// Writes a trim's curve in the parameters, on its whole knots; `trim` and `hole` select the part of it.
  void write_curve(const Curve& curve) {
    for (std::size_t k = 0; k < curve.points().size(); ++k) {
      out_.write("vp");
      write_value(curve.points()[k].x);
      write_value(curve.points()[k].y);
      if (curve.is_rational()) write_value(curve.weight(k));
      out_.write('\n');
    }
    out_.write(curve.is_rational() ? "cstype rat bspline\ndeg " : "cstype bspline\ndeg ");
    out_.write_number(curve.degree());
    out_.write("\ncurv2");
    write_indices(parameter_vertices_ + 1, curve.points().size());
    parameter_vertices_ += curve.points().size();
    write_parameters('u', curve.knots());
    out_.write("end\n");
    ++curves_;
  }

  void write_loops(std::span<const TrimLoop> loops, std::size_t curve) {
    for (const TrimLoop& loop : loops) {
      if (loop.curves.empty()) continue;
      out_.write(loop.hole ? "hole" : "trim");
      for (const Curve& part : loop.curves) {
        write_value(part.domain().from);
        write_value(part.domain().to);
        write_value(++curve);
        if (&part != &loop.curves.back()) out_.write(" \\\n");
      }
      out_.write('\n');
    }
  }

  void write_indices(std::size_t first, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) {
      if (k % values_per_line == 0) out_.write(" \\\n");
      write_value(first + k);
    }
    out_.write('\n');
  }

  void write_parameters(char direction, std::span<const double> values) {
    out_.write("parm ");
    out_.write(direction);
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (k > 0 && k % values_per_line == 0) out_.write(" \\\n");
      write_value(values[k]);
    }
    out_.write('\n');
  }

  template <class Number>
  void write_value(Number value) {
    out_.write(' ');
    out_.write_number(value);
  }

  static constexpr std::size_t values_per_line = 16;

  OutputFile& out_;
  std::string group_;
  std::size_t vertices_ = 0, parameter_vertices_ = 0, curves_ = 0;  // written so far
};

}  // namespace

Status write_obj_freeform(std::span<const WrittenSurface> surfaces, OutputFile& out,
                          std::vector<std::string>& warnings) {
  out.write("# Tessera: " + std::to_string(surfaces.size()) + (surfaces.size() == 1 ? " surface\n" : " surfaces\n"));
  ObjSurfaceWriter writer(out);
  for (std::size_t k = 0; k < surfaces.size() && !out.failed(); ++k)
    if (!writer.write(surfaces[k]))
      warnings.push_back(trims_left_out(k, surfaces[k], "its patches do not share their borders"));
  return {};
}

}  // namespace tessera::inline abi_0_1
