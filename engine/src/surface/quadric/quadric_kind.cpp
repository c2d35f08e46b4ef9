#include "tessera/quadric.h"

namespace tessera { inline namespace abi_0_1 {

std::string_view name(QuadricKind kind) {
  switch (kind) {
    case QuadricKind::ellipsoid:
      return "ellipsoid";
    case QuadricKind::hyperboloid_one_sheet:
      return "hyperboloid of one sheet";
    case QuadricKind::hyperboloid_two_sheets:
      return "hyperboloid of two sheets";
    case QuadricKind::elliptic_cone:
      return "elliptic cone";
    case QuadricKind::elliptic_paraboloid:
      return "elliptic paraboloid";
    case QuadricKind::hyperbolic_paraboloid:
      return "hyperbolic paraboloid";
    case QuadricKind::elliptic_cylinder:
      return "elliptic cylinder";
    case QuadricKind::hyperbolic_cylinder:
      return "hyperbolic cylinder";
    case QuadricKind::parabolic_cylinder:
      return "parabolic cylinder";
    case QuadricKind::intersecting_planes:
      return "intersecting planes";
    case QuadricKind::parallel_planes:
      return "parallel planes";
    case QuadricKind::coincident_planes:
      return "coincident planes";
    case QuadricKind::plane:
      return "plane";
    case QuadricKind::line:
      return "line";
    case QuadricKind::point:
      return "point";
    case QuadricKind::imaginary_ellipsoid:
      return "imaginary ellipsoid";
    case QuadricKind::imaginary_cylinder:
      return "imaginary cylinder";
    case QuadricKind::imaginary_planes:
      return "imaginary planes";
    case QuadricKind::empty:
      return "empty";
  }
  return "unknown";
}

bool is_surface(QuadricKind kind) { return kind <= QuadricKind::plane; }

int sheet_count(QuadricKind kind) {
  switch (kind) {
    case QuadricKind::hyperboloid_two_sheets:
    case QuadricKind::hyperbolic_cylinder:
    case QuadricKind::intersecting_planes:
    case QuadricKind::parallel_planes:
      return 2;
    default:
      return is_surface(kind) ? 1 : 0;
  }
}

Quadric::Diagonal Quadric::diagonal() const {
  const Vec3 s{1 / (size_.x * size_.x), 1 / (size_.y * size_.y), 1 / (size_.z * size_.z)};
  switch (kind_) {
    case QuadricKind::ellipsoid:
      return {s, {}, -1};
    case QuadricKind::hyperboloid_one_sheet:
      return {{s.x, s.y, -s.z}, {}, -1};
    case QuadricKind::hyperboloid_two_sheets:
      return {{-s.x, -s.y, s.z}, {}, -1};
    case QuadricKind::elliptic_cone:
      return {{s.x, s.y, -1}, {}, 0};
    case QuadricKind::elliptic_paraboloid:
      return {{s.x, s.y, 0}, {0, 0, -1}, 0};
    case QuadricKind::hyperbolic_paraboloid:
      return {{s.x, -s.y, 0}, {0, 0, -1}, 0};
    case QuadricKind::elliptic_cylinder:
      return {{s.x, s.y, 0}, {}, -1};
    case QuadricKind::hyperbolic_cylinder:
      return {{s.x, -s.y, 0}, {}, -1};
    case QuadricKind::parabolic_cylinder:
      return {{s.x, 0, 0}, {0, 0, -1}, 0};
    case QuadricKind::intersecting_planes:
      return {{s.x, -s.y, 0}, {}, 0};
    case QuadricKind::parallel_planes:
      return {{s.x, 0, 0}, {}, -1};
    case QuadricKind::coincident_planes:
      return {{1, 0, 0}, {}, 0};
    case QuadricKind::plane:
      return {{}, {1, 0, 0}, 0};
    case QuadricKind::line:
      return {{s.x, s.y, 0}, {}, 0};
    case QuadricKind::point:
      return {s, {}, 0};
    case QuadricKind::imaginary_ellipsoid:
      return {s, {}, 1};
    case QuadricKind::imaginary_cylinder:
      return {{s.x, s.y, 0}, {}, 1};
    case QuadricKind::imaginary_planes:
      return {{s.x, 0, 0}, {}, 1};
    case QuadricKind::empty:
      break;
  }
  return {{}, {}, 1};
}

}}  // namespace tessera::abi_0_1
