// libFuzzer: any bytes in place of those of the program that reads CAD files must become a model whose ids hold, or an
// error, in time and memory that the length of the input bounds. A model must have the same bytes again.

#include <cstdlib>
#include <string>
#include <string_view>

#include "io/cad/model_bytes.h"
#include "tessera/topology.h"

namespace {

using namespace tessera;

void require(bool holds) {
  if (!holds) std::abort();
}

void use(const Shape& shape) {
  const Result<EdgeUses> uses = edge_uses(shape);
  const Result<std::vector<bool>> closed = closed_shells(shape);
  require(uses.ok() && uses->first.size() == shape.edges.size() + 1 && closed.ok());
  require(closed->size() == shape.shells.size());
  if (const Result<std::vector<double>> gaps = edge_gaps(shape, 3); gaps.ok())
    require(gaps->size() == shape.edges.size());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  const Result<Model> model = model_from_bytes(std::string_view(reinterpret_cast<const char*>(data), size));
  if (!model.ok()) {
    require(model.status().code() != StatusCode::out_of_memory);
    return 0;
  }
  require(check_topology(*model).ok());
  for (const Shape& shape : model->shapes) use(shape);
  const std::string bytes = to_bytes(model);
  const Result<Model> again = model_from_bytes(bytes);
  require(again.ok() && to_bytes(again) == bytes);
  return 0;
}
