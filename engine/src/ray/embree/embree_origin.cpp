#include "ray/embree/embree_origin.h"

#include <algorithm>
#include <cstring>
#include <iterator>

namespace tessera { inline namespace abi_0_1 {

#if RTC_VERSION_MAJOR < 4
namespace {

// The mark lies in the flags of Embree 3's contexts, of which Embree uses the lowest bit and ignores the others.
// rtcInitIntersectContext() clears all, so no plain context has it.
constexpr unsigned origin_mark = 0x7e550000, origin_mark_bits = 0xffff0000;

// Flags are copied as bytes: their enumeration has no value with the mark.
unsigned flags_of(const RTCIntersectContext& context) {
  unsigned flags;
  static_assert(sizeof flags == sizeof context.flags);
  std::memcpy(&flags, &context.flags, sizeof flags);
  return flags;
}

void set_flags(unsigned flags, RTCIntersectContext& context) { std::memcpy(&context.flags, &flags, sizeof flags); }

}  // namespace

bool has_origins(const EmbreeContext& context, bool /*promised*/) {
  return (flags_of(context) & origin_mark_bits) == origin_mark;
}

void EmbreeOriginContext::set_coherent(bool coherent) {
  const RTCIntersectContextFlags coherence =
      coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  set_flags(origin_mark | static_cast<unsigned>(coherence), *this);
}
#else
bool has_origins(const EmbreeContext& /*context*/, bool promised) { return promised; }
#endif

EmbreeOrigin::EmbreeOrigin() {
  std::fill(std::begin(instance), std::end(instance), RTC_INVALID_GEOMETRY_ID);
#ifdef RTC_GEOMETRY_INSTANCE_ARRAY
  std::fill(std::begin(instance_primitive), std::end(instance_primitive), RTC_INVALID_GEOMETRY_ID);
#endif
}

EmbreeOrigin::EmbreeOrigin(const RTCHit& hit)
    : geometry(hit.geomID), patch(hit.primID), u(double{hit.u}), v(double{hit.v}) {
  std::copy(std::begin(hit.instID), std::end(hit.instID), instance);
#ifdef RTC_GEOMETRY_INSTANCE_ARRAY
  std::copy(std::begin(hit.instPrimID), std::end(hit.instPrimID), instance_primitive);
#endif
}

EmbreeOriginContext::EmbreeOriginContext(std::span<const EmbreeOrigin> from)
    : EmbreeQueryContext(embree_context()), origins(from) {
#if RTC_VERSION_MAJOR < 4
  set_coherent(false);
#endif
}

EmbreeOriginContext::EmbreeOriginContext(const EmbreeOrigin& origin) : EmbreeOriginContext(std::span(&origin, 1)) {}

const EmbreeOrigin* origin_of(const EmbreeContext& context, unsigned ray) {
  const std::span<const EmbreeOrigin> origins = static_cast<const EmbreeOriginContext&>(context).origins;
  if (origins.size() == 1) return origins.data();
  return ray < origins.size() ? &origins[ray] : nullptr;
}

bool names(const EmbreeOrigin& origin, unsigned geometry, const EmbreeContext& context) {
#ifdef RTC_GEOMETRY_INSTANCE_ARRAY
  if (!std::equal(std::begin(context.instPrimID), std::end(context.instPrimID), origin.instance_primitive))
    return false;
#endif
  return origin.geometry == geometry &&
         std::equal(std::begin(context.instID), std::end(context.instID), origin.instance);
}

}}  // namespace tessera::abi_0_1
