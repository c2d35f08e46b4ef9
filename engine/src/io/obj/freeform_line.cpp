#include "io/obj/freeform_line.h"

#include <string>

#include "base/text.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

std::string values(const FreeformLine& line, char direction) {
  return std::string("parm ") + direction + " has " + counted(line.parm.size(), "value");
}

Status check_line_degree(FreeformType type, const FreeformLine& line, char direction) {
  if (type == FreeformType::cardinal) return {};  // cubic whatever deg says
  if (!line.degree) return {StatusCode::parse_error, std::string("there is no deg for ") + direction + " above"};
  if (*line.degree >= 1 && *line.degree <= max_degree) return {};
  return {StatusCode::unsupported_degree, std::string("the degree along ") + direction + " is " +
                                              std::to_string(*line.degree) + ", it must be 1 to " +
                                              std::to_string(max_degree)};
}

Status check_matrix(const FreeformLine& line, int degree, char direction) {
  if (!line.step) return {StatusCode::parse_error, std::string("there is no step for ") + direction + " above"};
  if (*line.step < 1)
    return {StatusCode::invalid_argument, std::string("the step along ") + direction + " is " +
                                              std::to_string(*line.step) + ", it must be at least 1"};
  const std::size_t wanted = static_cast<std::size_t>((degree + 1) * (degree + 1));
  if (line.matrix.empty()) return {StatusCode::parse_error, std::string("there is no bmat ") + direction + " above"};
  if (line.matrix.size() == wanted) return {};
  return {StatusCode::count_mismatch, std::string("bmat ") + direction + " has " + std::to_string(line.matrix.size()) +
                                          " entries, degree " + std::to_string(degree) + " needs " +
                                          std::to_string(wanted)};
}

Status check_increasing_parameters(const FreeformLine& line, char direction) {
  if (line.parm.size() < 2) return {StatusCode::count_mismatch, values(line, direction) + ", at least 2 are needed"};
  for (std::size_t k = 1; k < line.parm.size(); ++k)
    if (!(line.parm[k - 1] < line.parm[k]))
      return {StatusCode::invalid_argument, std::string("parm ") + direction + " does not increase: " +
                                                text(line.parm[k]) + " follows " + text(line.parm[k - 1])};
  return {};
}

/// (K - n) / s + 2 parameters for the points 0 to K.
Result<std::size_t> matrix_count(const FreeformLine& line, int degree, char direction, std::size_t available) {
  const std::size_t step = static_cast<std::size_t>(*line.step), further = line.parm.size() - 2;
  if (further > 0 && (step > available || further > available / step))
    return Status(StatusCode::count_mismatch, values(line, direction) + " and the step is " + std::to_string(step) +
                                                  ": they need more than the " + std::to_string(available) +
                                                  " control points found");
  return further * step + static_cast<std::size_t>(degree) + 1;
}

}  // namespace

int degree_of(FreeformType type, const FreeformLine& line) {
  return type == FreeformType::cardinal ? 3 : static_cast<int>(*line.degree);
}

Result<std::size_t> control_count(FreeformType type, const FreeformLine& line, char direction, std::size_t available) {
  if (type == FreeformType::none) return Status(StatusCode::parse_error, "there is no cstype above");
  if (Status status = check_line_degree(type, line, direction); !status.ok()) return status;
  if (line.parm.empty()) return Status(StatusCode::parse_error, std::string("parm ") + direction + " is missing");
  const int degree = degree_of(type, line);
  const std::size_t n = static_cast<std::size_t>(degree), parameters = line.parm.size();
  if (type == FreeformType::bspline) {
    if (parameters >= 2 * (n + 1)) return parameters - n - 1;
    return Status(StatusCode::count_mismatch, values(line, direction) + ", a B-spline of degree " +
                                                  std::to_string(degree) + " needs at least " +
                                                  std::to_string(2 * (n + 1)) + " knots");
  }
  if (type == FreeformType::bmatrix)
    if (Status status = check_matrix(line, degree, direction); !status.ok()) return status;
  if (Status status = check_increasing_parameters(line, direction); !status.ok()) return status;
  switch (type) {
    case FreeformType::bezier:
      return (parameters - 1) * n + 1;
    case FreeformType::cardinal:
      return parameters + 2;
    case FreeformType::taylor:
      return (parameters - 1) * (n + 1);
    default:
      return matrix_count(line, degree, direction, available);
  }
}

Status check_within(const FreeformLine& line, char direction, double from, double to) {
  const std::string range = "the range from " + text(from) + " to " + text(to) + " along " + direction;
  if (!(from < to)) return {StatusCode::invalid_argument, range + " is empty"};
  if (line.parm.front() <= from && to <= line.parm.back()) return {};
  return {StatusCode::invalid_argument, range + " exceeds parm " + direction + ", which runs from " +
                                            text(line.parm.front()) + " to " + text(line.parm.back())};
}

std::vector<double> bezier_knots(int degree, std::span<const double> parameters) {
  std::vector<double> knots;
  knots.reserve(parameters.size() * static_cast<std::size_t>(degree) + 2);
  knots.push_back(parameters.front());
  for (const double parameter : parameters) knots.insert(knots.end(), static_cast<std::size_t>(degree), parameter);
  knots.push_back(parameters.back());
  return knots;
}

Result<BasisMatrix> piece_basis(FreeformType type, const FreeformLine& line) {
  const int degree = degree_of(type, line);
  if (type == FreeformType::taylor) return BasisMatrix::power(degree);
  const std::size_t size = static_cast<std::size_t>(degree) + 1;
  std::vector<double> entries(size * size);  // a row of the file is one function, here one power
  for (std::size_t i = 0; i < size; ++i)
    for (std::size_t j = 0; j < size; ++j) entries[j * size + i] = line.matrix[i * size + j];
  return BasisMatrix::custom(degree, entries);
}

std::size_t piece_step(FreeformType type, const FreeformLine& line) {
  return type == FreeformType::taylor ? static_cast<std::size_t>(degree_of(type, line)) + 1
                                      : static_cast<std::size_t>(*line.step);
}

}}  // namespace tessera::abi_0_1
