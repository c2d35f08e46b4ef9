// OBJ meshes of other programs.

#include <gtest/gtest.h>

#include <cmath>

#include "io/mesh/mesh_formats.h"

namespace tessera { namespace {

using Indices = std::vector<std::uint32_t>;

const std::string obj_square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

std::string obj_error(const std::string& text) {
  const Result<Mesh> mesh = parse_obj(text, "m.obj");
  EXPECT_FALSE(mesh.ok()) << text;
  return mesh.ok() ? "" : mesh.status().message();
}

TEST(Obj, PolygonsBecomeFans) {
  const Result<Mesh> mesh = parse_obj(obj_square + "v 0 0 1\nf 1 2 3 4 5\n", "m.obj");
  ASSERT_TRUE(mesh.ok()) << mesh.status().message();
  EXPECT_EQ(mesh->indices, (Indices{0, 1, 2, 0, 2, 3, 0, 3, 4}));
}

TEST(Obj, NegativeIndicesCountFromTheLastVertex) {
  const Result<Mesh> mesh = parse_obj(obj_square + "f -4 -3 -2\nv 5 5 5\nf -1 1 -5\n", "m.obj");
  ASSERT_TRUE(mesh.ok()) << mesh.status().message();
  EXPECT_EQ(mesh->indices, (Indices{0, 1, 2, 4, 0, 0}));
}

TEST(Obj, GroupsObjectsAndMaterialsAreIgnored) {
  const Result<Mesh> mesh = parse_obj(
      "# x\r\nmtllib a/b.mtl\r\no pot\r\n\r\n" + obj_square + "g lid/top # 1\ns off\nusemtl a/b\n\tf 1 2 3 # last",
      "m.obj");
  ASSERT_TRUE(mesh.ok()) << mesh.status().message();
  EXPECT_EQ(mesh->vertex_count(), 4u);
  EXPECT_EQ(mesh->indices, (Indices{0, 1, 2}));
}

TEST(Obj, AttributesAreKeptWhereTheyAreOneAVertex) {
  const std::string attributes = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\nvn 0 0 1\nvn 0 0 1\nvn 0 0 1\n";
  const Result<Mesh> kept =
      parse_obj(obj_square + attributes + "f 1/1/1 2/2/2 3/3/3\nf -4/-4/-4 3/3/3 4/4/4\n", "m.obj");
  ASSERT_TRUE(kept.ok()) << kept.status().message();
  EXPECT_EQ(kept->normals.size(), 12u);
  EXPECT_EQ(kept->parameters.size(), 8u);
  const Result<Mesh> normals = parse_obj(obj_square + attributes + "f 1//1 2//2 3//3\n", "m.obj");
  ASSERT_TRUE(normals.ok()) << normals.status().message();
  EXPECT_EQ(normals->normals.size(), 12u);
  EXPECT_TRUE(normals->parameters.empty());
  const Result<Mesh> other = parse_obj(obj_square + "vn 0 0 1\nf 1//1 2//1 3//1\n", "m.obj");
  ASSERT_TRUE(other.ok()) << other.status().message();
  EXPECT_TRUE(other->normals.empty());
  EXPECT_EQ(other->indices, (Indices{0, 1, 2}));
}

TEST(Obj, NaNIsReadSoThatItCanBeCounted) {
  const Result<Mesh> mesh = parse_obj("v nan 0 0\nv 1 inf 0\nv 1 1 0\nf 1 2 3\n", "m.obj");
  ASSERT_TRUE(mesh.ok()) << mesh.status().message();
  EXPECT_TRUE(std::isnan(mesh->positions[0]));
  EXPECT_TRUE(std::isinf(mesh->positions[4]));
}

TEST(Obj, LinesMayBeContinued) {
  const Result<Mesh> mesh = parse_obj("v 0 0 0\nv 1 0 \\\n0\nv 1 1 0\nusemtl a \\\n b\nf 1 2\\\r\n 3\n", "m.obj");
  ASSERT_TRUE(mesh.ok()) << mesh.status().message();
  EXPECT_EQ(mesh->triangle_count(), 1u);
}

TEST(Obj, ErrorsNameTheLine) {
  EXPECT_EQ(obj_error("v 0 0\n"), "m.obj:1: expected 3 numbers after v, found the end of the line");
  EXPECT_EQ(obj_error("v 0 0 0\nv 0 x 0\n"), "m.obj:2: expected 3 numbers after v, found \"x\"");
  EXPECT_EQ(obj_error("v 0 0 0 1 1 1 1\n"), "m.obj:1: expected the end of the line, found \"1\"");
  EXPECT_EQ(obj_error(obj_square + "f 1 2\n"),
            "m.obj:5: expected at least 3 corners after f, found the end of the line");
  EXPECT_EQ(obj_error(obj_square + "f 1 2 5\n"),
            "m.obj:5: expected an index into the vertices above, 1 to 4 or -4 to -1, found \"5\"");
  EXPECT_EQ(obj_error(obj_square + "f 1 2 0\n"),
            "m.obj:5: expected an index into the vertices above, 1 to 4 or -4 to -1, found \"0\"");
  EXPECT_EQ(obj_error(obj_square + "f 1 2 -5\n"),
            "m.obj:5: expected an index into the vertices above, 1 to 4 or -4 to -1, found \"-5\"");
  EXPECT_EQ(obj_error(obj_square + "f 1 2 3.5\n"), "m.obj:5: expected an index of a corner, found \"3.5\"");
  EXPECT_EQ(obj_error(obj_square + "f 1/1 2/2 3/3\n"),
            "m.obj:5: expected no index, as there are no vt lines above, found \"1\"");
  EXPECT_EQ(obj_error("curv2 1 2\n"),
            "m.obj:1: expected a line of a mesh (v, vt, vn, f, g, o, s, usemtl, mtllib), found \"curv2\"");
  EXPECT_EQ(obj_error("# nothing\n"), "m.obj:1: expected vertices (v x y z), found the end of the file");
  EXPECT_EQ(obj_error("v 0 0 0\nf 99999999999999999999 1 1\n"),
            "m.obj:2: expected an index of a corner, found \"99999999999999999999\"");
}

}}  // namespace tessera
