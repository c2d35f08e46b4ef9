#pragma once
// Handles of the C interface: numbers that look like pointers, and the objects that they stand for.
//
// A handle is the place of an object in a table and a count of the objects that were there before. So a handle that was
// released is told from every other, without reading memory that was freed.

#include <cstdint>
#include <memory>

namespace tessera { inline namespace abi_0_1 {

/// An object that a handle stands for.
class Object {
 public:
  enum class Kind : std::uint8_t { model, set, plan, scene, hits, point_scene, solid, measures, sections, bytes };
  explicit Object(Kind kind) : kind_(kind) {}
  virtual ~Object() = default;
  Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

/// Makes a handle with one reference. Throws std::bad_alloc.
void* add_handle(std::shared_ptr<Object> object);
/// Adds a reference. Returns whether the handle stands for an object.
bool retain_handle(const void* handle);
/// Gives up a reference. Returns whether there was one.
bool release_handle(const void* handle);

/// Holds the object of a handle for the time of a call, even if another thread releases the handle meanwhile.
class Pin {
 public:
  explicit Pin(const void* handle);
  Pin(const Pin&) = delete;
  Pin& operator=(const Pin&) = delete;
  ~Pin();
  /// The object; null if the handle stands for none.
  const std::shared_ptr<Object>* object() const { return object_; }

 private:
  std::uint32_t place_ = 0;
  const std::shared_ptr<Object>* object_ = nullptr;
};

/// The table is locked while a process is forked, so that the child finds it whole.
void lock_handles();
void unlock_handles();

}}  // namespace tessera::abi_0_1
