// Sections of the C interface.

#include <span>
#include <vector>

#include "c/objects.h"
#include "c/records.h"

using namespace tessera;

namespace tessera { inline namespace abi_0_1 { namespace {

static_assert(static_cast<int>(PlaneLimit::below) == TSR_LIMIT_BELOW &&
              static_cast<int>(PlaneLimit::above) == TSR_LIMIT_ABOVE);

/// Views of all that tsr_sections_out names.
struct SectionViews {
  View1<std::uint64_t> first;
  View1<std::uint8_t> is_closed, bridges_gap, contact_is_tangent;
  View1<double> length, u, v;
  View3<double> position, contact_position;
  View1<std::uint32_t> patch, contact_patch, coplanar, unproven;
};

CStatus section_views(const tsr_sections_out& from, const Sections& sections, SectionViews& to) {
  const std::size_t polylines = sections.polylines.size(), points = sections.points.size();
  const std::size_t contacts = sections.contacts.size();
  constexpr auto size = static_cast<std::int64_t>(sizeof(double));
  CStatus status;
  const auto view = [&](const char* name, const tsr_out& out, std::size_t records, auto& of) {
    if (status.code == TSR_OK) status = output_of(name, out, records, of);
  };
  view("first", from.first, polylines + 1, to.first);
  view("is_closed", from.is_closed, polylines, to.is_closed);
  view("length", from.length, polylines, to.length);
  view("position", from.position, points, to.position);
  view("uv", component_of(from.uv, size, 0), points, to.u);
  view("uv", component_of(from.uv, size, 1), points, to.v);
  view("patch", from.patch, points, to.patch);
  view("bridges_gap", from.bridges_gap, points, to.bridges_gap);
  view("contact_position", from.contact_position, contacts, to.contact_position);
  view("contact_patch", from.contact_patch, contacts, to.contact_patch);
  view("contact_is_tangent", from.contact_is_tangent, contacts, to.contact_is_tangent);
  view("coplanar", from.coplanar, sections.coplanar.size(), to.coplanar);
  view("unproven", from.unproven, sections.unproven.size(), to.unproven);
  return status;
}

/// Writes a member of each record of a list.
template <class T, class Record, class Member>
void write_member(const View1<T>& view, const std::vector<Record>& from, Member Record::*member) {
  write_records(view, from.size(), [&](std::size_t k) { return from[k].*member; });
}
template <class Record>
void write_positions(const View3<double>& view, const std::vector<Record>& from) {
  if (view.empty()) return;
  for (std::size_t k = 0; k < from.size(); ++k) {
    const Vec3& at = from[k].position;
    view.at(k, 0) = at.x, view.at(k, 1) = at.y, view.at(k, 2) = at.z;
  }
}

void write_sections(const Sections& from, const SectionViews& to) {
  write_member(to.first, from.polylines, &SectionPolyline::first);
  if (!to.first.empty()) to.first.at(from.polylines.size(), 0) = from.points.size();
  write_member(to.is_closed, from.polylines, &SectionPolyline::closed);
  write_member(to.length, from.polylines, &SectionPolyline::length);
  write_positions(to.position, from.points);
  write_member(to.u, from.points, &SectionPoint::u), write_member(to.v, from.points, &SectionPoint::v);
  write_member(to.patch, from.points, &SectionPoint::patch);
  write_member(to.bridges_gap, from.points, &SectionPoint::bridges_gap);
  write_positions(to.contact_position, from.contacts);
  write_member(to.contact_patch, from.contacts, &SectionContact::patch);
  write_records(to.contact_is_tangent, from.contacts.size(),
                [&](std::size_t k) { return from.contacts[k].kind == SectionContact::Kind::tangent; });
  write_records(to.coplanar, from.coplanar.size(), [&](std::size_t k) { return from.coplanar[k]; });
  write_records(to.unproven, from.unproven.size(), [&](std::size_t k) { return from.unproven[k]; });
}

}}}  // namespace tessera::abi_0_1

extern "C" {

void tsr_section_defaults(tsr_section_options* options) {
  if (!options) return;
  *options = {.struct_size = sizeof *options,
              .tolerance = 0,
              .contact = -1,
              .max_gap = -1,
              .max_points = SectionOptions().max_points,
              .limit = TSR_LIMIT_AUTOMATIC,
              .reserved = 0};
}

tsr_status tsr_sections_new(tsr_sections** sections, const tsr_set* set, const double* normal, const double* offsets,
                            size_t count, const tsr_section_options* options, const tsr_run* run) {
  if (sections) *sections = nullptr;
  return c_call([&]() -> CStatus {
    if (!sections) return null_pointer("sections");
    const Held<CSet> of(set);
    if (!of) return of.error();
    if (!normal || (!offsets && count != 0)) return null_pointer(normal ? "offsets" : "normal");
    tsr_section_options own;
    tsr_section_defaults(&own);
    if (CStatus status = read_struct("tsr_section_options", options, own); status.code) return status;
    if (CStatus status = check_member("tsr_section_options", "limit", own.limit, TSR_LIMIT_ABOVE); status.code)
      return status;
    SectionOptions wanted{.limit = static_cast<PlaneLimit>(own.limit), .max_points = clamped_count(own.max_points)};
    if (own.tolerance != 0) wanted.tolerance = own.tolerance;
    if (!(own.contact < 0)) wanted.contact = own.contact;
    if (!(own.max_gap < 0)) wanted.max_gap = own.max_gap;
    const Reading reading(of->usage);
    if (!reading) return in_use(Object::Kind::set);
    return run_work(run, [&](const Execution& execution) -> CStatus {
      const std::span<const double> planes = offsets ? std::span(offsets, count) : std::span<const double>();
      Result<Sections> made = make_sections(of->set, {normal[0], normal[1], normal[2]}, planes, wanted, execution);
      if (!made) return made.status();
      return give(sections, std::make_shared<CSections>(*std::move(made)));
    });
  });
}

tsr_status tsr_sections_describe(const tsr_sections* sections, tsr_sections_info* info) {
  return c_call([&]() -> CStatus {
    const Held<CSections> of(sections);
    if (!of) return of.error();
    const Sections& from = of->sections;
    return write_struct("tsr_sections_info", info,
                        {0, from.planes.size(), from.polylines.size(), from.points.size(), from.contacts.size(),
                         from.coplanar.size(), from.unproven.size(), from.tolerance, from.contact_size});
  });
}

tsr_status tsr_sections_plane(const tsr_sections* sections, size_t plane, tsr_plane_section* section) {
  return c_call([&]() -> CStatus {
    const Held<CSections> of(sections);
    if (!of) return of.error();
    const std::vector<PlaneSection>& planes = of->sections.planes;
    if (plane >= planes.size())
      return bad("plane " + std::to_string(plane) + " is none, there are " + std::to_string(planes.size()));
    const PlaneSection& from = planes[plane];
    tsr_plane_section to{};
    to.offset = from.offset;
    to.first_polyline = from.first_polyline, to.polyline_count = from.polyline_count;
    to.first_contact = from.first_contact, to.contact_count = from.contact_count;
    to.first_coplanar = from.first_coplanar, to.coplanar_count = from.coplanar_count;
    to.open_count = from.open_count;
    to.length = from.length, to.bound = from.bound, to.largest_gap = from.largest_gap;
    to.limit = static_cast<std::int32_t>(from.limit);
    return write_struct("tsr_plane_section", section, to);
  });
}

tsr_status tsr_sections_read(const tsr_sections* sections, const tsr_sections_out* out) {
  return c_call([&]() -> CStatus {
    const Held<CSections> of(sections);
    if (!of) return of.error();
    if (!out) return null_pointer("out");
    tsr_sections_out to{};
    if (CStatus status = read_struct("tsr_sections_out", out, to); status.code) return status;
    SectionViews views;
    if (CStatus status = section_views(to, of->sections, views); status.code) return status;
    write_sections(of->sections, views);
    return {};
  });
}

}  // extern "C"
