#pragma once
// The objects behind the handles.

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "c/calls.h"
#include "tessera/evaluate.h"
#include "tessera/measures.h"
#include "tessera/model.h"
#include "tessera/nearest_points.h"
#include "tessera/patch_set.h"
#include "tessera/ray_scene.h"
#include "tessera/sections.h"
#include "tessera/solid.h"
#include "tessera/tessellation.h"

namespace tessera { inline namespace abi_0_1 {

/// A model never changes.
struct CModel : Object {
  static constexpr Kind of_kind = Kind::model;
  explicit CModel(Model of) : Object(of_kind), model(std::move(of)) {}
  Model model;
};
/// Sets `out` to a new handle of the model, or returns its error.
inline CStatus give_model(tsr_model** out, Result<Model>&& model) {
  if (!model) return model.status();
  return give(out, std::make_shared<CModel>(*std::move(model)));
}

struct CSet : Object {
  static constexpr Kind of_kind = Kind::set;
  CSet(PatchSet of, std::shared_ptr<const CModel> from, std::optional<std::size_t> its_shape)
      : Object(of_kind), set(std::move(of)), model(std::move(from)), shape(its_shape) {}

  /// The map from surfaces to patches, made by the first call. Errors: those of SurfaceMap::make().
  Result<const SurfaceMap*> surface_map() {
    const std::lock_guard lock(found_mutex_);
    if (!map_) {
      Result<SurfaceMap> made = SurfaceMap::make(set);
      if (!made) return made.status();
      map_.emplace(*std::move(made));
    }
    return &*map_;
  }

  /// The parts of the work that look at every patch.
  struct Extent {
    std::uint64_t revision = 0;
    Box3 box;
    std::size_t memory_bytes = 0;
  };
  /// Returns the set's extent, found once for each revision.
  Extent extent() {
    const std::lock_guard lock(found_mutex_);
    if (!extent_ || extent_->revision != set.revision()) extent_ = {set.revision(), set.box(), set.memory_bytes()};
    return *extent_;
  }

  PatchSet set;
  std::shared_ptr<const CModel> model;  ///< what it was made of
  std::optional<std::size_t> shape;     ///< of the model, if it is one shape's
  Usage usage;

 private:
  std::mutex found_mutex_;
  std::optional<SurfaceMap> map_;
  std::optional<Extent> extent_;
};

struct CPlan : Object {
  static constexpr Kind of_kind = Kind::plan;
  CPlan(Tessellation of, std::shared_ptr<CSet> from, bool normals, bool edges)
      : Object(of_kind), plan(std::move(of)), set(std::move(from)), has_normals(normals), has_edges(edges) {}
  Tessellation plan;
  std::shared_ptr<CSet> set;
  bool has_normals, has_edges;
  Usage usage;
};

struct CScene : Object {
  static constexpr Kind of_kind = Kind::scene;
  CScene(RayScene of, std::shared_ptr<CSet> from) : Object(of_kind), set(std::move(from)), scene(std::move(of)) {}
  std::shared_ptr<CSet> set;  ///< outlives the scene, which refers to it
  RayScene scene;
  Usage usage;
};

/// Hits never change.
struct CHits : Object {
  static constexpr Kind of_kind = Kind::hits;
  CHits() : Object(of_kind) {}
  HitLists lists;
};

struct CPointScene : Object {
  static constexpr Kind of_kind = Kind::point_scene;
  CPointScene(PointScene of, std::shared_ptr<CSet> from)
      : Object(of_kind), set(std::move(from)), scene(std::move(of)) {}
  std::shared_ptr<CSet> set;  ///< outlives the scene, which refers to it
  PointScene scene;
  Usage usage;
};

/// A solid never changes, but its scene does.
struct CSolid : Object {
  static constexpr Kind of_kind = Kind::solid;
  CSolid(Solid of, std::shared_ptr<CScene> from)
      : Object(of_kind), scene(std::move(from)), set(scene->set), usage(scene->usage), solid(std::move(of)) {}
  std::shared_ptr<CScene> scene;  ///< outlives the solid, which refers to it
  std::shared_ptr<CSet> set;      ///< the scene's
  Usage& usage;                   ///< the scene's
  Solid solid;
};

/// Measures never change.
struct CMeasures : Object {
  static constexpr Kind of_kind = Kind::measures;
  CMeasures() : Object(of_kind) {}
  std::optional<AreaMeasures> areas;
  std::optional<std::vector<BodyMeasures>> bodies;
  std::optional<MeasuredBox> box;
};

/// Sections never change.
struct CSections : Object {
  static constexpr Kind of_kind = Kind::sections;
  explicit CSections(Sections of) : Object(of_kind), sections(std::move(of)) {}
  Sections sections;
};

/// The bytes of a file never change.
struct CBytes : Object {
  static constexpr Kind of_kind = Kind::bytes;
  explicit CBytes(std::string of) : Object(of_kind), bytes(std::move(of)) {}
  std::string bytes;
};

/// An object that was made of a set, and the set, which the call reads both.
template <class T>
class InUse {
 public:
  explicit InUse(const void* handle)
      : held_(handle), own_(held_ ? &held_->usage : nullptr), of_set_(held_ ? &held_->set->usage : nullptr) {}
  CStatus check() const {
    if (!held_) return held_.error();
    return own_ ? (of_set_ ? CStatus() : in_use(Object::Kind::set)) : in_use(T::of_kind);
  }
  T* operator->() const { return held_.operator->(); }
  std::shared_ptr<T> shared() const { return held_.shared(); }

 private:
  Held<T> held_;
  Reading own_, of_set_;
};

}}  // namespace tessera::abi_0_1
