#pragma once
// Models of shapes that a program of OpenCASCADE holds in memory. Includes OpenCASCADE's own headers, in whose folder
// the compiler must look.
//
// Surfaces, edges, instances and their exactness are those that OpenCASCADE's reader of cad.h gives for a file of the
// shape: a part that stands at several places is one Shape with several instances. Names, colours and the unit, which a
// shape does not have, are empty. Messages number faces from 0, in the order of the shape.
//
// Memory: results own theirs. Threads: calls read shapes by OpenCASCADE's const functions, so that any number of
// threads may read the same shapes meanwhile, and none may change them.

#include <TopoDS_Shape.hxx>

#include "tessera/execution.h"
#include "tessera/model.h"
#include "tessera/status.h"

#pragma GCC visibility push(default)
namespace tessera { inline namespace abi_0_1 {

/// A model that is made of a shape of OpenCASCADE.
struct OcctModel {
  Model model;  ///< lengths are the shape's
};

/// Makes a model of all faces of a shape. A face that cannot be converted is left out, with a warning of the model: a
/// face without a surface (a triangulation alone), an unbounded one, one that OpenCASCADE cannot fit.
///
/// Errors: invalid_argument (the shape is null or has no faces), the first warning's reason (no face is left),
/// cancelled, out_of_memory, internal (an exception of OpenCASCADE, with its type and message). Exceptions of
/// OpenCASCADE do not leave the call.
Result<OcctModel> model_from(const TopoDS_Shape& shape, const Execution& execution = {});

}}  // namespace tessera::abi_0_1
#pragma GCC visibility pop
