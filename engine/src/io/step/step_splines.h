#pragma once
// Knots of the splines of a STEP file.

#include <cstddef>
#include <string_view>
#include <vector>

#include "io/step/step_entity.h"

namespace tessera { inline namespace abi_0_1 {

constexpr double max_angle = 1e4;  ///< radians from 0: far more than real files have, and not yet imprecise

/// Where the attributes of a spline begin: behind the name of a simple instance, or in the parts of a complex one.
struct SplineAttributes {
  std::size_t spline = 0, spline_at = 1;  ///< part of the degree, and the first attribute
  std::size_t knots = 0, knots_at = 0;    ///< part of the multiplicities, and their attribute
};
/// `family` is "CURVE" or "SURFACE". Returns whether the entity is a spline of it; says nothing about its parts.
bool is_step_spline(const StepEntity& entity, std::string_view family);
SplineAttributes spline_attributes(const StepEntity& entity, std::string_view family);

/// Returns the knots of a direction with each as often as its multiplicity says; fails the entity if it cannot.
///
/// - `direction`: 0, or 1 for the second one of a surface.
/// - `count`: of control points.
std::vector<double> step_knots(StepEntity& entity, std::string_view family, int degree, std::size_t count,
                               std::size_t direction);

/// Knots 0, 0, 1, .., count - 1, count - 1: of a line through `count` points.
std::vector<double> uniform_knots(std::size_t count);

/// Whether the degree is one that splines may have and has the points that it needs; fails the entity if not.
bool check_degree(StepEntity& entity, int degree, std::size_t count);

}}  // namespace tessera::abi_0_1
