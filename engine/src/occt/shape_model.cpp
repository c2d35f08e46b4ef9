#include "occt/shape_model.h"

#include <opencascade/TopoDS.hxx>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "base/text.h"
#include "occt/guarded_calls.h"
#include "occt/part_shape.h"
#include "occt/part_tree.h"
#include "tessera/topology.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

std::string in_file(const std::string& path, const std::string& sentence) {
  return path.empty() ? sentence : path + ": " + sentence;
}

/// Gathers parts, their places, and warnings.
class ModelOfParts {
 public:
  ModelOfParts(const DescribedShape& file, const std::string& path) : file_(file), path_(path) {}

  /// Reads each part once, its faces by all threads. Errors: those of PartTree; cancelled, internal (an exception of
  /// OpenCASCADE).
  Status read(const Execution& execution) {
    Result<std::vector<PlacedPart>> parts = PartTree(file_).parts();
    if (!parts) return parts.status();
    placed_ = *std::move(parts);
    const Execution quiet{.cancel = execution.cancel};
    for (const PlacedPart& placed : placed_)
      if (Status status = add(placed, quiet); !status.ok()) return status;
    std::vector<std::pair<std::size_t, std::size_t>> faces;
    for (std::size_t k = 0; k < parts_.size(); ++k)
      for (std::size_t face = 0; face < parts_[k].face_count(); ++face) faces.push_back({k, face});
    const Status converted = each_on_threads(faces.size(), 4, execution, [&](std::size_t k) {
      parts_[faces[k].first].convert(faces[k].second);
      return Status();
    });
    if (!converted.ok()) return converted;
    made_.resize(parts_.size());
    return each_on_threads(parts_.size(), 1, quiet, [&](std::size_t k) {
      std::move(parts_[k]).finish(made_[k].shape, made_[k].sources, made_[k].shortcomings);
      return Status();
    });
  }

  Result<OcctModel> finish() {
    for (std::size_t k = 0; k < made_.size(); ++k) add_shape(k);
    for (std::size_t k = 0; k < placed_.size(); ++k) add_instance(k);
    for (const std::string& complaint : file_.complaints) left_out_.push_back("OpenCASCADE: " + complaint);
    Model& model = out_.model;
    if (model.instances.empty()) return nothing();
    warn_of(left_out_);
    warn_of(whole_);
    warn_of(file_.notes);
    if (fitted_ > 0)
      warn(counted(fitted_, "surface") + " fitted by splines, to within " + text(worst_fit_) +
           (path_.empty() ? "" : " mm"));
    Result<std::vector<ModelSurface>> placed = placed_faces(model.shapes, model.instances);
    if (!placed) return placed.status();
    model.surfaces = *std::move(placed);
    model.unit = file_.unit;
    model.file_unit = file_.file_unit;
    return std::move(out_);
  }

 private:
  /// A part that is read.
  struct MadeShape {
    Shape shape;
    OcctShape sources;
    Shortcomings shortcomings;
  };

  /// Finds out of which part an instance is, and begins to read the part where it comes first.
  Status add(const PlacedPart& placed, const Execution& execution) {
    const auto own = file_.names.find(identity(placed.shape));
    const bool named = own != file_.names.end() && !own->second.empty();
    const auto [place, is_new] = keys_.try_emplace(
        {identity(placed.shape), placed.shape.Orientation(), named ? nullptr : placed.above, placed.own_colours},
        parts_.size());
    part_of_.push_back(place->second);
    if (!is_new) return {};
    first_place_.push_back(placed.shape.Location());
    Result<PartShape> part = PartShape::make(file_, placed, faces_, execution);
    if (!part) return part.status();
    faces_ += part->face_count();
    parts_.push_back(*std::move(part));
    return {};
  }

  /// Takes over a part that is read, if it has faces.
  void add_shape(std::size_t part) {
    MadeShape& made = made_[part];
    Shortcomings& lacks = made.shortcomings;
    if (left_out_.empty()) first_code_ = lacks.first_code;
    std::move(lacks.left_out.begin(), lacks.left_out.end(), std::back_inserter(left_out_));
    std::move(lacks.whole.begin(), lacks.whole.end(), std::back_inserter(whole_));
    for (const TopoDS_Face& face : lacks.faces_left_out)
      out_.left_out.push_back(TopoDS::Face(moved(face, first_place_[part])));
    fitted_ += lacks.fitted;
    worst_fit_ = std::max(worst_fit_, lacks.worst_fit);
    shape_of_.push_back(made.shape.faces.empty() ? no_id : static_cast<std::uint32_t>(out_.model.shapes.size()));
    if (made.shape.faces.empty()) return;
    out_.model.shapes.push_back(std::move(made.shape));
    out_.shapes.push_back(std::move(made.sources));
  }

  void add_instance(std::size_t k) {
    const PlacedPart& placed = placed_[k];
    const std::uint32_t shape = shape_of_[part_of_[k]];
    if (shape == no_id) return;
    Instance& instance = out_.model.instances.emplace_back();
    instance.shape = shape;
    instance.first_surface = surfaces_;
    surfaces_ += out_.model.shapes[shape].faces.size();
    instance.name = placed.name.empty() ? *out_.model.shapes[shape].name : placed.name;
    instance.placement = placed.move * affine(placed.shape.Location().Transformation());
    instance.colour = placed.colour;
    out_.locations.push_back(placed.shape.Location());
  }

  void warn_of(const std::vector<std::string>& sentences) {
    const std::size_t most = 20;
    for (std::size_t k = 0; k < std::min(most, sentences.size()); ++k) warn(sentences[k]);
    if (sentences.size() > most) warn(counted(sentences.size() - most, "message") + " more of this kind");
  }

  void warn(const std::string& sentence) { out_.model.warnings.push_back(in_file(path_, sentence)); }

  Status nothing() const {
    const std::string& contents = file_.contents;
    if (left_out_.empty())
      return Status(StatusCode::parse_error,
                    in_file(path_, "it holds no surfaces" + (contents.empty() ? "" : " (" + contents + ")")));
    const std::size_t more = left_out_.size() - 1;
    const std::string others = more == 0 ? "" : " (and " + counted(more, "message") + " more)";
    return Status(first_code_, in_file(path_, "no surface can be read: " + left_out_[0] + others +
                                                  (contents.empty() ? "" : "; the file holds " + contents)));
  }

  const DescribedShape& file_;
  const std::string& path_;
  std::vector<PlacedPart> placed_;
  /// Parts by identity, orientation, the name that faces without one take, and the colours of this instance alone.
  std::map<std::tuple<const void*, int, const std::string*, std::vector<const DescribedShape::Colours*>>, std::size_t>
      keys_;
  std::vector<std::size_t> part_of_;           ///< of each placed part
  std::vector<PartShape> parts_;               ///< distinct
  std::vector<TopLoc_Location> first_place_;   ///< of each
  std::vector<MadeShape> made_;                ///< of each
  std::vector<std::uint32_t> shape_of_;        ///< of each, its index in the model; no_id if no face is left
  std::size_t faces_ = 0;                      ///< of all parts so far
  std::size_t surfaces_ = 0;                   ///< of all instances so far
  std::vector<std::string> left_out_, whole_;  ///< see Shortcomings, as the following
  StatusCode first_code_ = StatusCode::parse_error;
  std::size_t fitted_ = 0;
  double worst_fit_ = 0;
  OcctModel out_;
};

}  // namespace

Result<OcctModel> model_of(const DescribedShape& file, const std::string& path, const Execution& execution) {
  ModelOfParts parts(file, path);
  const Status status = parts.read(execution);
  if (!status.ok()) return Status(status.code(), in_file(path, status.message()), status.index());
  return parts.finish();
}

}}  // namespace tessera::abi_0_1
