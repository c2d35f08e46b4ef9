#pragma once
// Embree's handles and error reports, for the files of this floor that call Embree.

#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <type_traits>

#include "parallel/tbb_loop.h"
#include "ray/embree/embree_api.h"
#include "tessera/execution.h"
#include "tessera/status.h"

namespace tessera { inline namespace abi_0_1 {

struct SceneRelease {
  void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
struct DeviceRelease {
  void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
};
struct GeometryRelease {
  void operator()(RTCGeometry geometry) const { rtcReleaseGeometry(geometry); }
};
template <class Handle, class Release>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Release>;

/// Collects what Embree reports through its callbacks, from any thread. Errors: the constructor throws std::bad_alloc.
class EmbreeMonitor {
 public:
  /// Returns the first error since the last call, as a Status.
  Status take();
  std::size_t bytes() const;

 private:
  friend Status make_device(EmbreeMonitor& monitor, Owned<RTCDevice, DeviceRelease>& device, std::optional<Isa> isa);
  friend Status commit(RTCScene scene, EmbreeMonitor& monitor, const Execution& execution);
  static void on_error(void* self, RTCError code, const char* text);
  static bool on_memory(void* self, ssize_t bytes, bool);

  std::atomic<std::ptrdiff_t> bytes_{0};
  std::mutex mutex_;
  RTCError error_ = RTC_ERROR_NONE;  // the first since it was last taken
  std::string message_;
  ApartTasks tasks_;  ///< Embree keeps task groups below this one as long as its scenes live
};

/// Makes a device that starts no thread and binds none. `isa` limits Embree's own kernels, by default to the machine's
/// best. The monitor must outlive the device. Errors: internal, out_of_memory.
Status make_device(EmbreeMonitor& monitor, Owned<RTCDevice, DeviceRelease>& device, std::optional<Isa> isa = {});

/// Commits a scene in the caller's arena, for any rounding mode of the caller's thread. Errors: cancelled, Embree's
/// own.
Status commit(RTCScene scene, EmbreeMonitor& monitor, const Execution& execution);

}}  // namespace tessera::abi_0_1
