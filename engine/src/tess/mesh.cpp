#include "tessera/mesh.h"

namespace tessera {

MeshViews Mesh::views() {
  MeshViews views;
  views.position = View3<float>::interleaved(positions);
  if (!normals.empty()) views.normal = View3<float>::interleaved(normals);
  if (!parameters.empty()) views.parameter = View2<float>::interleaved(parameters);
  views.patch = patches;
  views.indices = indices;
  return views;
}

}  // namespace tessera
