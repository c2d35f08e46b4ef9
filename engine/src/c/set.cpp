// Patch sets of the C interface, and their evaluation.

#include <span>
#include <vector>

#include "base/text.h"
#include "c/objects.h"
#include "tessera/limits.h"

using namespace tessera;

namespace tessera { inline namespace abi_0_1 { namespace {

Result<PatchSet> packed(const Model& model, const tsr_set_options& options, const Execution& execution) {
  PatchSetOptions packing;
  packing.execution = execution;
  packing.trims = (options.flags & TSR_SET_WHOLE) == 0;
  packing.blocks.double_points = (options.flags & TSR_SET_POINTS) != 0;
  packing.blocks.double_bernstein = (options.flags & TSR_SET_DOUBLE) != 0;
  FitOptions fit;
  if (options.fit_tolerance != 0) fit.tolerance = options.fit_tolerance;
  return options.shape < 0 ? make_patch_set(model, packing, fit)
                           : make_patch_set(model.shapes[static_cast<std::size_t>(options.shape)], packing, fit);
}

CStatus check_options(const tsr_set_options& options, const Model& model) {
  if (options.flags & ~std::uint32_t{TSR_SET_WHOLE | TSR_SET_POINTS | TSR_SET_DOUBLE})
    return bad("tsr_set_options: flags has bits that mean nothing");
  if (options.shape < -1 || options.shape >= static_cast<std::int64_t>(model.shapes.size()))
    return bad("tsr_set_options: shape is " + std::to_string(options.shape) + ", the model has " +
               std::to_string(model.shapes.size()) + " shapes; -1 stands for all surfaces");
  return {};
}

/// Reads the outputs of an evaluation at `u` and `v`, none of which may be null.
CStatus read_jets(const void* u, const void* v, const tsr_jets* out, tsr_jets& jets) {
  if (!u || !v || !out) return null_pointer(!u ? "u" : !v ? "v" : "out");
  return read_struct("tsr_jets", out, jets);
}

CStatus view_of(const char*, const tsr_out& from, bool& is_wanted) {
  is_wanted = from.data != nullptr;
  return {};
}

/// Views of all outputs that are wanted, or flags of these.
template <class Views>
CStatus views_of(const tsr_jets& out, Views& views) {
  CStatus status;
  const auto put = [&](const char* name, const tsr_out& from, auto& view) {
    if (status.code == TSR_OK) status = view_of(name, from, view);
  };
  put("position", out.position, views.position);
  put("du", out.du, views.du), put("dv", out.dv, views.dv);
  put("duu", out.duu, views.duu), put("duv", out.duv, views.duv), put("dvv", out.dvv, views.dvv);
  put("normal", out.normal, views.normal);
  put("first_form", out.first_form, views.first_form), put("second_form", out.second_form, views.second_form);
  put("gaussian", out.gaussian, views.gaussian), put("mean", out.mean, views.mean);
  put("first_curvature", out.first_curvature, views.first_curvature);
  put("second_curvature", out.second_curvature, views.second_curvature);
  put("first_direction", out.first_direction, views.first_direction);
  put("second_direction", out.second_direction, views.second_direction);
  return status;
}

template <class T>
CStatus evaluate_grid(const PatchSet& set, std::span<const double> u, std::span<const double> v, const tsr_jets& out,
                      const Execution& execution) {
  QuantityViews<T> views;
  if (CStatus status = views_of(out, views); status.code) return status;
  GridPlanOptions options;
  if constexpr (std::is_same_v<T, double>) options.precision = Precision::double_precision;
  const Result<GridPlan> plan = GridPlan::make(set, u, v, options);
  if (!plan) return plan.status();
  return evaluate(set, *plan, views, execution);
}

/// The least time that a grid of these outputs takes.
CStatus grid_limit(const PatchSet& set, std::span<const double> u, std::span<const double> v, const tsr_jets& out,
                   const tsr_limits_info& rates, double& seconds) {
  QuantityFlags wanted;
  if (CStatus status = views_of(out, wanted); status.code) return status;
  GridPlanOptions options;
  if (out.is_double) options.precision = Precision::double_precision;
  const Result<GridPlan> plan = GridPlan::make(set, u, v, options);
  if (!plan) return plan.status();
  Limits limits;
  limits.float_operations_per_second = rates.float_operations_per_second;
  limits.double_operations_per_second = rates.double_operations_per_second;
  limits.store_bytes_per_second = rates.store_bytes_per_second;
  seconds = seconds_at_limit(limits, plan->work(wanted));
  return {};
}

template <class T>
CStatus evaluate_points(CSet& of, const SurfaceSamples& samples, const tsr_jets& out, const Execution& execution) {
  QuantityViews<T> views;
  if (CStatus status = views_of(out, views); status.code) return status;
  const Result<const SurfaceMap*> map = of.surface_map();
  if (!map) return map.status();
  return evaluate(of.set, **map, samples, views, {}, execution);
}

}}}  // namespace tessera::abi_0_1

extern "C" {

void tsr_set_defaults(tsr_set_options* options) {
  if (options) *options = {.struct_size = sizeof *options, .shape = -1, .flags = 0, .reserved = 0, .fit_tolerance = 0};
}

tsr_status tsr_set_new(tsr_set** set, const tsr_model* model, const tsr_set_options* options, const tsr_run* run) {
  if (set) *set = nullptr;
  return c_call([&]() -> CStatus {
    if (!set) return null_pointer("set");
    const Held<CModel> of(model);
    if (!of) return of.error();
    tsr_set_options own;
    tsr_set_defaults(&own);
    if (CStatus status = read_struct("tsr_set_options", options, own); status.code) return status;
    if (CStatus status = check_options(own, of->model); status.code) return status;
    return run_work(run, [&](const Execution& execution) -> CStatus {
      Result<PatchSet> made = packed(of->model, own, execution);
      if (!made) return made.status();
      const std::optional<std::size_t> shape =
          own.shape < 0 ? std::nullopt : std::optional(static_cast<std::size_t>(own.shape));
      return give(set, std::make_shared<CSet>(*std::move(made), of.shared(), shape));
    });
  });
}

tsr_status tsr_set_describe(const tsr_set* set, tsr_set_info* info) {
  return c_call([&]() -> CStatus {
    const Held<CSet> of(set);
    if (!of) return of.error();
    const Reading reading(of->usage);
    if (!reading) return in_use(Object::Kind::set);
    tsr_set_info filled{};
    filled.patches = of->set.patch_count();
    filled.surfaces = of->set.surface_count();
    filled.cut_patches = of->set.cut_count();
    const auto [revision, box, memory_bytes] = of->extent();
    filled.memory_bytes = memory_bytes;
    filled.revision = revision;
    const auto put = [](double(&to)[3], const Vec3& from) { to[0] = from.x, to[1] = from.y, to[2] = from.z; };
    put(filled.low, box.lower), put(filled.high, box.upper), put(filled.origin, of->set.origin());
    filled.fit_error = of->set.fit_error().distance;
    filled.unused_loops = of->set.trim_faults().size();
    return write_struct("tsr_set_info", info, filled);
  });
}

tsr_status tsr_set_patch(const tsr_set* set, size_t patch, tsr_patch_info* info, double* points, double* weights) {
  return c_call([&]() -> CStatus {
    const Held<CSet> of(set);
    if (!of) return of.error();
    const Reading reading(of->usage);
    if (!reading) return in_use(Object::Kind::set);
    if (patch >= of->set.patch_count())
      return bad("patch " + std::to_string(patch) + " is none, there are " + std::to_string(of->set.patch_count()));
    const BezierPatch& from = of->set.patch(patch);
    const PatchSource& source = of->set.source(patch);
    const Domain& range = source.domain;
    if (info)
      if (CStatus status = write_struct("tsr_patch_info", info,
                                        {0,
                                         from.degree_u(),
                                         from.degree_v(),
                                         from.is_rational(),
                                         of->set.is_cut(patch),
                                         source.surface,
                                         {range.u0, range.u1, range.v0, range.v1}});
          status.code)
        return status;
    const std::span<const Vec3> own = from.points();
    if (points) std::memcpy(points, own.data(), own.size_bytes());
    for (std::size_t k = 0; weights && k < own.size(); ++k) weights[k] = from.is_rational() ? from.weights()[k] : 1;
    return {};
  });
}

tsr_status tsr_set_edit(tsr_set* set, const uint32_t* patches, size_t count, const double* points, size_t point_count) {
  return c_call([&]() -> CStatus {
    const Held<CSet> of(set);
    if (!of) return of.error();
    if (count > 0 && (!patches || !points)) return null_pointer(patches ? "points" : "patches");
    const Changing changing(of->usage);
    if (!changing) return in_use(Object::Kind::set);
    PatchSet& own = of->set;
    std::size_t needed = 0;
    for (std::size_t k = 0; k < count; ++k) {
      if (patches[k] >= own.patch_count())
        return CStatus(
            Status(StatusCode::invalid_argument,
                   "patch " + std::to_string(patches[k]) + " is none, there are " + std::to_string(own.patch_count()),
                   static_cast<std::ptrdiff_t>(k)));
      needed += own.patch(patches[k]).points().size();
    }
    if (needed != point_count)
      return CStatus(Status(StatusCode::count_mismatch, "the patches have " + std::to_string(needed) +
                                                            " control points, found " + std::to_string(point_count)));
    const Vec3* at = reinterpret_cast<const Vec3*>(points);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t of_patch = own.patch(patches[k]).points().size();
      if (Status status = own.set_control_points(patches[k], {at, of_patch}); !status.ok())
        return CStatus(Status(status.code(), status.message(), static_cast<std::ptrdiff_t>(k)));
      at += of_patch;
    }
    return {};
  });
}

tsr_status tsr_set_grid(const tsr_set* set, const double* u, size_t count_u, const double* v, size_t count_v,
                        const tsr_jets* out, const tsr_run* run) {
  return c_call([&]() -> CStatus {
    const Held<CSet> of(set);
    if (!of) return of.error();
    tsr_jets jets{};
    if (CStatus status = read_jets(u, v, out, jets); status.code) return status;
    const Reading reading(of->usage);
    if (!reading) return in_use(Object::Kind::set);
    return run_work(run, [&](const Execution& execution) {
      const auto grid = jets.is_double ? &evaluate_grid<double> : &evaluate_grid<float>;
      return grid(of->set, {u, count_u}, {v, count_v}, jets, execution);
    });
  });
}

tsr_status tsr_set_evaluate(const tsr_set* set, const tsr_in* surface, const tsr_in* u, const tsr_in* v,
                            const tsr_jets* out, const tsr_run* run) {
  return c_call([&]() -> CStatus {
    const Held<CSet> of(set);
    if (!of) return of.error();
    tsr_jets jets{};
    if (CStatus status = read_jets(u, v, out, jets); status.code) return status;
    if (!jets.is_double) return CStatus(TSR_UNSUPPORTED, "scattered points are evaluated in double: set is_double");
    SurfaceSamples samples;
    if (surface)
      if (CStatus status = view_of("surface", *surface, samples.surface); status.code) return status;
    if (CStatus status = view_of("u", *u, samples.u); status.code) return status;
    if (CStatus status = view_of("v", *v, samples.v); status.code) return status;
    const Reading reading(of->usage);
    if (!reading) return in_use(Object::Kind::set);
    return run_work(run,
                    [&](const Execution& execution) { return evaluate_points<double>(*of, samples, jets, execution); });
  });
}

tsr_status tsr_set_grid_limit(const tsr_set* set, size_t count_u, size_t count_v, const tsr_jets* out,
                              const tsr_limits_info* limits, double* seconds) {
  return c_call([&]() -> CStatus {
    const Held<CSet> of(set);
    if (!of) return of.error();
    tsr_jets jets{};
    if (!out || !limits || !seconds) return null_pointer(!out ? "out" : !limits ? "limits" : "seconds");
    if (CStatus status = read_struct("tsr_jets", out, jets); status.code) return status;
    tsr_limits_info rates{};
    if (CStatus status = read_struct("tsr_limits_info", limits, rates); status.code) return status;
    for (const double rate :
         {rates.float_operations_per_second, rates.double_operations_per_second, rates.store_bytes_per_second})
      if (!(rate > 0)) return bad("tsr_limits_info: a rate is " + text(rate) + ", it must be above 0");
    const Reading reading(of->usage);
    if (!reading) return in_use(Object::Kind::set);
    return run_work(nullptr, [&](const Execution&) {
      const std::vector<double> u(count_u, 0.5), v(count_v, 0.5);  // the work depends on their numbers alone
      return grid_limit(of->set, u, v, jets, rates, *seconds);
    });
  });
}

tsr_status tsr_limits(size_t store_bytes, tsr_limits_info* info) {
  return c_call([&]() -> CStatus {
    LimitsOptions options;
    if (store_bytes != 0) options.store_bytes = store_bytes;
    const Result<Limits> measured = measure_limits(options);
    if (!measured) return measured.status();
    return write_struct("tsr_limits_info", info,
                        {0, measured->float_operations_per_second, measured->double_operations_per_second,
                         measured->store_bytes_per_second});
  });
}

}  // extern "C"
