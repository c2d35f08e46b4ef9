#pragma once
// What both modes of a ray scene do, and what they share.

#include <memory>
#include <span>

#include "ray/scene/batch_layout.h"
#include "ray/scene/set_view.h"
#include "tessera/ray_scene.h"
#include "tessera/strided_view.h"

namespace tessera::inline abi_0_1 {

class ExactSource;

class RayScene::Impl {
 public:
  Impl() = default;
  virtual ~Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  /// Makes ready for the set as it is now, from nothing or from what stands. After an error the scene stays stale.
  Status rebuild(const Execution& execution);
  Status refit(const Execution& execution);
  /// Rays 0 to count - 1 of the batch; there is room for their results.
  Status closest(const RayBatch& batch, const HitWriter& hits, std::size_t count, const Execution& execution) const;
  Status occluded(const RayBatch& batch, const View1<std::uint8_t>& occluded, std::size_t count,
                  const Execution& execution) const;
  Status all(std::span<const Ray> rays, HitLists& lists, const Execution& execution) const;
  /// Looks for shared borders, unless that is done: before all_of(), and before rays that leave a surface are traced. By
  /// one thread or several at once. Throws bad_alloc.
  virtual void prepare_borders() const {}

  virtual bool can_filter() const { return true; }
  /// Of exact mode alone.
  virtual const ExactSource* exact_source() const { return nullptr; }
  bool fresh() const { return ready_ && revision_ == source_revision(); }

  /// As those of RayScene; the scene is fresh.
  virtual double spawn_offset() const = 0;
  virtual Result<LocalGeometry> local_geometry(const Hit& hit) const = 0;
  virtual Result<Hit> resolve(std::uint32_t patch, double u, double v) const;
  virtual Result<Hit> resolve(const Ray& ray, std::uint32_t patch, double u, double v) const;

  Box3 box() const { return fresh() ? model_box() : Box3{}; }
  std::uint64_t revision() const { return revision_; }
  virtual std::size_t memory_bytes() const = 0;

 protected:
  /// Rays begin to end of a task, valid or not; room is checked. Once the batch is stopped, nothing need be written.
  virtual void closest_piece(const RayBatch& batch, const HitWriter& hits, std::size_t begin,
                             std::size_t end) const = 0;
  virtual void occluded_piece(const RayBatch& batch, const View1<std::uint8_t>& occluded, std::size_t begin,
                              std::size_t end) const = 0;
  /// Appends the hits of one ray, in order.
  virtual Status all_of(const Ray& ray, std::vector<Hit>& hits) const = 0;

  /// That of what the scene was made for.
  virtual std::uint64_t source_revision() const = 0;

 private:
  virtual Status build(const Execution& execution) = 0;
  /// build() once something stands, which was made for revision `since`. After an error of build() or update() nothing
  /// stands.
  virtual Status update(std::uint64_t since, const Execution& execution) = 0;
  virtual Box3 model_box() const = 0;
  Status done(Status status);
  Status check(const RayBatch& batch) const;

  std::uint64_t revision_ = 0;
  bool ready_ = false;  // false after a build that failed
};

/// What scenes of patches share.
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
  /// Errors: invalid_argument.
  Status check_point(std::uint32_t patch, double u, double v) const;

 private:
  SetView set_;
};

/// Options are checked here. Not yet built.
Result<std::unique_ptr<RayScene::Impl>> make_grid_scene(const PatchSet& set, const RaySceneOptions& options);
/// The mesh is looked at when it is built.
Result<std::unique_ptr<RayScene::Impl>> make_mesh_scene(const PatchSet& set, const Mesh& mesh,
                                                        const RaySceneOptions& options);
Result<std::unique_ptr<RayScene::Impl>> make_exact_scene(const PatchSet& set, const RaySceneOptions& options);
Result<std::unique_ptr<RayScene::Impl>> make_instance_scene(std::span<const RayInstance> instances);

}  // namespace tessera::inline abi_0_1
