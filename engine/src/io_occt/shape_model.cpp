#include "io_occt/shape_model.h"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "base/text.h"
#include "io_occt/part_shape.h"
#include "io_occt/part_tree.h"
#include "tessera/topology.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Gathers parts, their places, and warnings.
class ModelOfParts {
 public:
  ModelOfParts(const CadFile& file, const std::string& path) : file_(file), path_(path) {}

  void add(const PlacedPart& placed) {
    const std::uint32_t shape = shape_of(placed);
    if (shape == no_id) return;
    Instance& instance = model_.instances.emplace_back();
    instance.shape = shape;
    instance.first_surface = surfaces_;
    surfaces_ += model_.shapes[shape].faces.size();
    instance.name = placed.name.empty() ? *model_.shapes[shape].name : placed.name;
    instance.placement = placed.move * affine(placed.shape.Location().Transformation());
    instance.colour = placed.colour;
  }

  Result<Model> finish() {
    std::vector<std::string>& left_out = shortcomings_.left_out;
    for (const std::string& complaint : file_.complaints) left_out.push_back("OpenCASCADE: " + complaint);
    if (model_.instances.empty()) return nothing();
    warn_of(left_out);
    warn_of(shortcomings_.whole);
    warn_of(file_.notes);
    if (shortcomings_.fitted > 0)
      warn(counted(shortcomings_.fitted, "surface") + " fitted by splines, to within " + text(shortcomings_.worst_fit) +
           " mm");
    Result<std::vector<ModelSurface>> placed = placed_faces(model_.shapes, model_.instances);
    if (!placed) return placed.status();
    model_.surfaces = *std::move(placed);
    model_.unit = file_.unit;
    model_.file_unit = file_.file_unit;
    return std::move(model_);
  }

 private:
  /// The shape of a part, which is read where it comes first; no_id if it has no faces.
  std::uint32_t shape_of(const PlacedPart& placed) {
    const auto own = file_.names.find(identity(placed.shape));
    const bool named = own != file_.names.end() && !own->second.empty();
    const auto [place, is_new] = shapes_.try_emplace(
        {identity(placed.shape), placed.shape.Orientation(), named ? nullptr : placed.above, placed.own_colours},
        no_id);
    if (!is_new) return place->second;
    Shape shape = part_shape(file_, placed, shortcomings_);
    if (shape.faces.empty()) return no_id;
    place->second = static_cast<std::uint32_t>(model_.shapes.size());
    model_.shapes.push_back(std::move(shape));
    return place->second;
  }

  void warn_of(const std::vector<std::string>& sentences) {
    const std::size_t most = 20;
    for (std::size_t k = 0; k < std::min(most, sentences.size()); ++k) warn(sentences[k]);
    if (sentences.size() > most) warn(counted(sentences.size() - most, "message") + " more of this kind");
  }

  void warn(const std::string& sentence) { model_.warnings.push_back(path_ + ": " + sentence); }

  Status nothing() {
    const std::vector<std::string>& left_out = shortcomings_.left_out;
    const std::string& contents = file_.contents;
    if (left_out.empty())
      return Status(StatusCode::parse_error,
                    path_ + ": it holds no surfaces" + (contents.empty() ? "" : " (" + contents + ")"));
    const std::size_t more = left_out.size() - 1;
    const std::string others = more == 0 ? "" : " (and " + counted(more, "message") + " more)";
    return Status(shortcomings_.first_code, path_ + ": no surface can be read: " + left_out[0] + others +
                                                (contents.empty() ? "" : "; the file holds " + contents));
  }

  const CadFile& file_;
  const std::string& path_;
  Model model_;
  std::size_t surfaces_ = 0;  ///< of all instances so far
  /// By identity, orientation, the name that faces without one take, and the colours of this instance alone.
  std::map<std::tuple<const void*, int, const std::string*, std::vector<const CadFile::Colours*>>, std::uint32_t>
      shapes_;
  Shortcomings shortcomings_;
};

}  // namespace

Result<Model> model_of(const CadFile& file, const std::string& path) {
  ModelOfParts parts(file, path);
  for (const PlacedPart& part : PartTree(file).parts()) parts.add(part);
  return parts.finish();
}

}}  // namespace tessera::abi_0_1
