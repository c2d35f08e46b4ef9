// libFuzzer: any calls through C, with any numbers, sizes, strides and handles, also released ones, must return in
// bounded time and memory, with a code and a sentence or with usable results. Only memory is what the call states: no
// interface of C can check that.

#include <fuzzer/FuzzedDataProvider.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <vector>

#include "tessera/tessera_c.h"
#include "tessera/tessera_c_queries.h"

namespace {

void require(bool holds) {
  if (!holds) std::abort();
}

class Program {
 public:
  explicit Program(FuzzedDataProvider& data) : data_(data) {}

  void run() {
    begin();
    for (int calls = 0; calls < 24 && data_.remaining_bytes() > 0; ++calls) call();
    for (void* const handle : handles_) (void)tsr_release(handle);  // some were released before
  }

 private:
  /// A model, a set and a scene that are sound, so that calls find some.
  void begin() {
    std::array<double, 48> points;
    for (std::size_t k = 0; k < 16; ++k) {
      const double u = static_cast<double>(k / 4), v = static_cast<double>(k % 4);
      points[3 * k] = u, points[3 * k + 1] = v, points[3 * k + 2] = u * v;
    }
    tsr_bspline surface{};
    surface.struct_size = sizeof surface, surface.points = points.data();
    surface.degree_u = surface.degree_v = 3, surface.count_u = surface.count_v = 4;
    tsr_model* model = nullptr;
    keep(tsr_model_new(&model, &surface, 1), model);
    tsr_set_options options;
    tsr_set_defaults(&options);
    options.flags = TSR_SET_POINTS | TSR_SET_DOUBLE;
    tsr_set* set = nullptr;
    keep(tsr_set_new(&set, model, &options, nullptr), set);
    tsr_scene* scene = nullptr;
    keep(tsr_scene_new(&scene, set, nullptr, nullptr), scene);
    require(scene != nullptr);
    std::memcpy(buffer_.data() + 4096, points.data(), sizeof points);
  }

  /// Takes the code of a call, which has a sentence if it failed.
  bool sound(tsr_status code) {
    if (code == TSR_OK) return true;
    require(code > 0 && code <= TSR_IN_USE && code != TSR_INTERNAL && code != TSR_OUT_OF_MEMORY);
    require(std::strlen(tsr_last_message(nullptr)) > 0);
    return false;
  }
  double number() {
    static constexpr double infinity = std::numeric_limits<double>::infinity();
    static constexpr double special[] = {0,    1,     -1,       1e-9,
                                         1e30, 1e300, infinity, std::numeric_limits<double>::quiet_NaN()};
    switch (data_.ConsumeIntegralInRange(0, 3)) {
      case 0:
        return special[data_.ConsumeIntegralInRange<std::size_t>(0, std::size(special) - 1)];
      case 1:
        return data_.ConsumeIntegralInRange(-8, 8) * 0.25;
      case 2:
        return data_.ConsumeFloatingPointInRange(0.0, 1.0);
      default:
        return data_.ConsumeFloatingPoint<double>();
    }
  }
  std::size_t size() { return data_.ConsumeBool() ? data_.ConsumeIntegralInRange<std::size_t>(0, 20) : 16; }
  template <class T>
  T sized() {
    T made{};
    made.struct_size = data_.ConsumeIntegralInRange(0, 15) == 0 ? data_.ConsumeIntegral<std::uint16_t>() : sizeof made;
    return made;
  }
  void* handle() {
    if (handles_.empty() || data_.ConsumeIntegralInRange(0, 15) == 0)
      return data_.ConsumeBool() ? nullptr : this;  // none, or no handle at all
    return handles_[data_.ConsumeIntegralInRange<std::size_t>(0, handles_.size() - 1)];
  }
  /// The latest handle of a kind, mostly.
  template <class T>
  T* of() {
    if (data_.ConsumeIntegralInRange(0, 7) == 0) return static_cast<T*>(handle());
    return static_cast<T*>(latest_[kind_of(static_cast<T*>(nullptr))]);
  }
  static std::size_t kind_of(const tsr_model*) { return 0; }
  static std::size_t kind_of(const tsr_set*) { return 1; }
  static std::size_t kind_of(const tsr_plan*) { return 2; }
  static std::size_t kind_of(const tsr_scene*) { return 3; }
  static std::size_t kind_of(const tsr_hits*) { return 4; }
  static std::size_t kind_of(const tsr_point_scene*) { return 5; }
  static std::size_t kind_of(const tsr_solid*) { return 6; }
  static std::size_t kind_of(const tsr_measures*) { return 7; }
  static std::size_t kind_of(const tsr_sections*) { return 8; }
  template <class T>
  void keep(tsr_status code, T* const& made) {  // a reference, since the call writes it
    require(sound(code) == (made != nullptr));
    if (made) handles_.push_back(made), latest_[kind_of(made)] = made;
  }
  /// A view of the buffer that stays inside, whatever the count and the strides.
  tsr_out out() {
    if (data_.ConsumeBool()) return {};
    const bool is_packed = data_.ConsumeBool();
    const std::int64_t record = is_packed ? 0 : data_.ConsumeIntegralInRange(-8, 64);
    return {buffer_.data() + 4096 + data_.ConsumeIntegralInRange(0, 8),
            data_.ConsumeIntegralInRange<std::size_t>(0, 64), record,
            is_packed ? 0 : data_.ConsumeIntegralInRange(-8, 32)};
  }
  tsr_in in() {
    const tsr_out view = out();
    return {view.data, view.count, view.record, view.component};
  }
  void fill() {
    for (std::size_t k = 0; k + 8 <= buffer_.size() && data_.remaining_bytes() > 8; k += 8) {
      const double value = number();
      std::memcpy(&buffer_[k], &value, 8);
    }
  }

  void call() {
    switch (data_.ConsumeIntegralInRange(0, 17)) {
      case 0:
        return make_model();
      case 1:
        return make_set();
      case 2:
        return make_plan();
      case 3:
        return make_scene();
      case 4:
        return edit();
      case 5:
        return evaluate();
      case 6:
        return trace();
      case 7:
        return describe();
      case 8:
        (void)sound(tsr_release(handle()));
        return;
      case 9:
        (void)sound(tsr_scene_refit(of<tsr_scene>(), nullptr));
        return;
      case 10: {
        tsr_model* joined = nullptr;
        const tsr_model* const model = of<tsr_model>();
        const double distance = number();
        return keep(tsr_model_join(&joined, model, distance), joined);
      }
      case 11:
        return check_mesh();
      case 12:
        return make_queries();
      case 13:
        return ask_points();
      case 14:
        return measure();
      case 15:
        return cut();
      default:
        return fill();
    }
  }

  void make_model() {
    std::array<tsr_bspline, 2> surfaces;
    for (tsr_bspline& surface : surfaces) {
      surface = sized<tsr_bspline>();
      surface.degree_u = data_.ConsumeIntegralInRange(-1, 16), surface.degree_v = data_.ConsumeIntegralInRange(1, 3);
      surface.count_u = data_.ConsumeBool() ? static_cast<std::size_t>(surface.degree_u + 1) : size();
      surface.count_v = data_.ConsumeBool() ? static_cast<std::size_t>(surface.degree_v + 1) : size();
      surface.knot_count_u = size(), surface.knot_count_v = size();
      const auto* const numbers = reinterpret_cast<const double*>(buffer_.data());
      if (data_.ConsumeIntegralInRange(0, 9)) surface.points = numbers;
      if (data_.ConsumeBool()) surface.weights = numbers + 1;
      if (data_.ConsumeBool()) surface.knots_u = numbers;
      if (data_.ConsumeBool()) surface.knots_v = numbers;
    }
    tsr_model* model = nullptr;
    keep(tsr_model_new(&model, surfaces.data(), data_.ConsumeIntegralInRange<std::size_t>(0, 2)), model);
  }
  void make_set() {
    tsr_set_options options = sized<tsr_set_options>();
    options.shape = data_.ConsumeIntegralInRange(-2, 1),
    options.flags = data_.ConsumeIntegralInRange<std::uint32_t>(0, 8);
    const tsr_model* const model = of<tsr_model>();
    tsr_set* set = nullptr;
    keep(tsr_set_new(&set, model, data_.ConsumeBool() ? &options : nullptr, nullptr), set);
  }
  void make_plan() {
    tsr_plan_options options;
    tsr_plan_defaults(&options);
    if (data_.ConsumeBool()) options.tolerance = number();
    if (data_.ConsumeBool()) options.angle = number();
    if (data_.ConsumeBool()) options.pixels = number();
    if (data_.ConsumeBool()) options.weld = number(), options.crease_angle = number(), options.max_gap = number();
    if (data_.ConsumeBool()) options.eye[0] = number(), options.target[0] = number(), options.extent = number();
    if (data_.ConsumeBool()) options.rate_u = data_.ConsumeIntegralInRange(-1, 20), options.rate_v = 3;
    options.flags = data_.ConsumeIntegral<std::uint8_t>();
    options.max_triangles = 5000;
    const tsr_set* const set = of<tsr_set>();
    tsr_plan* plan = nullptr;
    keep(tsr_plan_new(&plan, set, &options, nullptr), plan);
    if (plan) write(plan);
  }
  /// Writes a mesh to memory that is as large as stated, or refused.
  void write(tsr_plan* plan) {
    tsr_plan_info info{};
    info.struct_size = sizeof info;
    if (!sound(tsr_plan_describe(plan, &info))) return;
    const std::size_t vertices =
        info.vertices - data_.ConsumeIntegralInRange(0, 1) * std::min<std::size_t>(1, info.vertices);
    std::vector<float> positions(3 * vertices), normals(3 * vertices);
    std::vector<double> doubles(3 * vertices);
    std::vector<std::uint32_t> triangles(3 * info.triangles), quads(4 * info.quads);
    tsr_mesh mesh = sized<tsr_mesh>();
    mesh.position = {positions.data(), vertices, 0, 0};
    if (data_.ConsumeBool()) mesh.normal = {normals.data(), vertices, 0, 0};
    if (data_.ConsumeBool()) mesh.position_f64 = {doubles.data(), vertices, 0, 0};
    mesh.triangles = triangles.data(), mesh.triangle_count = info.triangles;
    if (info.quads > 0) mesh.quads = quads.data(), mesh.quad_count = info.quads;
    if (!sound(tsr_plan_write(plan, &mesh, nullptr))) return;
    tsr_mesh_report report{};
    report.struct_size = sizeof report;
    require(tsr_mesh_check(&mesh, &report) == TSR_OK);
    const std::uint32_t patch = data_.ConsumeIntegralInRange<std::uint32_t>(0, 2);
    std::int32_t topology = 0;
    const auto* const points = reinterpret_cast<const double*>(buffer_.data());
    (void)sound(tsr_plan_update(plan, &patch, data_.ConsumeIntegralInRange<std::size_t>(0, 1), points, size(), &mesh,
                                &topology, nullptr));
  }
  void make_scene() {
    tsr_scene_options options = sized<tsr_scene_options>();
    options.tolerance = number(), options.pieces = data_.ConsumeIntegralInRange(-1, 4);
    const tsr_set* const set = of<tsr_set>();
    tsr_scene* scene = nullptr;
    keep(tsr_scene_new(&scene, set, data_.ConsumeBool() ? &options : nullptr, nullptr), scene);
  }
  void edit() {
    const std::array<std::uint32_t, 2> patches{data_.ConsumeIntegralInRange<std::uint32_t>(0, 3), 0};
    tsr_set* const set = of<tsr_set>();
    const std::size_t count = data_.ConsumeIntegralInRange<std::size_t>(0, 2);
    (void)sound(tsr_set_edit(set, patches.data(), count, reinterpret_cast<const double*>(buffer_.data()), size()));
  }
  void evaluate() {
    tsr_jets jets = sized<tsr_jets>();
    jets.is_double = data_.ConsumeBool();
    jets.position = out(), jets.du = out(), jets.normal = out(), jets.mean = out(), jets.first_direction = out();
    const tsr_set* const set = of<tsr_set>();
    const double u = number(), v = number();
    if (data_.ConsumeBool()) {
      (void)sound(tsr_set_grid(set, &u, 1, &v, 1, &jets, nullptr));
      tsr_limits_info limits = sized<tsr_limits_info>();
      limits.float_operations_per_second = limits.double_operations_per_second = limits.store_bytes_per_second =
          number();
      double seconds = 0;
      (void)sound(tsr_set_grid_limit(set, size() % 64, size() % 64, &jets, &limits, &seconds));
    } else {
      const tsr_in surface = in(), at_u = in(), at_v = in();
      (void)sound(tsr_set_evaluate(set, &surface, &at_u, &at_v, &jets, nullptr));
    }
  }
  void trace() {
    tsr_rays rays = sized<tsr_rays>();
    rays.is_double = data_.ConsumeBool();
    rays.origin = in(), rays.direction = in(), rays.tfar = in(), rays.spawn_offset = in();
    tsr_hits_out hits = sized<tsr_hits_out>();
    hits.is_double = data_.ConsumeBool();
    hits.kind = out(), hits.t = out(), hits.uv = out(), hits.position = out(), hits.flags = out();
    const tsr_scene* const scene = of<tsr_scene>();
    if (data_.ConsumeBool()) {
      (void)sound(tsr_scene_closest(scene, &rays, &hits, nullptr));
      return;
    }
    tsr_hits* all = nullptr;
    keep(tsr_scene_all(&all, scene, &rays, nullptr), all);
    if (all) (void)sound(tsr_hits_read(all, nullptr, nullptr, &hits));
  }
  void describe() {
    void* const of = handle();
    tsr_model_info model = sized<tsr_model_info>();
    tsr_set_info set = sized<tsr_set_info>();
    tsr_scene_info scene = sized<tsr_scene_info>();
    tsr_patch_info patch = sized<tsr_patch_info>();
    (void)sound(tsr_model_describe(static_cast<tsr_model*>(of), &model));
    (void)sound(tsr_set_describe(static_cast<tsr_set*>(of), &set));
    (void)sound(tsr_scene_describe(static_cast<tsr_scene*>(of), &scene));
    (void)sound(tsr_set_patch(static_cast<tsr_set*>(of), size(), &patch, nullptr, nullptr));
    (void)tsr_model_text(static_cast<tsr_model*>(of), data_.ConsumeIntegralInRange(-1, 8), size());
  }
  void make_queries() {
    const tsr_set* const set = of<tsr_set>();
    tsr_point_scene* points = nullptr;
    keep(tsr_point_scene_new(&points, set, nullptr), points);
    const tsr_scene* const scene = of<tsr_scene>();
    tsr_solid* solid = nullptr;
    keep(tsr_solid_new(&solid, scene, nullptr), solid);
  }
  void ask_points() {
    tsr_query_points points = sized<tsr_query_points>();
    points.is_double = data_.ConsumeBool(), points.patches = data_.ConsumeIntegralInRange(-1, 4);
    points.position = in(), points.max_distance = in();
    tsr_nearest_out nearest = sized<tsr_nearest_out>();
    nearest.is_double = data_.ConsumeBool();
    nearest.kind = out(), nearest.distance = out(), nearest.uv = out(), nearest.normal = out();
    tsr_point_scene* const scene = of<tsr_point_scene>();
    (void)sound(tsr_point_scene_nearest(scene, &points, &nearest, nullptr));
    if (data_.ConsumeBool()) (void)sound(tsr_point_scene_refit(scene, nullptr));
    if (data_.ConsumeBool()) points.max_distance = {};
    tsr_sides_out sides = sized<tsr_sides_out>();
    sides.side = out(), sides.is_certified = out();
    const tsr_out numbers = out(), distances = out();
    const tsr_solid* const solid = of<tsr_solid>();
    (void)sound(tsr_solid_contains(solid, &points, &sides, nullptr));
    (void)sound(tsr_solid_winding_numbers(solid, &points, &numbers, nullptr));
    (void)sound(tsr_solid_distances(solid, scene, &points, &distances, nullptr));
  }
  void measure() {
    tsr_measure_options options = sized<tsr_measure_options>();
    options.accuracy = data_.ConsumeBool() ? 1e-3 : number();
    options.max_cells = data_.ConsumeIntegralInRange<std::uint64_t>(0, 64);
    options.flags = data_.ConsumeIntegralInRange<std::uint32_t>(0, 16);
    const tsr_model* const model = of<tsr_model>();
    tsr_measures* measures = nullptr;
    keep(tsr_measures_new(&measures, model, &options, nullptr), measures);
    tsr_area area = sized<tsr_area>();
    (void)sound(tsr_measures_area(of<tsr_measures>(), data_.ConsumeIntegralInRange(-2, 4), &area));
    tsr_body body = sized<tsr_body>();
    (void)sound(tsr_measures_body(of<tsr_measures>(), data_.ConsumeIntegralInRange(-2, 4), &body));
  }
  void cut() {
    const std::array<double, 3> normal{number(), number(), number()};
    const std::array<double, 2> offsets{number(), number()};
    tsr_section_options options;
    tsr_section_defaults(&options);
    options.max_points = 5000;
    if (data_.ConsumeBool()) options.tolerance = number(), options.max_gap = number(), options.contact = number();
    const tsr_set* const set = of<tsr_set>();
    tsr_sections* sections = nullptr;
    const std::size_t count = data_.ConsumeIntegralInRange<std::size_t>(0, 2);
    keep(tsr_sections_new(&sections, set, normal.data(), offsets.data(), count, &options, nullptr), sections);
  }
  void check_mesh() {
    tsr_mesh mesh = sized<tsr_mesh>();
    mesh.position = {buffer_.data(), data_.ConsumeIntegralInRange<std::size_t>(0, 64), 0, 0};
    mesh.triangles = reinterpret_cast<std::uint32_t*>(buffer_.data());
    mesh.triangle_count = size();
    tsr_mesh_report report = sized<tsr_mesh_report>();
    (void)sound(tsr_mesh_check(&mesh, &report));
  }

  FuzzedDataProvider& data_;
  std::vector<void*> handles_;
  std::array<void*, 9> latest_ = {};
  /// Views lie in its middle, so that no stride leaves it.
  alignas(8) std::array<unsigned char, 16384> buffer_ = {};
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  FuzzedDataProvider data(bytes, size);
  Program(data).run();
  return 0;
}
