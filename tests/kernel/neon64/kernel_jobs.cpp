// Runs the kernels of one instruction set over jobs that are the same on every machine, and prints a line an output:
// its job, its name, and a hash of its bytes.
//   kernel_jobs ISA    exit status 2 where this machine lacks it

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <initializer_list>
#include <random>
#include <string>
#include <vector>

#include "base/aligned.h"
#include "kernel/table/kernel_table.h"

namespace tessera::kernel { namespace {

using Random = std::mt19937_64;

/// Uniform in [-1, 1), without a library's rounding.
double uniform(Random& random) { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; }

template <class T>
void print_hash(const std::string& job, const char* output, const T* values, std::size_t count) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(values);
  std::uint64_t hash = 14695981039346656037u;  // FNV-1a
  for (std::size_t k = 0; k < count * sizeof(T); ++k) hash = (hash ^ bytes[k]) * 1099511628211u;
  std::printf("%s %s %016llx\n", job.c_str(), output, static_cast<unsigned long long>(hash));
}

template <class T>
constexpr const char* type_name = sizeof(T) == 4 ? "float" : "double";

/// The Bernstein polynomials of a parameter with their first and second derivatives, `[order][i]`, by de Casteljau's
/// recurrence: only multiplications and additions.
template <class T>
void append_weights(int degree, double t, AlignedVector<T>& out) {
  std::vector<std::vector<double>> row{{1}};
  for (int n = 1; n <= degree; ++n) {
    std::vector<double> next(static_cast<std::size_t>(n) + 1);
    for (std::size_t i = 0; i < row.back().size(); ++i) {
      next[i] += (1 - t) * row.back()[i];
      next[i + 1] += t * row.back()[i];
    }
    row.push_back(next);
  }
  const auto value = [&](int n, int i) {
    return n < 0 || i < 0 || i > n ? 0 : row[static_cast<std::size_t>(n)][static_cast<std::size_t>(i)];
  };
  for (int i = 0; i <= degree; ++i) out.push_back(static_cast<T>(value(degree, i)));
  for (int i = 0; i <= degree; ++i)
    out.push_back(static_cast<T>(degree * (value(degree - 1, i - 1) - value(degree - 1, i))));
  for (int i = 0; i <= degree; ++i)
    out.push_back(static_cast<T>(degree * (degree - 1) *
                                 (value(degree - 2, i - 2) - 2 * value(degree - 2, i - 1) + value(degree - 2, i))));
}

/// The Bernstein polynomials of a parameter per lane, `[order][i][lane]`: odd lanes have half of t.
template <class T>
void append_lane_weights(int degree, double t, AlignedVector<T>& out) {
  AlignedVector<T> weights[2];
  append_weights(degree, t, weights[0]);
  append_weights(degree, t / 2, weights[1]);
  for (std::size_t k = 0; k < weights[0].size(); ++k)
    for (int lane = 0; lane < block_lanes; ++lane) out.push_back(weights[lane % 2][k]);
}

/// Stands in for the caller's part where kernels cannot decide: any function of the place will do.
template <class T>
int exact_normal(void*, int iu, int iv, int lane, T* normal) {
  normal[0] = static_cast<T>(iu);
  normal[1] = static_cast<T>(iv);
  normal[2] = static_cast<T>(lane);
  return 1;
}

struct Net {
  int degree_u, degree_v;
  bool rational;
  int exponent;    ///< of the size, as a power of 2
  bool collapsed;  ///< the edge v = 0 is one point, and lane 3 is a point, lane 5 a line
};

/// `[i][j][component][lane]`.
template <class T>
AlignedVector<T> coefficients(const Net& net, Random& random) {
  const int components = net.rational ? 4 : 3;
  AlignedVector<T> out;
  for (int i = 0; i <= net.degree_u; ++i)
    for (int j = 0; j <= net.degree_v; ++j)
      for (int c = 0; c < components; ++c)
        for (int lane = 0; lane < block_lanes; ++lane) {
          double x = c == 3 ? 1 : std::ldexp(uniform(random), net.exponent);
          if (net.collapsed && c < 3 && (lane == 3 || (lane % 2 == 0 && j == 0)))
            x = std::ldexp(0.25 * c + lane, net.exponent);
          if (net.collapsed && c < 3 && lane == 5) x = std::ldexp(0.5 * (i + j) * (c + 1), net.exponent);
          if (c == 3 && !net.collapsed) x = 1.5 + uniform(random);
          out.push_back(static_cast<T>(x));
        }
  return out;
}

template <class T>
struct Output {
  const char* name;
  T* GridJob<T>::*memory;
  int order;  ///< of the derivatives it takes
};
template <class T>
constexpr Output<T> vector_outputs[] = {{"position", &GridJob<T>::position, 0},
                                        {"du", &GridJob<T>::du, 1},
                                        {"dv", &GridJob<T>::dv, 1},
                                        {"normal", &GridJob<T>::normal, 1},
                                        {"duu", &GridJob<T>::duu, 2},
                                        {"duv", &GridJob<T>::duv, 2},
                                        {"dvv", &GridJob<T>::dvv, 2},
                                        {"first_form", &GridJob<T>::first_form, 2},
                                        {"second_form", &GridJob<T>::second_form, 2},
                                        {"first_direction", &GridJob<T>::first_direction, 2},
                                        {"second_direction", &GridJob<T>::second_direction, 2}};
template <class T>
constexpr Output<T> scalar_outputs[] = {{"gaussian", &GridJob<T>::gaussian, 2},
                                        {"mean", &GridJob<T>::mean, 2},
                                        {"first_curvature", &GridJob<T>::first_curvature, 2},
                                        {"second_curvature", &GridJob<T>::second_curvature, 2}};

/// A block over 3 x 4 parameters, as the memory of a job.
template <class T>
class GridInput {
 public:
  static constexpr int count_u = 3, count_v = 4;
  static constexpr std::size_t samples = count_u * count_v, vectors = samples * 3 * block_lanes,
                               scalars = samples * block_lanes;

  GridInput(const Net& net, bool by_lane) : net_(net), by_lane_(by_lane) {
    Random random(static_cast<std::uint64_t>(100 * net.degree_u + net.degree_v));
    block_ = coefficients<T>(net, random);
    const auto append = by_lane ? append_lane_weights<T> : append_weights<T>;
    for (const double t : {0.0, 0.3125, 1.0}) append(net.degree_u, t, u_weights_);
    for (const double t : {0.0, 0.1, 0.75, 1.0}) append(net.degree_v, t, v_weights_);
    for (int lane = 0; lane < block_lanes; ++lane) {
      const auto l = static_cast<std::size_t>(lane);
      noise_[l] = lane == 9 ? T(-1) : static_cast<T>(std::ldexp(lane == 7 ? 1.0 : 0x1p-20, net.exponent));
      threshold_[l] = noise_[l] * noise_[l];
      collapsed_[2 * block_lanes + l] = T(net.collapsed && lane % 2 == 0);
    }
    append_edges({edge_start, edge_inside, edge_end}, u_edges_);
    append_edges({edge_start, edge_inside, edge_inside, edge_end}, v_edges_);
  }

  /// A job without outputs. Refers to this object.
  GridJob<T> job() {
    GridJob<T> job;
    job.net = block_.data();
    job.degree_u = net_.degree_u;
    job.degree_v = net_.degree_v;
    job.rational = net_.rational;
    job.u_weights = u_weights_.data();
    job.v_weights = v_weights_.data();
    job.u_end = count_u;
    job.v_end = count_v;
    job.threshold = threshold_.data();
    job.noise = noise_.data();
    job.collapsed = net_.collapsed ? collapsed_.data() : nullptr;
    job.by_lane = by_lane_;
    job.u_edges = u_edges_.data();
    job.v_edges = v_edges_.data();
    job.exact_normal = exact_normal<T>;
    job.min_sine = T(1e-6);
    job.umbilic_tolerance = T(1e-4);
    job.offset[0] = T(0.1), job.offset[1] = T(-7.3), job.offset[2] = T(1e5);
    return job;
  }

 private:
  void append_edges(std::initializer_list<std::uint8_t> edges, std::vector<std::uint8_t>& out) const {
    for (const std::uint8_t edge : edges)
      for (int lane = 0; lane < (by_lane_ ? block_lanes : 1); ++lane)
        out.push_back(lane % 2 == 1 && edge == edge_end ? edge_inside : edge);  // half of 1 is no edge
  }

  Net net_;
  bool by_lane_;
  AlignedVector<T> block_, u_weights_, v_weights_;
  AlignedVector<T> threshold_ = AlignedVector<T>(block_lanes), noise_ = AlignedVector<T>(block_lanes);
  AlignedVector<T> collapsed_ = AlignedVector<T>(4 * block_lanes);
  std::vector<std::uint8_t> u_edges_, v_edges_;
};

std::string grid_name(const char* type, const Net& net, int order, bool streaming, bool by_lane) {
  return std::string("grid/") + type + "/" + std::to_string(net.degree_u) + "x" + std::to_string(net.degree_v) +
         (net.rational ? "/rational" : "/polynomial") + "/2^" + std::to_string(net.exponent) +
         (net.collapsed ? "/collapsed" : "") + "/order" + std::to_string(order) + (streaming ? "/streaming" : "") +
         (by_lane ? "/by lane" : "");
}

/// Runs a block with all outputs up to `order`, and prints their hashes.
template <class T>
void run_grid(const KernelTable& table, const Net& net, int order, bool streaming, bool by_lane = false) {
  constexpr std::size_t vectors = GridInput<T>::vectors, scalars = GridInput<T>::scalars;
  GridInput<T> input(net, by_lane);
  GridJob<T> job = input.job();
  job.streaming = streaming;
  std::vector<AlignedVector<T>> memory;
  memory.reserve(std::size(vector_outputs<T>) + std::size(scalar_outputs<T>));
  for (const auto& output : vector_outputs<T>)
    if (output.order <= order) job.*output.memory = memory.emplace_back(vectors).data();
  for (const auto& output : scalar_outputs<T>)
    if (output.order <= order) job.*output.memory = memory.emplace_back(scalars).data();
  AlignedVector<std::uint8_t> normal_kind(scalars), curvature_kind(scalars);
  if (order >= 1) job.normal_kind = normal_kind.data();
  if (order >= 2) job.curvature_kind = curvature_kind.data();
  if constexpr (sizeof(T) == 4) {
    table.grid_f32(job);
  } else {
    table.grid_f64(job);
  }

  const std::string name = grid_name(type_name<T>, net, order, streaming, by_lane);
  std::size_t next = 0;
  for (const auto& output : vector_outputs<T>)
    if (output.order <= order) print_hash(name, output.name, memory[next++].data(), vectors);
  for (const auto& output : scalar_outputs<T>)
    if (output.order <= order) print_hash(name, output.name, memory[next++].data(), scalars);
  if (order >= 1) print_hash(name, "normal_kind", normal_kind.data(), scalars);
  if (order >= 2) print_hash(name, "curvature_kind", curvature_kind.data(), scalars);
}

/// Runs a block's positions and normals into records of eight.
void run_records(const KernelTable& table, const Net& net) {
  GridInput<float> input(net, false);
  const GridJob<float> job = input.job();
  const std::size_t values = GridInput<float>::scalars / block_lanes * 8;
  AlignedVector<float> memory(block_lanes * values + 1);
  RecordJob records;
  for (std::size_t lane = 0; lane < block_lanes; ++lane) records.out[lane] = memory.data() + 1 + lane * values;
  table.grid_records_f32(job, records);
  print_hash("records/" + grid_name("float", net, 1, false, false), "values", memory.data(), memory.size());
}

template <class T>
void run_grids(const KernelTable& table) {
  const int degrees[][2] = {{1, 1}, {2, 2}, {3, 3}, {1, 3}, {3, 2}, {4, 4}, {5, 7}, {15, 15}};
  const int far = sizeof(T) == 4 ? 50 : 400;
  for (const auto& [degree_u, degree_v] : degrees)
    for (const bool rational : {false, true})
      for (const bool collapsed : {false, true})
        for (const int exponent : {-far, 0, far})
          for (int order = 0; order <= 2; ++order) {
            const Net net{degree_u, degree_v, rational, exponent, collapsed};
            for (const bool streaming : {false, true}) run_grid<T>(table, net, order, streaming);
            run_grid<T>(table, net, order, false, true);
            if (sizeof(T) == 4 && order == 1) run_records(table, net);
          }
}

void run_borders(const KernelTable& table) {
  constexpr int count = 5;
  for (const int degree : {1, 2, 3, 6, 15})
    for (const bool rational : {false, true}) {
      Random random(static_cast<std::uint64_t>(degree));
      const int components = rational ? 4 : 3;
      AlignedVector<float> control, weights, out(count * 3 * block_lanes);
      for (int k = 0; k < (degree + 1) * components * block_lanes; ++k)
        control.push_back(static_cast<float>(uniform(random) + (k / block_lanes % components == 3 ? 2 : 0)));
      for (int k = 0; k < count * (degree + 1); ++k) weights.push_back(static_cast<float>(1 + uniform(random)));
      BorderJob<float> job;
      job.control = control.data();
      job.control_step = components * block_lanes;
      job.degree = degree;
      job.rational = rational;
      job.weights = weights.data();
      job.count = count;
      job.position = out.data();
      table.border_f32(job);
      print_hash("border/" + std::to_string(degree) + (rational ? "/rational" : "/polynomial"), "position", out.data(),
                 out.size());
    }
}

template <class T>
void run_lines(void (*begin)(LineState<T>&, T* const*), void (*put)(const LineJob<T>&),
               void (*end)(const LineState<T>&, int, bool)) {
  for (const std::size_t count : {1u, 7u, 16u, 37u})
    for (const std::ptrdiff_t step : {16, 48}) {
      Random random(count);
      AlignedVector<T> rows((count + 16) * static_cast<std::size_t>(step)), out(block_lanes * (2 * count + 3));
      for (T& x : rows) x = static_cast<T>(uniform(random));
      T* lane[block_lanes];
      for (std::size_t l = 0; l < block_lanes; ++l) {
        const std::size_t same_as = l < 13 ? l : 0;
        lane[l] = out.data() + 1 + same_as * (2 * count + 1);
        for (std::size_t k = 0; k < rows.size(); k += block_lanes) rows[k + l] = rows[k + same_as];
      }
      LineState<T> state;
      begin(state, lane);
      for (int piece = 0; piece < 2; ++piece)
        put({&state, rows.data(), step, static_cast<std::ptrdiff_t>(count), 13, false});
      end(state, 13, false);
      print_hash(std::string("lines/") + type_name<T> + "/" + std::to_string(count) + "/" + std::to_string(step),
                 "values", out.data(), out.size());
    }
}

template <class T>
void run_blends(Isa (*blend)(const BlendJob<T>&)) {
  constexpr std::ptrdiff_t rows = 3, columns = 37, step = 48;
  Random random(5);
  AlignedVector<T> row_values(rows * 8), column_values(8 * step);
  for (T& x : row_values) x = static_cast<T>(uniform(random));
  for (T& x : column_values) x = static_cast<T>(uniform(random));
  for (const char* layout : {"packed", "arrays", "strided"}) {
    const bool arrays = layout[0] == 'a', strided = layout[0] == 's';
    AlignedVector<T> out(rows * columns * 5);
    BlendJob<T> job{row_values.data(), column_values.data(), step, rows, columns, {}, arrays ? 1 : strided ? 5 : 3};
    for (int c = 0; c < 3; ++c) job.out[c] = out.data() + (arrays ? c * rows * columns : c);
    blend(job);
    print_hash(std::string("blend/") + type_name<T>, layout, out.data(), out.size());
  }
}

int run(const char* isa) {
  for (const KernelTable* table : machine_kernels()) {
    if (name(table->isa) != isa) continue;
    run_grids<float>(*table);
    run_grids<double>(*table);
    run_borders(*table);
    run_lines<float>(table->begin_lines_f32, table->put_lines_f32, table->end_lines_f32);
    run_lines<double>(table->begin_lines_f64, table->put_lines_f64, table->end_lines_f64);
    run_blends<float>(table->blend_f32);
    run_blends<double>(table->blend_f64);
    return 0;
  }
  std::fprintf(stderr, "kernel_jobs: this machine lacks %s\n", isa);
  return 2;
}

}}  // namespace tessera::kernel

int main(int count, char** arguments) {
  if (count != 2) {
    std::fputs("usage: kernel_jobs ISA\n", stderr);
    return 1;
  }
  return tessera::kernel::run(arguments[1]);
}
