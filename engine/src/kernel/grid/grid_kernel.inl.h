#pragma once
// A block over a grid of parameters; lanes = patches: each vector holds one coefficient of 4, 8 or 16 patches of a
// block. For each u the row curves q_j = sum_i f_i(u) c_ij stay in registers while v runs: r = sum_j g_j(v) q_j. The
// weights f, g are tabulated, so the same code evaluates Bernstein and power coefficients. One pass writes any subset
// of the outputs.
//
// Needs before it, outside of the instruction set's namespace: kernel/grid/grid_kernels.h, kernel/isa/lanes.h.

#include "kernel/sample/curvature_kernel.inl.h"
#include "kernel/store/line_stores.inl.h"

/// The places of one sample's outputs, for one vector of patches.
struct Offsets {
  std::ptrdiff_t vector, scalar, byte;
};

template <class L, class Stores>
[[gnu::always_inline]] inline void store_position(const GridJob<typename L::Scalar>& job, std::ptrdiff_t out,
                                                  const Sample<L>& sample, const Stores& stores) {
  typename L::Batch position[3];
  copy<L>(sample.position, position);
  if constexpr (sizeof(typename L::Scalar) == 8) {
    for (int c = 0; c < 3; ++c) position[c] = position[c] + L::broadcast(job.offset[c]);
  }
  stores.put(position_line, job.position + out, position);
}

/// Stores values where they are defined, and zero elsewhere.
template <class L>
class DefinedStore {
 public:
  using T = typename L::Scalar;
  using Stores = AskedStores<L>;

  DefinedStore(const Stores& stores, const typename L::Batch& defined) : stores_(stores), defined_(defined) {}
  [[gnu::always_inline]] void operator()(int line, T* memory, std::ptrdiff_t out,
                                         const typename L::Batch& value) const {
    const auto zero = L::broadcast(0);
    if (memory) stores_.put(line, memory + out, xsimd::select(defined_ > zero, value, zero));
  }
  [[gnu::always_inline]] void operator()(int line, T* memory, std::ptrdiff_t out, const typename L::Batch& x,
                                         const typename L::Batch& y, const typename L::Batch& z) const {
    if (!memory) return;
    (*this)(line, memory, out, x);
    (*this)(line + 1, memory, out + block_lanes, y);
    (*this)(line + 2, memory, out + 2 * block_lanes, z);
  }

 private:
  const Stores stores_;
  typename L::Batch defined_;
};

/// Stores principal curvatures and directions. Out of line, since it is much code.
template <class L>
[[gnu::noinline]] void store_principal(const GridJob<typename L::Scalar>& job, const Offsets& out,
                                       const CurvatureExchange<L>& exchange, const AskedStores<L>& stores) {
  Curvature<L> k;
  typename L::Batch normal[3];
  exchange.take(k, normal);
  const DefinedStore<L> put_defined(stores, k.defined);
  Principal<L> principal;
  principal_curvatures<L>(job, k, principal);
  put_defined(first_curvature_line, job.first_curvature, out.scalar, principal.first);
  put_defined(second_curvature_line, job.second_curvature, out.scalar, principal.second);
  if (job.curvature_kind)
    L::store_bytes(job.curvature_kind + out.byte,
                   xsimd::select(k.defined > L::broadcast(0), principal.umbilic, L::broadcast(undefined_curvatures)));
  if (!job.first_direction && !job.second_direction) return;
  typename L::Batch first[3], second[3];
  principal_directions<L>(k, normal, principal, first, second);
  put_defined(first_direction_line, job.first_direction, out.vector, first[0], first[1], first[2]);
  put_defined(second_direction_line, job.second_direction, out.vector, second[0], second[1], second[2]);
}

template <class L>
[[gnu::always_inline]] inline void store_curvatures(const GridJob<typename L::Scalar>& job, const Offsets& out,
                                                    const Sample<L>& sample, const Normal<L>& normal,
                                                    const AskedStores<L>& stores) {
  Curvature<L> k;
  curvature<L>(job, sample, normal, k);
  const DefinedStore<L> put_defined(stores, k.defined);
  put_defined(first_form_line, job.first_form, out.vector, k.e, k.f, k.g);
  put_defined(second_form_line, job.second_form, out.vector, k.l, k.m, k.n);
  put_defined(gaussian_line, job.gaussian, out.scalar, L::fms(k.s11, k.s22, k.s12 * k.s12));
  put_defined(mean_line, job.mean, out.scalar, mean_curvature<L>(k));
  if (job.first_curvature || job.second_curvature || job.curvature_kind || job.first_direction ||
      job.second_direction) {
    CurvatureExchange<L> exchange;
    exchange.put(k, normal.direction);
    store_principal<L>(job, out, exchange, stores);
  }
}

template <class T>
inline bool wants_curvatures(const GridJob<T>& job) {
  return job.first_form || job.second_form || job.gaussian || job.mean || job.first_curvature || job.second_curvature ||
         job.first_direction || job.second_direction || job.curvature_kind;
}

/// The outputs of a loop over samples: `any` asks the job, `mesh` is positions and normals only, of patches with one
/// degree in both directions.
enum class Wanted { any, mesh };

template <class L, int Order, Wanted Outputs, class Stores>
[[gnu::always_inline]] inline void store_derivatives(const GridJob<typename L::Scalar>& job, const Sample<L>& sample,
                                                     const Offsets& out, const Stores& stores) {
  if (Order == 0 || Outputs == Wanted::mesh || job.position) store_position<L>(job, out.vector, sample, stores);
  if constexpr (Order >= 1 && Outputs == Wanted::any) {
    if (job.du) stores.put(du_line, job.du + out.vector, sample.du);
    if (job.dv) stores.put(dv_line, job.dv + out.vector, sample.dv);
  }
  if constexpr (Order >= 2) {
    if (job.duu) stores.put(duu_line, job.duu + out.vector, sample.duu);
    if (job.duv) stores.put(duv_line, job.duv + out.vector, sample.duv);
    if (job.dvv) stores.put(dvv_line, job.dvv + out.vector, sample.dvv);
  }
}

template <class L, Wanted Outputs, class Stores>
[[gnu::always_inline]] inline void store_normal(const GridJob<typename L::Scalar>& job, const Normal<L>& normal,
                                                const Offsets& out, const Stores& stores) {
  if (Outputs == Wanted::mesh || job.normal) stores.put(normal_line, job.normal + out.vector, normal.direction);
  if (Outputs == Wanted::any && job.normal_kind) L::store_bytes(job.normal_kind + out.byte, normal.kind);
}

template <class T>
inline bool wants_normals(const GridJob<T>& job) {
  return job.normal || job.normal_kind;
}

template <class L, bool Rational, int Order, class Stores>
[[gnu::always_inline]] inline void store_sample(const GridJob<typename L::Scalar>& job, const Sample<L>& sample,
                                                const Place& place, const Offsets& out, const Stores& stores) {
  store_derivatives<L, Order, Wanted::any>(job, sample, out, stores);
  if constexpr (Order >= 1) {
    const bool curvatures = Order >= 2 && wants_curvatures(job);
    if (!wants_normals(job) && !curvatures) return;
    Normal<L> normal;
    unit_normal<L, Rational>(job, sample, place, normal);
    store_normal<L, Wanted::any>(job, normal, out, stores);
    if constexpr (Order >= 2) {
      if (curvatures) store_curvatures<L>(job, out, sample, normal, stores.asked());
    }
  }
}

template <class L>
Offsets sample_before(const GridJob<typename L::Scalar>& job, const Offsets& next) {
  return {next.vector - job.vector_step, next.scalar - job.scalar_step, next.byte - block_lanes};
}

/// Computes the normals of the sample before the one whose outputs are `next`; its tangents are no longer known.
/// `exchange.kind` is 1 in the lanes that are safe.
template <class L>
[[gnu::noinline, gnu::cold]] void finish_degenerate(const GridJob<typename L::Scalar>& job, int lane, Offsets next,
                                                    NormalExchange<L>& exchange, const AskedStores<L>& stores) {
  const Offsets out = sample_before<L>(job, next);
  const int k = static_cast<int>(out.byte / block_lanes), columns = job.v_end - job.v_begin;
  const Place place{job.u_begin + k / columns, job.v_begin + k % columns, lane};
  Sample<L> sample;
  derive_again<L>(job, place, sample);
  put_tangents<L>(job.rational, sample, exchange);
  degenerate_normals<L>(job, place, L::load(exchange.kind), exchange);
  Normal<L> normal;
  take_normal<L>(exchange, normal);
  store_normal<L, Wanted::any>(job, normal, out, stores);
}

/// Normals of grids. Each is finished after the next sample's is begun: the chain of operations from r_u x r_v to a
/// unit normal is long, and so runs beside the next sample's sums.
template <class L, Wanted Outputs>
class DeferredNormals {
 public:
  using Job = GridJob<typename L::Scalar>;

  /// Begins the normal of the sample with the outputs `out`.
  template <class Stores>
  [[gnu::always_inline]] void begin(const Job& job, const Sample<L>& sample, int lane, const Offsets& out,
                                    const Stores& stores) {
    if (Outputs == Wanted::any && !wants_normals(job)) return;
    typename L::Batch direction[3];
    const auto squared = cross<L>(sample.du, sample.dv, direction);
    finish(job, lane, out, stores);
    copy<L>(direction, direction_);
    squared_ = squared;
  }
  /// Finishes the sample before the one whose outputs are `next`, if there is one.
  template <class Stores>
  [[gnu::always_inline]] void finish(const Job& job, int lane, const Offsets& next, const Stores& stores) const {
    if (next.byte < block_lanes || (Outputs == Wanted::any && !wants_normals(job))) return;
    Normal<L> normal;
    copy<L>(direction_, normal.direction);
    normal.squared = squared_;
    const auto safe = regular_normals<L>(job, lane, normal);
    if (xsimd::all(safe)) {
      store_normal<L, Outputs>(job, normal, sample_before<L>(job, next), stores);
    } else {
      NormalExchange<L> exchange;
      for (int c = 0; c < 3; ++c) L::store(exchange.direction[c], normal.direction[c]);
      L::store(exchange.kind, xsimd::select(safe, L::broadcast(1), L::broadcast(0)));
      finish_degenerate<L>(job, lane, next, exchange, stores.asked());
    }
  }

 private:
  typename L::Batch squared_ = L::broadcast(0), direction_[3] = {squared_, squared_, squared_};
};

/// Prefetches `count` lines from line `first` on.
template <class T>
[[gnu::always_inline]] inline void prefetch_lines(const T* memory, int first, int count) {
  const char* line = reinterpret_cast<const char*>(memory) + std::ptrdiff_t{first} * 64;
  for (int k = 0; k < count; ++k) __builtin_prefetch(line + std::ptrdiff_t{k} * 64);
}

/// Evaluates `Groups` neighbouring vectors of patches, from `lane`, over the job's part of the grid. DegreeV 0 reads
/// the degree from the job.
template <class L, bool ByLane, int DegreeV, bool Rational, int Order, Way How, int Groups, Wanted Outputs>
void evaluate_lanes(const GridJob<typename L::Scalar>& job, int lane) {
  constexpr int components = Rational ? 4 : 3;
  constexpr int capacity = DegreeV > 0 ? DegreeV + 1 : max_order;
  constexpr bool constant = How == Way::streaming && line_parts < L >> 1;
  const int count_u = Outputs == Wanted::mesh ? DegreeV + 1 : job.degree_u + 1;
  const int count_v = DegreeV > 0 ? DegreeV + 1 : job.degree_v + 1;
  Offsets out{lane, lane, lane};

  const auto* next_net = job.net + std::ptrdiff_t{count_u} * count_v * components * block_lanes;
  RowCurves<L, Order, components, capacity> curves[Groups];
  DeferredNormals<L, Outputs> normals[Groups];
  WaitingLines<L, How> waiting;
  for (int iu = job.u_begin; iu < job.u_end; ++iu) {
    if (lane == 0) prefetch_lines(next_net, iu * job.prefetched_lines, job.prefetched_lines);
    for (int group = 0; group < Groups; ++group) {
      const int first = lane + group * L::width;
      const auto u_weights = weights_at<L, ByLane>(job.u_weights, iu, count_u, first);
      row_curves<L, DegreeV>(job.net + first, u_weights, count_u, count_v, curves[group]);
    }
    for (int iv = job.v_begin; iv < job.v_end; ++iv) {
      for_each_group<Groups, constant>([&](auto group) __attribute__((always_inline)) {
        const std::ptrdiff_t shift = group * L::width;
        const int first = lane + group * L::width;
        const auto v_weights = weights_at<L, ByLane>(job.v_weights, iv, count_v, first);
        Sample<L> sample;
        evaluate_sample<L, Order>(curves[group], v_weights, count_v, sample);
        const Offsets at{out.vector + shift, out.scalar + shift, out.byte + shift};
        const LineStores<L, How, decltype(group)> stores(job.streaming, waiting.line, group);
        if constexpr (Order == 1) {
          store_derivatives<L, Order, Outputs>(job, sample, at, stores);
          normals[group].begin(job, sample, first, at, stores);
        } else {
          store_sample<L, Rational, Order>(job, sample, {iu, iv, first}, at, stores);
        }
      });
      out = {out.vector + job.vector_step, out.scalar + job.scalar_step, out.byte + block_lanes};
    }
  }
  if constexpr (Order == 1)
    for (int group = 0; group < Groups; ++group) {
      const int shift = group * L::width;
      const Offsets end{out.vector + shift, out.scalar + shift, out.byte + shift};
      const LineStores<L, How, int> stores(job.streaming, waiting.line, group);
      normals[group].finish(job, lane + shift, end, stores);
    }
}

/// Plain stores take one vector of patches at a time. Streaming stores take a whole cache line at a time, or two
/// vectors of a whole line each, since lines of a block that are left out cost as much as others. Both share one loop
/// where it is much code: for any degree, and for second derivatives.
template <class L, int DegreeV, bool Rational, int Order, Wanted Outputs = Wanted::any>
void evaluate_block(const GridJob<typename L::Scalar>& job) {
  constexpr int line = 64 / static_cast<int>(sizeof(typename L::Scalar));
  constexpr int streamed = L::width < line ? line : 2 * line < block_lanes ? 2 * line : block_lanes;
  if constexpr (DegreeV == 0 || Order == 2) {
    for (int lane = 0; lane < block_lanes; lane += streamed)
      if (lane < job.lane_count)
        evaluate_lanes<L, false, DegreeV, Rational, Order, Way::asked, streamed / L::width, Outputs>(job, lane);
  } else if (job.streaming) {
    for (int lane = 0; lane < block_lanes; lane += streamed)
      evaluate_lanes<L, false, DegreeV, Rational, Order, Way::streaming, streamed / L::width, Outputs>(job, lane);
  } else {
    for (int lane = 0; lane < block_lanes; lane += L::width)
      if (lane < job.lane_count) evaluate_lanes<L, false, DegreeV, Rational, Order, Way::plain, 1, Outputs>(job, lane);
  }
}

/// One loop serves all degrees, and always computes first derivatives: such grids are rare.
template <class L, int Order>
void evaluate_by_lane(const GridJob<typename L::Scalar>& job) {
  for (int lane = 0; lane < job.lane_count; lane += L::width)
    job.rational ? evaluate_lanes<L, true, 0, true, Order, Way::plain, 1, Wanted::any>(job, lane)
                 : evaluate_lanes<L, true, 0, false, Order, Way::plain, 1, Wanted::any>(job, lane);
}

/// Degrees are fixed where it pays: the loop over any degree is within 15% except for positions of low degree. Rational
/// second derivatives are as much code as all the rest.
template <class L, int DegreeV, bool Rational, int Order>
inline constexpr bool is_fixed =
    DegreeV == 3 ? !Rational || Order < 2 : Order < 2 && (!Rational || sizeof(typename L::Scalar) == 4);

template <class L, int DegreeV, int Order>
void choose_weights(const GridJob<typename L::Scalar>& job) {
  constexpr int polynomial = is_fixed<L, DegreeV, false, Order> ? DegreeV : 0;
  constexpr int rational = is_fixed<L, DegreeV, true, Order> ? DegreeV : 0;
  job.rational ? evaluate_block<L, rational, true, Order>(job) : evaluate_block<L, polynomial, false, Order>(job);
}

template <class T>
inline int order_of(const GridJob<T>& job) {
  if (job.duu || job.duv || job.dvv || wants_curvatures(job)) return 2;
  return job.du || job.dv || job.normal || job.normal_kind ? 1 : 0;
}

/// Whether a job is what Wanted::mesh writes, and no output more.
template <class T>
inline bool is_bicubic_mesh(const GridJob<T>& job) {
  return job.degree_u == 3 && job.degree_v == 3 && !job.rational && job.position && job.normal && order_of(job) == 1 &&
         !job.du && !job.dv && !job.normal_kind;
}

template <class L, int DegreeV>
void choose_order(const GridJob<typename L::Scalar>& job) {
  const int order = order_of(job);
  if (order == 2) {
    choose_weights<L, DegreeV, 2>(job);
  } else if (order == 1) {
    choose_weights<L, DegreeV, 1>(job);
  } else {
    choose_weights<L, DegreeV, 0>(job);
  }
}

template <class L>
Isa evaluate_grid(const GridJob<typename L::Scalar>& job) {
  if (job.by_lane) {
    order_of(job) == 2 ? evaluate_by_lane<L, 2>(job) : evaluate_by_lane<L, 1>(job);
  } else if (sizeof(typename L::Scalar) == 4 && is_bicubic_mesh(job)) {
    evaluate_block<L, 3, false, 1, Wanted::mesh>(job);
  } else if (job.degree_v == 1) {
    choose_order<L, 1>(job);
  } else if (job.degree_v == 2) {
    choose_order<L, 2>(job);
  } else if (job.degree_v == 3) {
    choose_order<L, 3>(job);
  } else {
    choose_order<L, 0>(job);
  }
  return this_isa;
}
