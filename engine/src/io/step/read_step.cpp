#include "io/step/read_step.h"

#include <algorithm>
#include <array>
#include <map>
#include <mutex>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "base/text.h"
#include "io/file/text_encoding.h"
#include "io/step/step_contents.h"
#include "io/step/step_index.h"
#include "io/step/step_shape.h"
#include "io/step/step_tree.h"
#include "parallel/call_progress.h"
#include "parallel/parallel_for.h"
#include "parallel/tbb_loop.h"
#include "tessera/guard.h"
#include "tessera/topology.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// Adds up the progress of parts, several of which may be read at once.
class PartsProgress {
 public:
  PartsProgress(const Execution& execution, std::size_t parts)
      : execution_(execution), parts_(static_cast<double>(parts)) {}

  /// `share`: of one part, done since it was last reported. Threads: any number of calls at once.
  void add(double share) {
    if (!execution_.progress) return;
    const std::lock_guard lock(mutex_);
    done_ += share / parts_;
    if (done_ < reported_ + 0.01) return;
    reported_ = std::min(done_, 1.0);
    // A thread that took another part while the caller waits would wait for the lock, which it holds itself.
    without_other_tasks([&] { execution_.progress(reported_); });
  }

 private:
  const Execution& execution_;
  double parts_, done_ = 0, reported_ = 0;
  std::mutex mutex_;
};

/// Gathers the shapes of parts, and their places.
class StepModel {
 public:
  StepModel(const StepIndex& index, const StepTree& tree, const std::string& name, const Execution& execution)
      : index_(index), tree_(tree), name_(name), execution_(execution) {}

  /// Reads the shapes, several at once.
  Status read_shapes() {
    for (const StepPlacedPart& place : tree_.places) {
      const auto [known, is_new] = shapes_.try_emplace(key_of(place), readings_.size());
      if (is_new) readings_.push_back({&place, {}, {}, {}});
    }
    PartsProgress progress(execution_, readings_.size());
    for (std::size_t first = 0; first < readings_.size(); first += read_at_once)
      if (Status status = read_shapes(std::span(readings_).subspan(first), progress); !status.ok()) return status;
    return {};
  }

  Status place_shapes() {
    for (const StepPlacedPart& place : tree_.places) {
      const std::uint32_t shape = readings_[shapes_.at(key_of(place))].index;
      if (shape == no_id) continue;
      Instance& instance = model_.instances.emplace_back();
      instance.shape = shape;
      instance.first_surface = surfaces_;
      surfaces_ += model_.shapes[shape].faces.size();
      if (surfaces_ > max_surfaces)
        return Status(StatusCode::unsupported,
                      "its instances have more than " + std::to_string(max_surfaces) + " faces");
      instance.name = place.name.empty() ? *model_.shapes[shape].name : place.name;
      instance.placement = place.placement;
      instance.colour = place.colour;
    }
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
  static constexpr std::size_t max_surfaces = std::size_t{1} << 24, read_at_once = 256;
  /// Part, colours and side: places with one key have one shape.
  using Key = std::tuple<std::size_t, std::size_t, bool>;
  struct Reading {
    const StepPlacedPart* place;
    Shape shape;
    StepShapeFaults faults;
    Status status;
    std::uint32_t index = no_id;  ///< into Model::shapes; no_id: it has no faces
  };

  /// Reads the first ones of `readings`. Parts may share faces, and one part may have several colours, but a file must
  /// not grow by that.
  Status read_shapes(std::span<Reading> readings, PartsProgress& progress) {
    readings = readings.first(std::min(readings.size(), read_at_once));
    const Execution quiet{.cancel = execution_.cancel};
    const Status status = parallel_for(readings.size(), 1, quiet, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) read(readings[k], progress);
    });
    if (!status.ok()) return status;
    const std::size_t instances = index_.instances().size(), most = 32 * instances + (std::size_t{1} << 12);
    for (Reading& one : readings) {
      if (!one.status.ok()) return one.status;
      read_ += one.shape.faces.size() + one.shape.edges.size() + one.faults.left_out.size();
      if (read_ > most)
        return Status(StatusCode::unsupported, "it has " + counted(instances, "instance") +
                                                   ", but its parts have more than " + std::to_string(most) +
                                                   " faces and edges");
      add(one.faults);
      if (one.shape.faces.empty()) continue;
      one.index = static_cast<std::uint32_t>(model_.shapes.size());
      model_.shapes.push_back(std::move(one.shape));
    }
    return {};
  }

  static Key key_of(const StepPlacedPart& place) { return {place.part, place.colours, place.is_mirrored()}; }

  void read(Reading& reading, PartsProgress& progress) const {
    const StepPlacedPart& place = *reading.place;
    const StepPart& part = tree_.parts[place.part];
    const StepShapeInput input{part.items,
                               part.units,
                               part.uncertainty,
                               part.name,
                               place.is_mirrored(),
                               part.representation,
                               &tree_.colours[place.colours]};
    double done = 0;
    const Execution reported{.cancel = execution_.cancel, .progress = [&](double share) {
                               progress.add(share - done);
                               done = share;
                             }};
    Result<Shape> shape = step_shape(index_, input, reading.faults, reported);
    if (shape)
      reading.shape = *std::move(shape);
    else
      reading.status = shape.status();
  }

  void add(const StepShapeFaults& faults) {
    if (faults_.left_out.empty()) faults_.first_code = faults.first_code;
    faults_.left_out.insert(faults_.left_out.end(), faults.left_out.begin(), faults.left_out.end());
    faults_.changed.insert(faults_.changed.end(), faults.changed.begin(), faults.changed.end());
    faults_.fitted += faults.fitted;
    faults_.worst_fit = std::max(faults_.worst_fit, faults.worst_fit);
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
      return Status(StatusCode::parse_error, name_ + ": it holds no surfaces" +
                                                 (contents.empty() ? "" : " (" + contents + ")") + first_remark());
    const std::size_t more = left_out.size() - 1;
    const std::string others = more == 0 ? "" : " (and " + counted(more, "message") + " more)";
    return Status(faults_.first_code, name_ + ": no surface can be read: " + left_out[0] + others +
                                          (contents.empty() ? "" : "; the file holds " + contents));
  }

  /// The first fault of the file that may be why it holds no surfaces, such as its early end.
  std::string first_remark() const {
    if (!index_.remarks().empty())
      return "; line " + std::to_string(index_.remarks()[0].line) + ": " + index_.remarks()[0].text;
    return tree_.remarks.texts.empty() ? std::string() : "; " + tree_.remarks.texts[0];
  }

  const StepIndex& index_;
  const StepTree& tree_;
  const std::string& name_;
  const Execution& execution_;
  Model model_;
  std::size_t surfaces_ = 0;  ///< of all instances so far
  std::size_t read_ = 0;      ///< faces and edges of all shapes so far
  std::map<Key, std::size_t> shapes_;
  std::vector<Reading> readings_;
  StepShapeFaults faults_;
};

Result<Model> read(std::string_view text, const std::string& name, const Execution& execution) {
  const auto named = [&](const Status& status) { return Status(status.code(), name + ": " + status.message()); };
  constexpr std::array ends{0.3, 0.95};  // of the index, and of the shapes
  CallProgress progress(execution, ends);
  const Result<StepIndex> index = StepIndex::make(text, progress.loops());
  if (!index) return named(index.status());
  const TextEncoding encoding = encoding_of(text);
  const Result<StepTree> tree = read_step_tree(*index, encoding);
  if (!tree) return named(tree.status());
  StepModel model(*index, *tree, name, progress.loops());
  if (Status status = model.read_shapes(); !status.ok()) return named(status);
  if (Status status = model.place_shapes(); !status.ok()) return named(status);
  std::vector<std::string> notes;
  if (encoding != TextEncoding::utf8)
    notes.push_back(std::string("its names are not UTF-8, and are taken as ") + name_of(encoding));
  Result<Model> made = model.finish(notes);
  if (made) (void)progress.finish({});
  return made;
}

}  // namespace

Result<Model> read_step(std::string_view text, const std::string& name, const Execution& execution) {
  return guarded([&] { return read(text, name, execution); });
}

}}  // namespace tessera::abi_0_1
