#pragma once
// The interface and common parts of all kinds of ray scenes.

#include <memory>
#include <optional>
#include <span>

#include "ray/line/set_view.h"
#include "ray/scene/batch_layout.h"
#include "tessera/ray_scene.h"
#include "tessera/strided_view.h"

namespace tessera { inline namespace abi_0_1 {

class ExactSource;

class RayScene::Impl {
 public:
  Impl() = default;
  virtual ~Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  /// Build the scene for the current set, anew or from the existing one. After an error the scene stays stale.
  Status rebuild(const Execution& execution);
  Status refit(const Execution& execution);
  /// Trace rays 0 to count - 1 of the batch; there must be room for their results.
  Status closest(const RayBatch& batch, const HitWriter& hits, std::size_t count, const Execution& execution) const;
  Status occluded(const RayBatch& batch, const View1<std::uint8_t>& occluded, std::size_t count,
                  const Execution& execution) const;
  Status all(std::span<const Ray> rays, HitLists& lists, const Execution& execution) const;
  /// Finds shared borders, unless that is done. Call it before all_of(), and before tracing rays that leave a surface,
  /// from one thread or several at once. Throws bad_alloc.
  virtual void prepare_borders() const {}

  /// Keeps the set that the scene is made of.
  void keep(PatchSet&& set) { set_.emplace(std::move(set)); }

  virtual bool can_filter() const { return true; }
  /// Returns null except in exact mode.
  virtual const ExactSource* exact_source() const { return nullptr; }
  bool fresh() const { return ready_ && revision_ == source_revision(); }

  /// Functions as those of RayScene; the scene is fresh.
  virtual double spawn_offset() const = 0;
  virtual Result<LocalGeometry> local_geometry(const Hit& hit) const = 0;
  virtual Result<Hit> resolve(std::uint32_t patch, double u, double v) const;
  virtual Result<Hit> resolve(const Ray& ray, std::uint32_t patch, double u, double v) const;

  virtual std::vector<double> edge_gaps() const { return {}; }

  Box3 box() const { return fresh() ? model_box() : Box3{}; }
  std::uint64_t revision() const { return revision_; }
  virtual std::size_t memory_bytes() const = 0;

 protected:
  /// Trace rays begin to end of a task, valid or not; room is checked. Once the batch is stopped, results may be left
  /// out.
  virtual void closest_piece(const RayBatch& batch, const HitWriter& hits, std::size_t begin,
                             std::size_t end) const = 0;
  virtual void occluded_piece(const RayBatch& batch, const View1<std::uint8_t>& occluded, std::size_t begin,
                              std::size_t end) const = 0;
  /// Appends the hits of one ray, in order.
  virtual Status all_of(const Ray& ray, std::vector<Hit>& hits) const = 0;

  /// Returns the revision of the set or scenes that the scene is made of.
  virtual std::uint64_t source_revision() const = 0;

 private:
  virtual Status build(const Execution& execution) = 0;
  /// Called instead of build() once the scene stands, built for revision `since`. After an error of build() or update()
  /// the scene is not usable.
  virtual Status update(std::uint64_t since, const Execution& execution) = 0;
  virtual Box3 model_box() const = 0;
  Status done(Status status);
  Status check(const RayBatch& batch) const;

  std::optional<PatchSet> set_;  // empty if the caller keeps it
  std::uint64_t revision_ = 0;
  bool ready_ = false;  // false after a build that failed
};

/// The common part of scenes of patches.
class PatchScene : public RayScene::Impl {
 public:
  explicit PatchScene(const PatchSet& set) : set_(set) {}

  double spawn_offset() const override;
  Result<LocalGeometry> local_geometry(const Hit& hit) const override;
  Result<Hit> resolve(std::uint32_t patch, double u, double v) const override;
  using Impl::resolve;

 protected:
  const SetView& set() const { return set_; }
  std::uint64_t source_revision() const override { return set_.revision(); }
  virtual double size() const = 0;  ///< of the set's box
  /// Checks that the patch exists and that (u,v) is in [0,1]^2. Errors: invalid_argument.
  Status check_point(std::uint32_t patch, double u, double v) const;

 private:
  SetView set_;
};

/// Make scenes that are not yet built. Options are checked here.
Result<std::unique_ptr<RayScene::Impl>> make_grid_scene(const PatchSet& set, const RaySceneOptions& options);
/// The mesh is checked by build().
Result<std::unique_ptr<RayScene::Impl>> make_mesh_scene(const PatchSet& set, const Mesh& mesh,
                                                        const RaySceneOptions& options);
Result<std::unique_ptr<RayScene::Impl>> make_exact_scene(const PatchSet& set, const RaySceneOptions& options);
Result<std::unique_ptr<RayScene::Impl>> make_instance_scene(std::span<const RayInstance> instances);

}}  // namespace tessera::abi_0_1
