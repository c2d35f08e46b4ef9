#pragma once
// Where one shape stands as another one sees it.

#include <opencascade/TopLoc_Location.hxx>

namespace tessera { inline namespace abi_0_1 {

/// Returns the inverse of a place, times `from`: nothing if they are the same. Faces and their edges nearly always
/// stand at one place, for which OpenCASCADE would multiply and allocate.
inline TopLoc_Location relative_place(const TopLoc_Location& from, const TopLoc_Location& place) {
  return from == place ? TopLoc_Location() : from.Predivided(place);
}

}}  // namespace tessera::abi_0_1
