#include <algorithm>
#include <cmath>
#include <string>

#include "base/guard.h"
#include "basis/bernstein.h"
#include "basis/power.h"
#include "block/patch_set_impl.h"
#include "eval/grid_outputs.h"
#include "eval/grid_plan_impl.h"

namespace tessera {
namespace {

/// Values, first and second derivatives of one basis at each parameter, computed in long double and rounded once.
template <class T>
AlignedVector<T> tabulate(int degree, std::span<const double> parameters, Representation representation) {
  AlignedVector<T> table;
  table.reserve(parameters.size() * 3 * static_cast<std::size_t>(degree + 1));
  std::array<long double, max_degree + 1> values{}, derivatives{}, second{};
  for (const long double t : parameters) {
    if (representation == Representation::bernstein) {
      bernstein_values(degree, t, values.data());
      bernstein_derivatives(degree, t, derivatives.data());
      bernstein_second_derivatives(degree, t, second.data());
    } else {
      power_values(degree, t, values.data());
      power_derivatives(degree, t, derivatives.data());
      power_second_derivatives(degree, t, second.data());
    }
    for (const auto* row : {&values, &derivatives, &second})
      for (int i = 0; i <= degree; ++i) table.push_back(static_cast<T>((*row)[static_cast<std::size_t>(i)]));
  }
  return table;
}

template <class T>
void tabulate_group(const BlockGroup& group, const GridPlan::Impl& plan, GridWeights<T>& weights) {
  auto& u = weights.u[static_cast<std::size_t>(group.degree_u)];
  auto& v = weights.v[static_cast<std::size_t>(group.degree_v)];
  if (u.empty()) u = tabulate<T>(group.degree_u, plan.u, plan.options.representation);
  if (v.empty()) v = tabulate<T>(group.degree_v, plan.v, plan.options.representation);
}

Status check_parameters(std::span<const double> parameters, const char* direction) {
  if (parameters.empty() || parameters.size() > (1u << 24))
    return Status(StatusCode::invalid_argument, std::string("a grid needs 1 to 2^24 parameters along ") + direction +
                                                    ", not " + std::to_string(parameters.size()));
  for (std::size_t k = 0; k < parameters.size(); ++k) {
    const double t = parameters[k];
    const auto place = [&] {
      return std::string("parameter ") + direction + "[" + std::to_string(k) + "] = " + std::to_string(t);
    };
    if (!std::isfinite(t))
      return Status(StatusCode::non_finite, place() + " is not finite", static_cast<std::ptrdiff_t>(k));
    if (t < 0 || t > 1)
      return Status(StatusCode::invalid_argument, place() + " is outside [0, 1]", static_cast<std::ptrdiff_t>(k));
  }
  return {};
}

/// Records, values and bytes of every output must be countable.
Status check_size(const PatchSet& set, std::size_t count_u, std::size_t count_v) {
  const double bytes = static_cast<double>(set.block_count()) * PatchSet::lanes * 3 * sizeof(double) *
                       static_cast<double>(count_u) * static_cast<double>(count_v);
  if (bytes < 0x1p62) return {};
  return Status(StatusCode::invalid_argument, "a grid of " + std::to_string(count_u) + " x " + std::to_string(count_v) +
                                                  " parameters over " + std::to_string(set.patch_count()) +
                                                  " patches has more points than memory can address");
}

std::vector<std::uint8_t> edges_of(std::span<const double> parameters) {
  std::vector<std::uint8_t> edges;
  for (const double t : parameters)
    edges.push_back(t == 0 ? kernel::edge_start : t == 1 ? kernel::edge_end : kernel::edge_inside);
  return edges;
}

void find_edges(GridPlan::Impl& plan) {
  plan.u_edges = edges_of(plan.u);
  plan.v_edges = edges_of(plan.v);
  if (std::ranges::count(plan.u_edges, kernel::edge_start) > 0) plan.edges.add(Edge::u0);
  if (std::ranges::count(plan.u_edges, kernel::edge_end) > 0) plan.edges.add(Edge::u1);
  if (std::ranges::count(plan.v_edges, kernel::edge_start) > 0) plan.edges.add(Edge::v0);
  if (std::ranges::count(plan.v_edges, kernel::edge_end) > 0) plan.edges.add(Edge::v1);
}

Status check_geometry(const LocalGeometryOptions& options) {
  const std::pair<const char*, double> figures[] = {{"smallest sine", options.smallest_sine},
                                                    {"umbilic tolerance", options.umbilic_tolerance}};
  for (const auto& [what, value] : figures)
    if (!(value >= 0 && value < 1))
      return Status(StatusCode::invalid_argument,
                    std::string("the ") + what + " must lie from 0 to below 1, not " + std::to_string(value));
  return {};
}

/// Lane operations a point, as GridPlan::work counts them.
double operations_a_point(const PlannedGroup& group, const GridOutputs& outputs) {
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

Result<GridPlan> GridPlan::make(const PatchSet& set, std::span<const double> u, std::span<const double> v,
                                const GridPlanOptions& options) {
  return guarded([&]() -> Result<GridPlan> {
    if (Status status = check_parameters(u, "u"); !status.ok()) return status;
    if (Status status = check_parameters(v, "v"); !status.ok()) return status;
    if (Status status = check_geometry(options.geometry); !status.ok()) return status;
    const PatchSet::Impl& patches = set.impl();
    if (!patches.has(options.precision, options.representation))
      return Status(
          StatusCode::unsupported,
          "the patch set holds no blocks of the precision and representation asked for; see PatchSetOptions::blocks");
    const Result<Isa> isa = options.isa ? parse_isa(name(*options.isa)) : default_isa();
    if (!isa) return isa.status();

    if (Status status = check_size(set, u.size(), v.size()); !status.ok()) return status;
    auto plan = std::make_unique<Impl>();
    plan->u.assign(u.begin(), u.end());
    plan->v.assign(v.begin(), v.end());
    plan->options = options;
    plan->isa = *isa;
    plan->patch_count = set.patch_count();
    plan->block_count = set.block_count();
    find_edges(*plan);
    for (const BlockGroup& group : patches.groups) {
      std::size_t count = 0;
      for (std::size_t block = 0; block < group.block_count; ++block)
        count += patches.lane_counts[group.first_block + block];
      plan->groups.push_back({group.degree_u, group.degree_v, group.rational, group.block_count, count});
      if (options.precision == Precision::single_precision) {
        tabulate_group(group, *plan, plan->single);
      } else {
        tabulate_group(group, *plan, plan->twice);
      }
    }
    return GridPlan(std::move(plan));
  });
}

GridPlan::GridPlan(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
GridPlan::GridPlan(GridPlan&&) noexcept = default;
GridPlan& GridPlan::operator=(GridPlan&&) noexcept = default;
GridPlan::~GridPlan() = default;

std::size_t GridPlan::count_u() const { return impl_->u.size(); }
std::size_t GridPlan::count_v() const { return impl_->v.size(); }
Isa GridPlan::isa() const { return impl_->isa; }
Precision GridPlan::precision() const { return impl_->options.precision; }
std::size_t GridPlan::capacity() const { return impl_->patch_count * impl_->samples(); }
std::size_t GridPlan::block_capacity() const { return impl_->block_count * impl_->samples() * 3 * PatchSet::lanes; }

/// For a cubic 12 for positions, 36 with du and dv, 50 with the unit normal as well, 72 with second derivatives; in
/// proportion to the order; rational: 4/3 of it and 4 more; 30 for curvatures of all sorts.
Work GridPlan::work(const GridOutputs& outputs) const {
  const bool twice = impl_->options.precision == Precision::double_precision;
  const double value = twice ? 8 : 4;
  double bytes = 0;
  for_each_value_output<double>(
      [&](const auto& output) { bytes += outputs.*output.wanted ? output.width * value : 0; });
  for_each_kind_output<double>([&](const auto& output) { bytes += outputs.*output.wanted ? 1 : 0; });
  Work work;
  work.double_precision = twice;
  for (const PlannedGroup& group : impl_->groups) {
    const double points = static_cast<double>(group.patches) * static_cast<double>(impl_->samples());
    work.lane_operations += points * operations_a_point(group, outputs);
    work.bytes_written += points * bytes;
    work.bytes_read += static_cast<double>(group.patches) * (group.degree_u + 1) * (group.degree_v + 1) *
                       (group.rational ? 4 : 3) * value;
  }
  return work;
}

}  // namespace tessera
