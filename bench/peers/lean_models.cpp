// The models of occt_lean_mesh.

#include <Standard_Failure.hxx>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <stdexcept>

#include "model_files.h"
#include "peers/lean_cases.h"
#include "peers/occt_shape.h"
#include "support/synthetic_sets.h"
#include "tessera/model.h"

namespace tessera::bench {
namespace {

namespace fs = std::filesystem;

/// Finds the models below a folder, sorted.
void find_models(const fs::path& folder, const std::string& only, std::vector<fs::path>& found) {
  const std::size_t first = found.size();
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const bool is_values = entry.path().parent_path().filename() == "peer_cases";  // not a model
    if (is_model(entry.path()) && !is_values && entry.path().string().find(only) != std::string::npos)
      found.push_back(entry.path());
  }
  std::sort(found.begin() + static_cast<std::ptrdiff_t>(first), found.end());
}

BSplineSurface placed(const BSplineSurface& s, const Affine& map) {
  std::vector<Vec3> points;
  for (const Vec3& p : s.points()) points.push_back(map.point(p));
  return test::value_of(s.is_rational() ? BSplineSurface::rational(s.degree_u(), s.knots_u(), s.degree_v(), s.knots_v(),
                                                                   points, s.weights(), s.domain())
                                        : BSplineSurface::polynomial(s.degree_u(), s.knots_u(), s.degree_v(),
                                                                     s.knots_v(), points, s.domain()));
}

/// Throws std::runtime_error if OpenCASCADE's surfaces have other points than the patches at the same parameters.
void check_same(const PatchGrid& grid, const std::vector<Handle(Geom_Surface)>& surfaces, bool one_face) {
  const double near = 1e-9 * (grid.box().diagonal() + length(grid.box().lower) + length(grid.box().upper));
  for (std::size_t k = 0; k < grid.patches().size(); ++k) {
    const Domain d = one_face ? grid.patch_domain(k) : Domain{};
    const Geom_Surface& surface = *surfaces[one_face ? 0 : k];
    for (const double u : {0.1, 0.5, 0.8})
      for (const double v : {0.1, 0.5, 0.8}) {
        const gp_Pnt p = surface.Value(d.u0 + u * (d.u1 - d.u0), d.v0 + v * (d.v1 - d.v0));
        if (!(length(Vec3{p.X(), p.Y(), p.Z()} - de_casteljau(grid.patches()[k], u, v)) <= near))
          throw std::runtime_error("OpenCASCADE's surface is another one");
      }
  }
}

/// The rational or the polynomial surfaces of one model.
struct Part {
  std::vector<PatchGrid> grids;
  std::vector<Handle(Geom_Surface)> surfaces;

  /// Adds a surface: a B-spline surface becomes one face, another surface one face per patch.
  void add(const ModelSurface& surface, PatchGrid grid) {
    std::vector<Handle(Geom_Surface)> own;
    if (const auto* const spline = std::get_if<BSplineSurface>(&surface.surface))
      own.push_back(occt_surface(placed(*spline, surface.placement)));
    else
      for (const BezierPatch& patch : grid.patches()) own.push_back(occt_surface(patch));
    check_same(grid, own, std::holds_alternative<BSplineSurface>(surface.surface));
    surfaces.insert(surfaces.end(), own.begin(), own.end());
    grids.push_back(std::move(grid));
  }
};

void skip(const std::string& name, const std::string& why) {
  std::printf("skipped: %s: %s\n", name.c_str(), why.c_str());
}

void add_cases(const std::string& name, const Model& model, std::vector<LeanCase>& cases) {
  Part parts[2];  // polynomial, rational
  std::size_t trimmed = 0;
  for (const ModelSurface& surface : model.surfaces) {
    if (!surface.trims->empty()) {
      ++trimmed;
      continue;
    }
    if (std::holds_alternative<ParametricSurface>(surface.surface)) continue;
    Result<PatchGrid> grid = to_bezier(surface);
    if (!grid) {
      skip(name, grid.status().message());
    } else if (grid->fit_error().distance == 0) {
      const bool rational = std::ranges::any_of(grid->patches(), &BezierPatch::is_rational);
      try {
        parts[rational].add(surface, *std::move(grid));
      } catch (const Standard_Failure& failure) {
        skip(name, std::string("OpenCASCADE: ") + failure.GetMessageString());
      } catch (const std::runtime_error& error) {
        skip(name, error.what());
      }
    }
  }
  if (trimmed > 0) skip(name, std::to_string(trimmed) + (trimmed == 1 ? " trimmed surface" : " trimmed surfaces"));
  for (const bool rational : {true, false}) {
    if (parts[rational].grids.empty()) continue;
    Result<PatchSet> set = make_patch_set(parts[rational].grids);
    if (!set) {
      skip(name, set.status().message());
      continue;
    }
    const double size = set->box().diagonal();
    cases.push_back({name,
                     *std::move(set),
                     rational ? parts[rational].surfaces : std::vector<Handle(Geom_Surface)>{},
                     {3e-2 * size, 1e-2 * size, 1e-3 * size, 1e-4 * size},
                     true});
  }
}

}  // namespace

std::string patch_kinds(const PatchSet& set) {
  std::set<std::pair<int, int>> degrees;
  double ratio = 1;
  for (std::size_t k = 0; k < set.patch_count(); ++k) {
    const BezierPatch& patch = set.patch(k);
    degrees.insert({patch.degree_u(), patch.degree_v()});
    if (!patch.is_rational()) continue;
    const auto [low, high] = std::ranges::minmax(patch.weights());
    ratio = std::max(ratio, high / low);
  }
  std::string text = ratio > 1 ? "rational" : "polynomial";
  for (const auto& [m, n] : degrees) text += " " + std::to_string(m) + "x" + std::to_string(n);
  char weights[48] = "";
  if (ratio > 1) std::snprintf(weights, sizeof weights, ", weights to 1:%.3g", ratio);
  return text + weights;
}

std::vector<LeanCase> model_cases(const std::string& only) {
  std::vector<fs::path> files;
  find_models(fs::path(TESSERA_SOURCE_DIR) / "tools" / "models", only, files);
  if (const char* const data = std::getenv("TESSERA_TEST_DATA"))
    find_models(data, only, files);
  else
    skip("models of other programs", "TESSERA_TEST_DATA is not set");
#ifndef TESSERA_HAS_CAD_READER
  skip("CAD files", "tessera-cad-reader is not built");
#endif
  std::vector<LeanCase> cases;
  for (const fs::path& file : files) {
    const std::string name = file.parent_path().filename().string() + "/" + file.filename().string();
    const Result<Model> model = read_model(file);
    if (model)
      add_cases(name, *model, cases);
    else
      skip(name, model.status().message());
  }
  return cases;
}

}  // namespace tessera::bench
