#include <algorithm>
#include <cmath>
#include <string>

#include "base/impl_access.h"
#include "base/text.h"
#include "basis/bernstein.h"
#include "basis/power.h"
#include "block/patch_set_impl.h"
#include "eval/flat_grid.h"
#include "eval/grid_plan_impl.h"
#include "eval/quantity_table.h"
#include "kernel/table/kernel_table.h"
#include "tessera/guard.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Values, first and second derivatives of one basis, computed in long double and rounded once: put(k, value) for k
/// from 0 to 3 (degree + 1) - 1.
template <class T, class Put>
void tabulate(int degree, long double t, Representation representation, Put&& put) {
  std::array<long double, max_degree + 1> values{}, derivatives{}, second{};
  if (representation == Representation::bernstein) {
    bernstein_values(degree, t, values.data());
    bernstein_derivatives(degree, t, derivatives.data());
    bernstein_second_derivatives(degree, t, second.data());
  } else {
    power_values(degree, t, values.data());
    power_derivatives(degree, t, derivatives.data());
    power_second_derivatives(degree, t, second.data());
  }
  std::size_t k = 0;
  for (const auto* row : {&values, &derivatives, &second})
    for (int i = 0; i <= degree; ++i) put(k++, static_cast<T>((*row)[static_cast<std::size_t>(i)]));
}

template <class T>
void tabulate_degree(int degree, std::span<const double> parameters, const GridPlan::Impl& plan,
                     AlignedVector<T>& table) {
  if (!table.empty()) return;
  table.reserve(parameters.size() * 3 * static_cast<std::size_t>(degree + 1));
  for (const double t : parameters)
    tabulate<T>(degree, t, plan.options.representation, [&](std::size_t, T value) { table.push_back(value); });
}

/// Tabulates for each lane the parameters of its own patch, `count` of them.
template <class T>
void tabulate_blocks(const PatchSet::Impl& set, std::span<const double> parameters, std::size_t count,
                     int BlockGroup::*degree, Representation representation, LaneTables<T>& tables) {
  const auto row = [&](std::size_t block) {
    return 3 * static_cast<std::size_t>(set.group_of_block(block).*degree + 1);
  };
  std::size_t values = 0;
  for (std::size_t block = 0; block < set.lane_counts.size(); ++block) {
    tables.first.push_back(values);
    values += count * row(block) * PatchSet::lanes;
  }
  tables.values.resize(values);
  for (std::size_t block = 0; block < set.lane_counts.size(); ++block)
    for (std::size_t lane = 0; lane < PatchSet::lanes; ++lane) {
      const std::size_t patch = set.lane_patches[block * PatchSet::lanes + lane];
      for (std::size_t k = 0; k < count; ++k) {
        T* out = tables.values.data() + tables.first[block] + k * row(block) * PatchSet::lanes + lane;
        tabulate<T>(set.group_of_block(block).*degree, parameters[patch * count + k], representation,
                    [&](std::size_t i, T value) { out[i * PatchSet::lanes] = value; });
      }
    }
}

template <class T>
void tabulate_set(const PatchSet::Impl& set, const GridPlan::Impl& plan, GridWeights<T>& weights) {
  if (plan.by_patch) {
    const Representation representation = plan.options.representation;
    tabulate_blocks(set, plan.u, plan.count_u, &BlockGroup::degree_u, representation, weights.u_lanes);
    tabulate_blocks(set, plan.v, plan.count_v, &BlockGroup::degree_v, representation, weights.v_lanes);
    return;
  }
  for (const BlockGroup& group : set.groups) {
    auto& along_u = weights.u[static_cast<std::size_t>(group.degree_u)];
    auto& along_v = weights.v[static_cast<std::size_t>(group.degree_v)];
    tabulate_degree(group.degree_u, plan.u, plan, along_u);
    if (group.degree_u == group.degree_v && plan.u == plan.v && along_v.empty()) along_v = along_u;
    tabulate_degree(group.degree_v, plan.v, plan, along_v);
  }
}

/// Parameters that are finite and in [0, 1].
Status check_values(std::span<const double> parameters, const char* direction) {
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const double t = parameters[k];
    const auto place = [&] {
      return std::string("parameter ") + direction + "[" + std::to_string(k) + "] = " + text(t);
    };
    if (!std::isfinite(t))
      return Status(StatusCode::non_finite, place() + " is not finite", static_cast<std::ptrdiff_t>(k));
    if (t < 0 || t > 1)
      return Status(StatusCode::invalid_argument, place() + " is outside [0, 1]", static_cast<std::ptrdiff_t>(k));
  }
  return {};
}

Status check_count(std::size_t count, const char* direction) {
  if (count >= 1 && count <= (1u << 24)) return {};
  return Status(StatusCode::invalid_argument,
                std::string("a grid needs 1 to 2^24 parameters along ") + direction + ", not " + std::to_string(count));
}

Status check_lists(std::span<const double> parameters, std::size_t patches, const char* direction) {
  if (parameters.size() % patches == 0) return check_count(parameters.size() / patches, direction);
  return Status(StatusCode::invalid_argument, "the number of parameters along " + std::string(direction) + ", " +
                                                  std::to_string(parameters.size()) + ", must be a multiple of the " +
                                                  counted(patches, "patch", "patches"));
}

/// Checks that the bytes of every output can be counted.
Status check_size(const PatchSet::Impl& set, std::size_t count_u, std::size_t count_v) {
  const double bytes = static_cast<double>(set.lane_counts.size()) * PatchSet::lanes * 3 * sizeof(double) *
                       static_cast<double>(count_u) * static_cast<double>(count_v);
  if (bytes < 0x1p62) return {};
  return Status(StatusCode::invalid_argument, "a grid of " + std::to_string(count_u) + " x " + std::to_string(count_v) +
                                                  " parameters over " + std::to_string(set.patches.size()) +
                                                  " patches has more points than memory can address");
}

std::uint8_t edge_of(double t) { return t == 0 ? kernel::edge_start : t == 1 ? kernel::edge_end : kernel::edge_inside; }

std::vector<std::uint8_t> edges_of(std::span<const double> parameters, std::size_t count, bool by_patch,
                                   const PatchSet::Impl& set) {
  std::vector<std::uint8_t> edges;
  if (!by_patch) {
    edges.reserve(count);
    for (const double t : parameters) edges.push_back(edge_of(t));
    return edges;
  }
  edges.reserve(set.lane_patches.size() * count);
  for (std::size_t block = 0; block < set.lane_counts.size(); ++block)
    for (std::size_t k = 0; k < count; ++k)
      for (std::size_t lane = 0; lane < PatchSet::lanes; ++lane)
        edges.push_back(edge_of(parameters[set.lane_patches[block * PatchSet::lanes + lane] * count + k]));
  return edges;
}

void find_edges(const PatchSet::Impl& set, GridPlan::Impl& plan) {
  plan.u_edges = edges_of(plan.u, plan.count_u, plan.by_patch, set);
  plan.v_edges = edges_of(plan.v, plan.count_v, plan.by_patch, set);
  if (std::ranges::count(plan.u_edges, kernel::edge_start) > 0) plan.edges.add(Side::u0);
  if (std::ranges::count(plan.u_edges, kernel::edge_end) > 0) plan.edges.add(Side::u1);
  if (std::ranges::count(plan.v_edges, kernel::edge_start) > 0) plan.edges.add(Side::v0);
  if (std::ranges::count(plan.v_edges, kernel::edge_end) > 0) plan.edges.add(Side::v1);
}

Status check_geometry(const LocalGeometryOptions& options) {
  const std::pair<const char*, double> figures[] = {{"min_sine", options.min_sine},
                                                    {"umbilic_tolerance", options.umbilic_tolerance}};
  for (const auto& [what, value] : figures)
    if (!(value >= 0 && value < 1))
      return Status(StatusCode::invalid_argument, std::string(what) + " must lie in [0, 1), not " + text(value));
  return {};
}

/// Returns lane operations per point, as GridPlan::work() counts them: fused multiply-adds and the like, one per lane.
///
/// The figures of a bicubic polynomial patch. A sum over 4 coefficients of 3 components takes 12 operations. The rows
/// of u are shared by all points of a row and do not count.
/// - positions: one sum: 12
/// - du and dv: two sums more: 36
/// - the normal: 9 for the cross product, 3 for the squared length, 2 for the root and the check: 50
/// - second derivatives: three sums more: 72
/// Sums grow with the order, so figures of other degrees are in proportion. A rational patch has a fourth component,
/// and divides: 4/3 and 4 more. Curvatures take 30 more (forms 6 x 3, then 12 for their quotients), and the normal
/// besides second derivatives its 14.
double operations_per_point(const PlannedGroup& group, const QuantityFlags& outputs) {
  const bool second = outputs.duu || outputs.duv || outputs.dvv;
  const bool curvatures = outputs.first_form || outputs.second_form || outputs.gaussian || outputs.mean ||
                          outputs.first_curvature || outputs.second_curvature || outputs.first_direction ||
                          outputs.second_direction || outputs.curvature_kind;
  const bool normal = outputs.normal || outputs.normal_kind;
  const double cubic = second || curvatures ? 72 : normal ? 50 : outputs.du || outputs.dv ? 36 : 12;
  const double order = 0.5 * (group.degree_u + group.degree_v) + 1;
  double operations = cubic * order / 4;
  if (group.rational) operations = operations * 4 / 3 + 4;
  if (curvatures) return operations + 30;
  return second && normal ? operations + 14 : operations;
}

}  // namespace

std::vector<double> uniform_parameters(int count) {
  std::vector<double> parameters(static_cast<std::size_t>(std::max(count, 2)));
  const double last = static_cast<double>(parameters.size() - 1);
  for (std::size_t k = 0; k < parameters.size(); ++k) parameters[k] = static_cast<double>(k) / last;
  return parameters;
}

namespace {

/// The error of a set without the blocks that a plan needs. Names the member of BlockKinds that makes them.
Status missing_blocks(const GridPlanOptions& options) {
  const bool is_double = options.precision == Precision::double_precision;
  const bool is_power = options.representation == Representation::power;
  if ((!is_double && options.precision != Precision::single_precision) ||
      (!is_power && options.representation != Representation::bernstein))
    return {StatusCode::unsupported, "the plan's precision and representation must be values of their enumerations"};
  const std::string number = is_double ? "double" : "float", basis = is_power ? "power" : "Bernstein";
  return {StatusCode::unsupported, "the plan needs " + basis + " blocks in " + number +
                                       ", the patch set has none; set BlockKinds::" + number + "_" +
                                       (is_power ? "power" : "bernstein") + " in PatchSetOptions::blocks"};
}

/// Completes a plan whose parameters are checked and counted.
Result<std::unique_ptr<GridPlan::Impl>> make_plan(const PatchSet::Impl& set, std::unique_ptr<GridPlan::Impl> plan) {
  const GridPlanOptions& options = plan->options;
  if (Status status = check_geometry(options.geometry); !status.ok()) return status;
  if (!set.has(options.precision, options.representation)) return missing_blocks(options);
  const Result<Isa> isa = usable_isa(options.isa);
  if (!isa) return isa.status();
  if (Status status = check_size(set, plan->count_u, plan->count_v); !status.ok()) return status;
  plan->isa = *isa;
  plan->patch_count = set.patches.size();
  plan->block_count = set.lane_counts.size();
  find_edges(set, *plan);
  for (const BlockGroup& group : set.groups) {
    std::size_t count = 0;
    for (std::size_t block = 0; block < group.block_count; ++block) count += set.lane_counts[group.first_block + block];
    plan->groups.push_back({group.degree_u, group.degree_v, group.rational, group.block_count, count});
  }
  if (options.precision == Precision::single_precision) {
    tabulate_set(set, *plan, plan->f32);
    tabulate_flat(set, *plan);
  } else {
    tabulate_set(set, *plan, plan->f64);
  }
  return plan;
}

}  // namespace

Result<GridPlan> GridPlan::make(const PatchSet& set, std::span<const double> u, std::span<const double> v,
                                const GridPlanOptions& options) {
  return guarded([&]() -> Result<GridPlan> {
    for (const auto& [parameters, direction] : {std::pair(u, "u"), std::pair(v, "v")}) {
      if (Status status = check_count(parameters.size(), direction); !status.ok()) return status;
      if (Status status = check_values(parameters, direction); !status.ok()) return status;
    }
    auto plan = std::make_unique<Impl>();
    plan->u.assign(u.begin(), u.end());
    plan->v.assign(v.begin(), v.end());
    plan->count_u = u.size();
    plan->count_v = v.size();
    plan->options = options;
    auto made = make_plan(impl_of(set), std::move(plan));
    if (!made) return made.status();
    return GridPlan(*std::move(made));
  });
}

Result<GridPlan> GridPlan::make(const PatchSet& set, const PatchParameters& parameters,
                                const GridPlanOptions& options) {
  return guarded([&]() -> Result<GridPlan> {
    const std::size_t patches = set.patch_count();
    for (const auto& [list, direction] : {std::pair(parameters.u, "u"), std::pair(parameters.v, "v")}) {
      if (Status status = check_lists(list, patches, direction); !status.ok()) return status;
      if (Status status = check_values(list, direction); !status.ok()) return status;
    }
    auto plan = std::make_unique<Impl>();
    plan->u.assign(parameters.u.begin(), parameters.u.end());
    plan->v.assign(parameters.v.begin(), parameters.v.end());
    plan->count_u = parameters.u.size() / patches;
    plan->count_v = parameters.v.size() / patches;
    plan->by_patch = true;
    plan->options = options;
    auto made = make_plan(impl_of(set), std::move(plan));
    if (!made) return made.status();
    return GridPlan(*std::move(made));
  });
}

GridPlan::GridPlan(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
GridPlan::GridPlan(GridPlan&&) noexcept = default;
GridPlan& GridPlan::operator=(GridPlan&&) noexcept = default;
GridPlan::~GridPlan() = default;

std::size_t GridPlan::count_u() const { return impl_->count_u; }
std::size_t GridPlan::count_v() const { return impl_->count_v; }
Isa GridPlan::isa() const { return impl_->isa; }
Precision GridPlan::precision() const { return impl_->options.precision; }
std::size_t GridPlan::capacity() const { return impl_->patch_count * impl_->samples(); }
std::size_t GridPlan::block_capacity() const { return impl_->block_count * impl_->samples() * 3 * PatchSet::lanes; }

Work GridPlan::work(const QuantityFlags& outputs) const {
  const bool is_double = impl_->options.precision == Precision::double_precision;
  const double value = is_double ? 8 : 4;
  double bytes = 0;
  for_each_value_quantity([&](const auto& quantity) { bytes += quantity.of(outputs) ? quantity.width * value : 0; });
  for_each_kind_quantity([&](const auto& quantity) { bytes += quantity.of(outputs) ? 1 : 0; });
  Work work;
  work.double_precision = is_double;
  for (const PlannedGroup& group : impl_->groups) {
    const double points = static_cast<double>(group.patches) * static_cast<double>(impl_->samples());
    work.lane_operations += points * operations_per_point(group, outputs);
    work.bytes_written += points * bytes;
    work.bytes_read += static_cast<double>(group.patches) * (group.degree_u + 1) * (group.degree_v + 1) *
                       (group.rational ? 4 : 3) * value;
  }
  return work;
}

}}  // namespace tessera::abi_0_1
