// RIB, the RenderMan Interface Bytestream as text: Patch, PatchMesh, NuPatch and quadrics, their bases, trims and
// transformations, objects and their instances, archives (The RenderMan Interface Specification 3.2, sec. 4, 5 and
// appendix C). Points and transformations act on row vectors, as the Interface writes them; the model's space is the
// world as it is at WorldBegin, left-handed as the Interface's is, coordinates unchanged.

#include <algorithm>
#include <array>
#include <map>
#include <numbers>
#include <optional>

#include "io/file/make_room.h"
#include "io/file/passed_over.h"
#include "io/rib/rib_archives.h"
#include "io/rib/rib_lexer.h"
#include "io/rib/rib_quadrics.h"
#include "io/rib/rib_state.h"
#include "io/rib/rib_surfaces.h"
#include "io/rib/rib_tally.h"
#include "io/rib/rib_trims.h"
#include "tessera/guard.h"
#include "tessera/io.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Requests that draw shapes that are not read. All other requests say how, and from where, the scene is drawn.
constexpr std::string_view unread_requests[] = {"Polygon",         "GeneralPolygon",
                                                "PointsPolygons",  "PointsGeneralPolygons",
                                                "SubdivisionMesh", "HierarchicalSubdivisionMesh",
                                                "Curves",          "Points",
                                                "Blobby",          "Volume",
                                                "Geometry",        "Procedural",
                                                "Procedural2",     "ReadArchive"};
/// Requests that move later shapes in ways that are not read.
constexpr std::string_view other_transforms[] = {"Skew", "Perspective", "Deformation", "CoordSysTransform"};

template <class Names>
bool contains(const Names& names, std::string_view name) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

/// The surfaces between ObjectBegin and ObjectEnd.
using Object = std::vector<ModelSurface>;

class RibReader {
 public:
  RibReader(std::string_view text, std::string_view name)
      : name_(name),
        size_(text.size()),
        lexer_(text, name),
        start_(lexer_.place()),
        archives_(text, name),
        copies_left_(4 * text.size() + (1 << 20)) {}

  Result<Model> read() {
    while (!lexer_.at_end()) {
      const Status status = read_request();
      if (!status.ok()) return status;
    }
    if (model_.surfaces.empty()) return nothing_read();
    warn();
    return std::move(model_);
  }

 private:
  using Handler = Status (RibReader::*)();

  Status read_request() {
    start_ = lexer_.place();
    Status status = lexer_.take_request(request_);
    if (!status.ok()) return status;
    if (in_motion_ && request_ != "MotionEnd" && samples_++ > 0) {
      later_samples_.add(request_, start_);
      return lexer_.skip_values();
    }
    for (const std::string_view end : {"Begin", "End"}) {
      if (!request_.ends_with(end)) continue;
      const std::string_view kind = request_.substr(0, request_.size() - end.size());
      if (kind == "Object") return end == "Begin" ? begin_object() : end_object();
      if (kind == "Motion") return move(end == "Begin");
      if (RibStack::is_block(kind)) return block(kind, end == "Begin");
    }
    for (const auto& [name, handler] : handlers) {
      if (name == request_) return (this->*handler)();
    }
    unread().add(request_, start_);
    return lexer_.skip_values();
  }

  Status failure(const std::string& sentence) const { return start_.failure(std::string(request_) + ": " + sentence); }

  // Blocks.

  Status block(std::string_view kind, bool begin) {
    if (kind == "World" && begin) worlds_.add(kind, start_);
    Status status = begin ? stack_.begin(kind, start_) : stack_.end(kind, start_);
    return status.ok() ? lexer_.skip_values() : status;
  }

  Status move(bool begin) {
    in_motion_ = begin;
    samples_ = 0;
    return lexer_.skip_values();
  }

  Status begin_object() {
    if (object_) return failure("an object cannot be within another");
    handle_ = lexer_.at_value() ? lexer_.peek() : std::string_view();
    if (handle_.empty()) return lexer_.expected("a number or a name for the object");
    object_.emplace();
    Status status = stack_.begin("Object", start_);
    return status.ok() ? lexer_.skip_values() : status;
  }

  Status end_object() {
    Status status = stack_.end("Object", start_);
    if (!status.ok()) return status;
    objects_[handle_] = *std::move(object_);
    object_.reset();
    return {};
  }

  Status instance() {
    const auto object = objects_.find(lexer_.at_value() ? lexer_.peek() : std::string_view());
    if (object == objects_.end()) return lexer_.expected("the number or name of an object above");
    const Affine* own = nullptr;  // of the surface before; often also of the next one
    Shared<Affine> placement;
    for (const ModelSurface& surface : object->second) {
      if (own != &*surface.placement) {
        own = &*surface.placement;
        placement = *stack_.state().transform * *own;
        if (!is_finite(*placement)) return failure("the transformation is too large for double");
      }
      Status status = count_copy();
      if (!status.ok()) return status;
      surfaces().push_back({surface.name, surface.surface, placement, surface.trims});
    }
    return lexer_.skip_values();
  }

  /// Bounds the copies of objects in the model by the file's size: an object may be copied any number of times.
  Status count_copy() {
    constexpr std::size_t bytes = sizeof(ModelSurface) + sizeof(Affine);
    if (bytes > copies_left_) return failure("copies of objects would take more than 4 times the file");
    copies_left_ -= bytes;
    return {};
  }

  // Attributes.

  Status transform() {
    Affine map;
    std::array<double, 16> n{};
    const std::size_t count = request_ == "Identity"       ? 0
                              : request_ == "Rotate"       ? 4
                              : request_.ends_with("form") ? 16
                                                           : 3;
    if (count > 0) {
      Status status = lexer_.take_numbers(std::to_string(count) + " finite numbers after " + std::string(request_),
                                          std::span(n).first(count));
      if (!status.ok()) return status;
    }
    if (request_ == "Translate") map = Affine::translated({n[0], n[1], n[2]});
    if (request_ == "Scale") map = Affine::scaled({n[0], n[1], n[2]});
    if (request_ == "Rotate") map = Affine::rotated({n[1], n[2], n[3]}, n[0] * (std::numbers::pi / 180));
    if (count == 16) {
      if (n[3] != 0 || n[7] != 0 || n[11] != 0 || n[15] == 0) {
        return failure("expected an affine matrix, whose fourth column is 0 0 0 1");
      }
      for (std::size_t k = 0; k < 15; ++k) n[k] /= n[15];
      map = {.columns = {Vec3{n[0], n[1], n[2]}, Vec3{n[4], n[5], n[6]}, Vec3{n[8], n[9], n[10]}},
             .translation = {n[12], n[13], n[14]}};
    }
    Shared<Affine>& current = stack_.state().transform;
    current = request_ == "Identity" || request_ == "Transform" ? map : *current * map;
    return is_finite(*current) ? Status() : failure("the transformation is too large for double");
  }

  Status basis() {
    RibState& state = stack_.state();
    Status status = one_basis(state.basis_u);
    return status.ok() ? one_basis(state.basis_v) : status;
  }

  Status one_basis(RibBasis& basis) {
    if (lexer_.at_string()) {
      std::string_view name;
      Status status = lexer_.take_string("the name of a basis", name);
      if (!status.ok()) return status;
      const RibBasis* const known = find_rib_basis(name);
      if (!known) {
        return failure("expected bezier, b-spline, catmull-rom, hermite, power or a matrix, found " + quote(name));
      }
      basis = *known;
    } else {
      Status status = lexer_.take_numbers("the name of a basis or the 16 numbers of its matrix", basis.matrix);
      if (!status.ok()) return status;
      basis.matrix = recognised_matrix(basis.matrix);
    }
    std::int64_t step = 0;
    Status status = lexer_.take_integer("the step of the basis", 1, rib_count_limit, step);
    basis.step = static_cast<int>(step);
    return status;
  }

  /// Reads the name from Attribute "identifier" "name" ["rim"]; skips other forms like any unknown request.
  Status attribute() {
    RibLexer ahead = lexer_;
    std::string_view kind, parameter, name;
    if (ahead.take_string({}, kind).ok() && kind == "identifier" && ahead.take_string({}, parameter).ok() &&
        variable_name(parameter) == "name" && ahead.take_string({}, name).ok()) {
      stack_.state().name = surface_name(name);
    } else {
      others_.add(request_, start_);
    }
    return lexer_.skip_values();
  }

  Status quadric() {
    Result<RibQuadric> read = read_quadric(surface_text());
    if (!read) return read.status();
    const Affine placement = *stack_.state().transform * read->placement;
    if (!is_finite(placement)) return failure("the transformation is too large for double");
    make_room(surfaces(), size_ - lexer_.place().remaining(), size_);
    surfaces().push_back({stack_.state().name, std::move(read->surface), placement});
    return lexer_.skip_values();
  }

  Status trim_curve() {
    Result<std::vector<TrimLoop>> loops = read_trim_loops(lexer_);
    if (!loops) return loops.status();
    stack_.state().trims = *std::move(loops);
    return {};
  }

  Status pass() { return lexer_.skip_values(); }

  // Surfaces.

  Status patch() { return add(read_patch(surface_text())); }
  Status patch_mesh() { return add(read_patch_mesh(surface_text())); }

  Status nu_patch() {
    Status status = add(read_nu_patch(surface_text()));
    const auto& trims = stack_.state().trims;
    if (!status.ok() || trims->empty()) return status;
    surfaces().back().trims = trims;
    return {};
  }

  RibSurfaceText surface_text() { return {lexer_, start_, request_, stack_.state().basis_u, stack_.state().basis_v}; }

  std::vector<ModelSurface>& surfaces() { return object_ ? *object_ : model_.surfaces; }

  Status add(Result<std::vector<Surface>> read) {
    if (!read) return read.status();
    for (Surface& surface : *read) {
      make_room(surfaces(), size_ - lexer_.place().remaining(), size_);
      surfaces().push_back({stack_.state().name, std::move(surface), stack_.state().transform});
    }
    return {};
  }

  // Archives.

  /// Reads the requests of another file as if they stood here. A file that is missing is counted as a shape.
  Status read_archive() {
    std::string_view name;
    Status status = lexer_.take_string("the name of a file", name);
    if (!status.ok()) return status;
    const Result<const RibArchive*> archive = archives_.open(start_, name);
    if (!archive) return archive.status();
    if (!*archive) unread_shapes_.add(request_, start_);
    status = lexer_.skip_values();
    if (!status.ok() || !*archive) return status;
    copies_left_ += 4 * (*archive)->text.size();
    const RibLexer after = lexer_;
    const std::size_t size = size_;
    lexer_ = RibLexer((*archive)->text, (*archive)->name);
    size_ = (*archive)->text.size();
    while (status.ok() && !lexer_.at_end()) status = read_request();
    archives_.close();
    lexer_ = after;
    size_ = size;
    return status;
  }

  // Warnings.

  Status nothing_read() const {
    const std::string begin = std::string(name_) + ": no surface that can be read";
    if (unread_shapes_.empty()) {
      return Status(StatusCode::parse_error, begin + ": expected Patch, PatchMesh, NuPatch or a quadric, found none");
    }
    return Status(StatusCode::unsupported, begin + ", but " + unread_shapes_.words());
  }

  void warn() {
    const auto say = [&](const Tally& tally, const std::string& words) {
      model_.warnings.push_back(tally.place() + ": " + words);
    };
    const auto number = [](const Tally& tally) { return std::to_string(tally.total()); };
    if (!unread_shapes_.empty()) say(unread_shapes_, "shapes that are not read: " + unread_shapes_.words());
    if (!unread_transforms_.empty()) {
      say(unread_transforms_,
          "transformations that are not read, surfaces after them are misplaced: " + unread_transforms_.words());
    }
    if (!later_samples_.empty()) {
      say(later_samples_, "motions are read at their first moment only, " + number(later_samples_) +
                              (later_samples_.total() == 1 ? " other is" : " others are") + " skipped");
    }
    if (worlds_.total() > 1) {
      say(worlds_, number(worlds_) + " worlds share one space, their surfaces may overlap");
    }
    if (stack_.is_open()) {
      model_.warnings.push_back(std::string(name_) + ": expected the blocks to end with the file, " +
                                stack_.open_block());
    }
    if (!others_.empty()) say(others_, "requests that are skipped: " + others_.words());
  }

  Tally& unread() {
    if (contains(unread_requests, request_)) return unread_shapes_;
    return contains(other_transforms, request_) ? unread_transforms_ : others_;
  }

  static constexpr std::array<std::pair<std::string_view, Handler>, 23> handlers{{
      {"Patch", &RibReader::patch},
      {"PatchMesh", &RibReader::patch_mesh},
      {"NuPatch", &RibReader::nu_patch},
      {"TrimCurve", &RibReader::trim_curve},
      {"Sphere", &RibReader::quadric},
      {"Cone", &RibReader::quadric},
      {"Cylinder", &RibReader::quadric},
      {"Hyperboloid", &RibReader::quadric},
      {"Paraboloid", &RibReader::quadric},
      {"Disk", &RibReader::quadric},
      {"Torus", &RibReader::quadric},
      {"ReadArchive", &RibReader::read_archive},
      {"Basis", &RibReader::basis},
      {"Attribute", &RibReader::attribute},
      {"ObjectInstance", &RibReader::instance},
      {"Identity", &RibReader::transform},
      {"Transform", &RibReader::transform},
      {"ConcatTransform", &RibReader::transform},
      {"Translate", &RibReader::transform},
      {"Scale", &RibReader::transform},
      {"Rotate", &RibReader::transform},
      {"version", &RibReader::pass},
      {"Declare", &RibReader::pass},
  }};

  std::string_view name_;
  std::size_t size_;
  RibLexer lexer_;
  TextCursor start_;  // of the current request
  RibArchives archives_;
  std::string_view request_;
  RibStack stack_;
  Model model_;
  std::map<std::string_view, Object> objects_;
  std::optional<Object> object_;  // being defined
  std::string_view handle_;
  std::size_t copies_left_;
  bool in_motion_ = false;
  std::size_t samples_ = 0;
  Tally unread_shapes_, unread_transforms_, others_, later_samples_, worlds_;
};

}  // namespace

Result<Model> parse_rib(std::string_view text, std::string_view name) {
  return guarded([&]() -> Result<Model> {
    if (text.starts_with("\x1f\x8b")) {
      return Status(StatusCode::unsupported,
                    std::string(name) + ": this text is packed by gzip; read_model() unpacks files");
    }
    return RibReader(text, name).read();
  });
}

}}  // namespace tessera::abi_0_1
