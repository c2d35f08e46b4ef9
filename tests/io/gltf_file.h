#pragma once
// glTF files as another library reads them.

#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include <string>

namespace tessera::test {

inline tinygltf::Model read_gltf(const std::string& path) {
  tinygltf::Model model;
  std::string error, warning;
  tinygltf::TinyGLTF reader;
  const bool read = path.ends_with(".glb") ? reader.LoadBinaryFromFile(&model, &error, &warning, path)
                                           : reader.LoadASCIIFromFile(&model, &error, &warning, path);
  EXPECT_TRUE(read) << error;
  EXPECT_EQ(error + warning, "");
  return model;
}

}  // namespace tessera::test
