#include <opencascade/TopExp_Explorer.hxx>

#include "occt/guarded_calls.h"
#include "occt/shape_model.h"
#include "tessera/occt.h"

namespace tessera { inline namespace abi_0_1 {

Result<OcctModel> model_from(const TopoDS_Shape& shape, const Execution& execution) {
  return guarded_occt([&]() -> Result<OcctModel> {
    if (shape.IsNull()) return Status(StatusCode::invalid_argument, "the shape is null");
    if (!TopExp_Explorer(shape, TopAbs_FACE).More())
      return Status(StatusCode::invalid_argument, "the shape has no faces");
    DescribedShape described;
    described.shape = shape;
    return model_of(described, {}, execution);
  });
}

}}  // namespace tessera::abi_0_1
