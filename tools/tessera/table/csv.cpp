#include "table/csv.h"

#include <cmath>

#include "tessera/io.h"

namespace tessera::cli {
namespace {

std::string joined(const ColumnNames& names) {
  std::string text;
  for (const std::string_view name : names) text += (text.empty() ? "" : ",") + std::string(name);
  return text;
}

/// Takes `name` and the separator before the next name.
bool take_name(TextCursor& cursor, std::string_view name, bool first) {
  cursor.skip_blanks();
  if (!first && !cursor.take(',')) return false;
  cursor.skip_blanks();
  if (cursor.peek_token() != name) return false;
  cursor.skip(name);
  return true;
}

/// The columns that the header names, or none.
ColumnNames take_header(TextCursor& cursor, const ColumnNames& required, const ColumnNames& optional) {
  ColumnNames all = required;
  all.insert(all.end(), optional.begin(), optional.end());
  for (const ColumnNames& names : {all, required}) {
    TextCursor after = cursor;
    bool good = true;
    for (std::size_t k = 0; k < names.size() && good; ++k) good = take_name(after, names[k], k == 0);
    if (!good || !after.take_line_end()) continue;
    cursor = after;
    return names;
  }
  return {};
}

Status take_row(TextCursor& cursor, const std::string& columns, std::vector<double>& values) {
  for (std::size_t k = 0; k < values.size(); ++k) {
    cursor.skip_blanks();
    bool good = k == 0 || cursor.take(',');
    if (good) cursor.skip_blanks();
    good = good && cursor.take_number(values[k]);
    if (!good) return cursor.expected(std::to_string(values.size()) + " numbers (" + columns + ")");
  }
  if (!cursor.take_line_end())
    return cursor.expected("the end of the line after " + std::to_string(values.size()) + " numbers");
  return {};
}

std::string text_of(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

/// The fault of the ray; empty if it is valid.
std::string fault_of(const Ray& ray) {
  if (!is_finite(ray.origin)) return "the origin is not finite";
  if (!is_finite(ray.direction)) return "the direction is not finite";
  if (ray.direction == Vec3{}) return "the direction is zero";
  if (!(ray.tnear >= 0)) return "tnear is " + text_of(ray.tnear) + ", it must be at least 0";
  if (std::isinf(ray.tnear)) return "tnear is not finite";
  if (!(ray.tfar >= ray.tnear)) return "tfar is " + text_of(ray.tfar) + ", it must be at least tnear";
  if (!is_valid(ray)) return "the origin or the direction has a component beyond " + text_of(max_ray_component);
  return {};
}

}  // namespace

Status read_csv(const std::filesystem::path& path, const ColumnNames& required, const ColumnNames& optional,
                const std::function<Status(std::span<const double>, const TextCursor&)>& row) {
  const Result<std::string> text = read_file(path);
  if (!text) return text.status();
  const std::string name = path.string();
  TextCursor cursor(*text, name, {.separators = ","});
  cursor.skip_space();
  const ColumnNames columns = take_header(cursor, required, optional);
  if (columns.empty()) {
    const std::string more = optional.empty() ? "" : "[," + joined(optional) + "]";
    return cursor.expected("a header line " + joined(required) + more);
  }
  const std::string names = joined(columns);
  std::vector<double> values(columns.size());
  for (cursor.skip_space(); !cursor.at_end(); cursor.skip_space()) {
    const TextCursor place = cursor;
    Status status = take_row(cursor, names, values);
    if (status.ok()) status = row(values, place);
    if (!status.ok()) return status;
  }
  return {};
}

void write_field(OutputFile& out, std::string_view text) {
  if (text.find_first_of(",\"\r\n") == text.npos) return out.write(text);
  out.write('"');
  for (const char c : text) out.write(c == '"' ? "\"\"" : std::string_view(&c, 1));
  out.write('"');
}

Result<std::vector<Vec3>> read_points(const std::filesystem::path& path) {
  std::vector<Vec3> points;
  const Status status = read_csv(path, {"x", "y", "z"}, {}, [&](std::span<const double> row, const TextCursor& at) {
    const Vec3 point{row[0], row[1], row[2]};
    if (!is_finite(point))
      return at.failure("expected a finite point, found " + text_of(point.x) + "," + text_of(point.y) + "," +
                        text_of(point.z));
    points.push_back(point);
    return Status();
  });
  if (!status.ok()) return status;
  return points;
}

Result<std::vector<SurfacePlace>> read_places(const std::filesystem::path& path, const Model& model) {
  std::vector<SurfacePlace> places;
  const Status status =
      read_csv(path, {"surface", "u", "v"}, {}, [&](std::span<const double> row, const TextCursor& at) {
        const double surface = row[0], u = row[1], v = row[2];
        if (!(surface >= 0 && surface < static_cast<double>(model.surfaces.size()) && surface == std::floor(surface))) {
          return at.failure("expected a surface from 0 to " + std::to_string(model.surfaces.size() - 1) + ", found " +
                            text_of(surface));
        }
        const Domain d = domain(model.surfaces[static_cast<std::size_t>(surface)].surface);
        if (!d.contains(u, v)) {
          return at.failure("expected u and v in the surface's domain [" + text_of(d.u0) + "," + text_of(d.u1) +
                            "] x [" + text_of(d.v0) + "," + text_of(d.v1) + "], found " + text_of(u) + "," +
                            text_of(v));
        }
        places.push_back({static_cast<std::uint32_t>(surface), u, v});
        return Status();
      });
  if (!status.ok()) return status;
  return places;
}

Result<std::vector<Ray>> read_rays(const std::filesystem::path& path) {
  std::vector<Ray> rays;
  const Status status = read_csv(path, {"ox", "oy", "oz", "dx", "dy", "dz"}, {"tnear", "tfar"},
                                 [&](std::span<const double> row, const TextCursor& at) {
                                   Ray ray{.origin = {row[0], row[1], row[2]}, .direction = {row[3], row[4], row[5]}};
                                   if (row.size() == 8) {
                                     ray.tnear = row[6];
                                     ray.tfar = row[7];
                                   }
                                   const std::string fault = fault_of(ray);
                                   if (!fault.empty()) return at.failure("a ray that is not valid: " + fault);
                                   rays.push_back(ray);
                                   return Status();
                                 });
  if (!status.ok()) return status;
  return rays;
}

}  // namespace tessera::cli
