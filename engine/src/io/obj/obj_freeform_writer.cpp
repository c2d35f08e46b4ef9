// Writes free-form Wavefront OBJ ("Object Files (.obj)", Appendix B1 of the Advanced Visualizer manual): Bezier patches
// with their trims. A surface is one `surf` of all its patches if these share their borders, which keeps its
// parameters; otherwise one `surf` per patch.

#include <string>

#include "io/obj/obj_name.h"
#include "io/spline/model_formats.h"
#include "io/spline/patch_net.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

class ObjSurfaceWriter {
 public:
  explicit ObjSurfaceWriter(OutputFile& out) : out_(out) {}

  /// Returns false if the surface has trims that are left out.
  bool write(const WrittenSurface& surface) {
    write_group(surface.name);
    return write_as_nets(surface, out_, [this](const WrittenSurface& net) { write_surface(net); });
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
    const PatchNet net(surface);
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
  void write_vertices(const PatchNet& net) {
    for (std::size_t j = 0; j < net.count_v(); ++j)
      for (std::size_t i = 0; i < net.count_u(); ++i) {
        const PatchNet::Place at = net.place(i, j);
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

}}  // namespace tessera::abi_0_1
