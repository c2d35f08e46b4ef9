#include "ray/embree/embree_device.h"

#include <algorithm>
#include <cfenv>
#include <utility>

namespace tessera { inline namespace abi_0_1 {
namespace {

StatusCode status_code(RTCError error) {
  switch (error) {
    case RTC_ERROR_OUT_OF_MEMORY:
      return StatusCode::out_of_memory;
    case RTC_ERROR_CANCELLED:
      return StatusCode::cancelled;
    case RTC_ERROR_UNSUPPORTED_CPU:
      return StatusCode::unsupported;
    default:
      return StatusCode::internal;
  }
}

bool not_cancelled(void* cancel, double) {
  return !static_cast<const std::atomic<bool>*>(cancel)->load(std::memory_order_relaxed);
}

/// Rounds to nearest for its lifetime, without floating-point exceptions; then restores the caller's modes. Embree's
/// SSE2 builder turns floats into bins by the current rounding. Rounding up or down gives bins that don't exist, and an
/// assertion of Embree ends the process. Embree hands this thread's modes to the threads that build.
class RoundToNearest {
 public:
  RoundToNearest() {
    std::feholdexcept(&caller_);
    std::fesetround(FE_TONEAREST);
  }
  RoundToNearest(const RoundToNearest&) = delete;
  RoundToNearest& operator=(const RoundToNearest&) = delete;
  ~RoundToNearest() { std::fesetenv(&caller_); }

 private:
  std::fenv_t caller_;
};

}  // namespace

void EmbreeMonitor::on_error(void* self, RTCError code, const char* text) {
  auto& monitor = *static_cast<EmbreeMonitor*>(self);
  const std::lock_guard lock(monitor.mutex_);
  if (monitor.error_ != RTC_ERROR_NONE) return;
  monitor.error_ = code;
  try {
    monitor.message_ = text ? text : "";
  } catch (...) {  // the code alone must do
  }
}

bool EmbreeMonitor::on_memory(void* self, ssize_t bytes, bool) {
  static_cast<EmbreeMonitor*>(self)->bytes_ += bytes;
  return true;
}

Status EmbreeMonitor::take() {
  const std::lock_guard lock(mutex_);
  const RTCError code = std::exchange(error_, RTC_ERROR_NONE);
  if (code == RTC_ERROR_NONE) return {};
  if (code == RTC_ERROR_CANCELLED) return Status(StatusCode::cancelled, "cancelled by the caller");
  return Status(status_code(code), "Embree: " + std::exchange(message_, {}));
}

std::size_t EmbreeMonitor::bytes() const {
  return static_cast<std::size_t>(std::max<std::ptrdiff_t>(bytes_.load(), 0));
}

Status make_device(EmbreeMonitor& monitor, Owned<RTCDevice, DeviceRelease>& device, std::optional<Isa> isa) {
  // No thread is started or bound to a core: the work runs in the caller's arena.
  std::string options = "verbose=0,start_threads=0,set_affinity=0";
  if (isa && *isa != Isa::neon64) options += ",isa=" + std::string(name(*isa));
  device.reset(rtcNewDevice(options.c_str()));
  if (!device) return Status(status_code(rtcGetDeviceError(nullptr)), "Embree: no device could be made");
  rtcSetDeviceErrorFunction(device.get(), &EmbreeMonitor::on_error, &monitor);
  rtcSetDeviceMemoryMonitorFunction(device.get(), &EmbreeMonitor::on_memory, &monitor);
  return {};
}

Status commit(RTCScene scene, EmbreeMonitor& monitor, const Execution& execution) {
  if (execution.cancel) {
    rtcSetSceneProgressMonitorFunction(scene, &not_cancelled, const_cast<std::atomic<bool>*>(execution.cancel));
  }
  // With TBB rtcJoinCommitScene would work in an arena of Embree's own; this call works in the caller's.
  monitor.tasks_.run([scene] {
    const RoundToNearest nearest;
    rtcCommitScene(scene);
  });
  rtcSetSceneProgressMonitorFunction(scene, nullptr, nullptr);
  return monitor.take();
}

}}  // namespace tessera::abi_0_1
