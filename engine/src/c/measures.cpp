// Measures of the C interface.

#include <vector>

#include "c/objects.h"

using namespace tessera;

namespace tessera { inline namespace abi_0_1 { namespace {

constexpr std::uint32_t all_measures = TSR_MEASURE_AREAS | TSR_MEASURE_BODIES | TSR_MEASURE_BOX | TSR_MEASURE_ENCLOSED;

void put(const Vec3& from, double (&to)[3]) { to[0] = from.x, to[1] = from.y, to[2] = from.z; }

CStatus measure_bodies(const Model& model, std::uint32_t flags, const MeasureOptions& options,
                       const Execution& execution, std::vector<BodyMeasures>& bodies) {
  if (flags & TSR_MEASURE_ENCLOSED) {
    Result<BodyMeasures> body = measure_enclosed(model.surfaces, options, execution);
    if (!body) return body.status();
    bodies.push_back(*std::move(body));
    return {};
  }
  Result<std::vector<BodyMeasures>> found = measure_solids(model, options, execution);
  if (!found) return found.status();
  bodies = *std::move(found);
  return {};
}

/// Measures by the flags, one after the other; each is an equal share of the progress.
CStatus measure_model(const Model& model, std::uint32_t flags, const MeasureOptions& options,
                      const Execution& execution, CMeasures& made) {
  const bool has_bodies = (flags & (TSR_MEASURE_BODIES | TSR_MEASURE_ENCLOSED)) != 0;
  const int parts = ((flags & TSR_MEASURE_AREAS) != 0) + has_bodies + ((flags & TSR_MEASURE_BOX) != 0);
  double done = 0;
  Execution part = execution;
  if (execution.progress) part.progress = [&](double share) { execution.progress((done + share) / parts); };
  if (flags & TSR_MEASURE_AREAS) {
    Result<AreaMeasures> areas = measure_surfaces(model, options, part);
    if (!areas) return areas.status();
    made.areas = *std::move(areas);
    ++done;
  }
  if (has_bodies) {
    if (CStatus status = measure_bodies(model, flags, options, part, made.bodies.emplace()); status.code) return status;
    ++done;
  }
  if (flags & TSR_MEASURE_BOX) {
    Result<MeasuredBox> box = measure_box(model, options, part);
    if (!box) return box.status();
    made.box = *box;
  }
  return {};
}

CStatus not_measured(const char* what, const char* flag) {
  return bad(std::string(what) + " were not measured: tsr_measure_options.flags lacks " + flag);
}

CStatus check_index(const char* what, std::int64_t index, std::size_t count) {
  if (index >= -1 && index < static_cast<std::int64_t>(count)) return {};
  CStatus status =
      bad(std::string(what) + " " + std::to_string(index) + " is none, there are " + std::to_string(count));
  status.index = static_cast<std::ptrdiff_t>(index);
  return status;
}

tsr_body body_of(const BodyMeasures& from) {
  tsr_body to{};
  to.instance = from.instance, to.shape = from.shape, to.solid = from.solid, to.shell = from.shell;
  to.volume = from.volume.value, to.volume_error = from.volume.error;
  put(from.centroid.value, to.centroid), to.centroid_error = from.centroid.error;
  const Inertia& inertia = from.inertia;
  std::ranges::copy(std::array{inertia.xx, inertia.yy, inertia.zz, inertia.xy, inertia.yz, inertia.zx}, to.inertia);
  to.inertia_error = inertia.error;
  std::ranges::copy(inertia.moments, to.moments), to.moments_error = inertia.moments_error;
  double* at = to.axes;
  for (const Vec3& axis : inertia.axes)
    for (const double value : {axis.x, axis.y, axis.z}) *at++ = value;
  to.gap = from.gap, to.is_proven = from.proven;
  return to;
}

}}}  // namespace tessera::abi_0_1

extern "C" {

void tsr_measure_defaults(tsr_measure_options* options) {
  if (!options) return;
  const MeasureOptions usual;
  *options = {.struct_size = sizeof *options,
              .accuracy = usual.accuracy,
              .max_cells = usual.max_cells,
              .flags = TSR_MEASURE_AREAS | TSR_MEASURE_BODIES | TSR_MEASURE_BOX,
              .reserved = 0};
}

tsr_status tsr_measures_new(tsr_measures** measures, const tsr_model* model, const tsr_measure_options* options,
                            const tsr_run* run) {
  if (measures) *measures = nullptr;
  return c_call([&]() -> CStatus {
    if (!measures) return null_pointer("measures");
    const Held<CModel> of(model);
    if (!of) return of.error();
    tsr_measure_options own;
    tsr_measure_defaults(&own);
    if (CStatus status = read_struct("tsr_measure_options", options, own); status.code) return status;
    if (own.flags == 0) return bad("tsr_measure_options: flags is 0, expected at least one of TSR_MEASURE_*");
    if (CStatus status = check_member("tsr_measure_options", "flags", own.flags, all_measures); status.code)
      return status;
    return run_work(run, [&](const Execution& execution) -> CStatus {
      const auto made = std::make_shared<CMeasures>();
      const MeasureOptions wanted{.accuracy = own.accuracy, .max_cells = clamped_count(own.max_cells)};
      if (CStatus status = measure_model(of->model, own.flags, wanted, execution, *made); status.code) return status;
      return give(measures, made);
    });
  });
}

tsr_status tsr_measures_describe(const tsr_measures* measures, tsr_measures_info* info) {
  return c_call([&]() -> CStatus {
    const Held<CMeasures> of(measures);
    if (!of) return of.error();
    return write_struct("tsr_measures_info", info,
                        {0, of->areas ? of->areas->surfaces.size() : 0, of->bodies ? of->bodies->size() : 0,
                         of->areas ? of->areas->faults.size() : 0});
  });
}

const char* tsr_measures_fault(const tsr_measures* measures, size_t index, size_t* surface) {
  const Held<CMeasures> of(measures);
  if (!of || !of->areas || index >= of->areas->faults.size()) return nullptr;
  const Status& fault = of->areas->faults[index];
  if (surface) *surface = static_cast<std::size_t>(fault.index());
  return fault.message().c_str();
}

tsr_status tsr_measures_area(const tsr_measures* measures, int64_t surface, tsr_area* area) {
  return c_call([&]() -> CStatus {
    const Held<CMeasures> of(measures);
    if (!of) return of.error();
    if (!of->areas) return not_measured("areas", "TSR_MEASURE_AREAS");
    const std::vector<SurfaceMeasures>& surfaces = of->areas->surfaces;
    if (CStatus status = check_index("surface", surface, surfaces.size()); status.code) return status;
    const SurfaceMeasures& from = surface < 0 ? of->areas->total : surfaces[static_cast<std::size_t>(surface)];
    tsr_area to{};
    to.area = from.area.value, to.area_error = from.area.error;
    put(from.centroid.value, to.centroid), to.centroid_error = from.centroid.error;
    to.is_proven = from.proven;
    return write_struct("tsr_area", area, to);
  });
}

tsr_status tsr_measures_body(const tsr_measures* measures, int64_t body, tsr_body* filled) {
  return c_call([&]() -> CStatus {
    const Held<CMeasures> of(measures);
    if (!of) return of.error();
    if (!of->bodies) return not_measured("bodies", "TSR_MEASURE_BODIES");
    if (CStatus status = check_index("body", body, of->bodies->size()); status.code) return status;
    if (body >= 0) return write_struct("tsr_body", filled, body_of((*of->bodies)[static_cast<std::size_t>(body)]));
    if (of->bodies->empty())
      return bad("the model has no solid and no closed shell; TSR_MEASURE_ENCLOSED measures what its surfaces enclose");
    const Result<BodyMeasures> total = total_of(*of->bodies);
    return total ? write_struct("tsr_body", filled, body_of(*total)) : CStatus(total.status());
  });
}

tsr_status tsr_measures_box(const tsr_measures* measures, tsr_box* box) {
  return c_call([&]() -> CStatus {
    const Held<CMeasures> of(measures);
    if (!of) return of.error();
    if (!of->box) return not_measured("boxes", "TSR_MEASURE_BOX");
    tsr_box to{};
    put(of->box->box.lower, to.low), put(of->box->box.upper, to.high);
    put(of->box->lower_error, to.low_error), put(of->box->upper_error, to.high_error);
    to.is_proven = of->box->proven;
    return write_struct("tsr_box", box, to);
  });
}

}  // extern "C"
