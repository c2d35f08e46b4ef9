#include "io/step/read_step.h"

#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "base/text.h"
#include "io/file/text_encoding.h"
#include "io/step/step_contents.h"
#include "io/step/step_index.h"
#include "io/step/step_shape.h"
#include "io/step/step_tree.h"
#include "tessera/guard.h"
#include "tessera/topology.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Gathers the shapes of parts, and their places.
class StepModel {
 public:
  StepModel(const StepIndex& index, const StepTree& tree, const std::string& name, const Execution& execution)
      : index_(index), tree_(tree), name_(name), execution_(execution) {}

  Status add(const StepPlacedPart& place) {
    const Result<std::uint32_t> shape = shape_of(place);
    if (!shape) return shape.status();
    if (*shape == no_id) return {};
    Instance& instance = model_.instances.emplace_back();
    instance.shape = *shape;
    instance.first_surface = surfaces_;
    surfaces_ += model_.shapes[*shape].faces.size();
    instance.name = place.name.empty() ? *model_.shapes[*shape].name : place.name;
    instance.placement = place.placement;
    instance.colour = place.colour;
    return {};
  }

  Result<Model> finish(const std::vector<std::string>& notes) {
    const StepKinds kinds = step_kinds(index_);
    if (model_.instances.empty()) return nothing(kinds);
    warn_of(faults_.left_out);
    warn_of(faults_.changed);
    warn_of(tree_.remarks.texts, tree_.remarks.count);
    std::vector<std::string> of_file;
    for (const StepRemark& remark : index_.remarks())
      of_file.push_back("line " + std::to_string(remark.line) + ": " + remark.text);
    warn_of(of_file, index_.remark_count());
    warn_of(notes);
    if (const std::string unread = unread_shapes(kinds); !unread.empty())
      warn("shapes of these kinds are not read: " + unread);
    if (faults_.fitted > 0)
      warn(counted(faults_.fitted, "surface") + " fitted by splines, to within " + text(faults_.worst_fit) + " mm");
    Result<std::vector<ModelSurface>> placed = placed_faces(model_.shapes, model_.instances);
    if (!placed) return placed.status();
    model_.surfaces = *std::move(placed);
    model_.unit = "mm";
    model_.file_unit = tree_.file_unit;
    return std::move(model_);
  }

 private:
  /// The shape of a part, which is read where it comes first; no_id if it has no faces.
  Result<std::uint32_t> shape_of(const StepPlacedPart& place) {
    const auto [known, is_new] = shapes_.try_emplace({place.part, place.colours, place.is_mirrored()}, no_id);
    if (!is_new) return known->second;
    const StepPart& part = tree_.parts[place.part];
    const StepColours& colours = tree_.colours[place.colours];
    const StepShapeInput input{part.items,          part.units, part.uncertainty, part.name,
                               place.is_mirrored(), part.representation, &colours};
    Result<Shape> shape = step_shape(index_, input, faults_, execution_);
    if (!shape) return shape.status();
    if (shape->faces.empty()) return no_id;
    known->second = static_cast<std::uint32_t>(model_.shapes.size());
    model_.shapes.push_back(*std::move(shape));
    return known->second;
  }

  void warn_of(const std::vector<std::string>& sentences, std::size_t count = 0) {
    constexpr std::size_t most = 20;
    const std::size_t shown = std::min(most, sentences.size()), all = std::max(count, sentences.size());
    for (std::size_t k = 0; k < shown; ++k) warn(sentences[k]);
    if (all > shown) warn(counted(all - shown, "message") + " more of this kind");
  }

  void warn(const std::string& sentence) { model_.warnings.push_back(name_ + ": " + sentence); }

  Status nothing(const StepKinds& kinds) const {
    const std::vector<std::string>& left_out = faults_.left_out;
    const std::string contents = contents_of(kinds);
    if (left_out.empty())
      return Status(StatusCode::parse_error,
                    name_ + ": it holds no surfaces" + (contents.empty() ? "" : " (" + contents + ")"));
    const std::size_t more = left_out.size() - 1;
    const std::string others = more == 0 ? "" : " (and " + counted(more, "message") + " more)";
    return Status(faults_.first_code, name_ + ": no surface can be read: " + left_out[0] + others +
                                          (contents.empty() ? "" : "; the file holds " + contents));
  }

  const StepIndex& index_;
  const StepTree& tree_;
  const std::string& name_;
  const Execution& execution_;
  Model model_;
  std::size_t surfaces_ = 0;  ///< of all instances so far
  std::map<std::tuple<std::size_t, std::size_t, bool>, std::uint32_t> shapes_;  ///< by part, colours and side
  StepShapeFaults faults_;
};

Result<Model> read(std::string_view text, const std::string& name, const Execution& execution) {
  const auto named = [&](const Status& status) { return Status(status.code(), name + ": " + status.message()); };
  const Result<StepIndex> index = StepIndex::make(text, execution);
  if (!index) return named(index.status());
  const TextEncoding encoding = encoding_of(text);
  const Result<StepTree> tree = read_step_tree(*index, encoding);
  if (!tree) return named(tree.status());
  StepModel model(*index, *tree, name, execution);
  for (const StepPlacedPart& place : tree->places)
    if (Status status = model.add(place); !status.ok()) return named(status);
  std::vector<std::string> notes;
  if (encoding != TextEncoding::utf8)
    notes.push_back(std::string("its names are not UTF-8, and are taken as ") + name_of(encoding));
  return model.finish(notes);
}

}  // namespace

Result<Model> read_step(std::string_view text, const std::string& name, const Execution& execution) {
  return guarded([&] { return read(text, name, execution); });
}

}}  // namespace tessera::abi_0_1
