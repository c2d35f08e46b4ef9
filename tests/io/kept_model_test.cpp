// Models that were read before stand in place of their CAD files.

#include <gtest/gtest.h>

#include "io/cad/kept_model.h"
#include "io/cad/model_bytes.h"
#include "support/errors.h"
#include "support/scratch_folder.h"
#include "tessera/cad.h"
#include "tessera/io.h"
#include "tessera/nurbs_surface.h"

namespace tessera::test { namespace {

class KeptModel : public testing::Test {
 protected:
  static Model part() {
    Model model{"part", {}, {"a warning"}};
    model.surfaces.push_back({"ball", value_of(make_nurbs_sphere({}, 2)), Affine::translated({1, 2, 3})});
    model.unit = "mm";
    return model;
  }
  /// Parses bytes where no program can read the file itself.
  static Result<Model> parsed(const std::string& bytes, const char* name = "folder/part.igs") {
    return parse_cad(bytes, name, {.reader = "/nowhere/reader"});
  }

  const std::string bytes_ = value_of(cad_model_bytes(part()));
  const ScratchFolder folder_;
};

TEST_F(KeptModel, IsReadAsTheFileWithoutAProgram) {
  for (const char* const name : {"part.igs", "part.IGES", "part.brep", "part.step", "part.igs.gz"}) {
    const Model read = value_of(parsed(bytes_, name));
    EXPECT_EQ(to_bytes(read), to_bytes(part())) << name;
    const std::string path = folder_.file(name, bytes_);
    EXPECT_EQ(to_bytes(value_of(read_cad(path, {.reader = "/nowhere/reader"}))), to_bytes(part())) << name;
    EXPECT_EQ(to_bytes(value_of(read_model(path))), to_bytes(part())) << name;
    EXPECT_EQ(to_bytes(value_of(parse_model(bytes_, name))), to_bytes(part())) << name;
  }
}

TEST_F(KeptModel, EachPartOfTheBytesIsAnError) {
  const std::string name = "folder/part.igs: ";
  for (std::size_t size = greeting_begin.size(); size < bytes_.size(); ++size) {
    const Result<Model> read = parsed(bytes_.substr(0, size));
    ASSERT_FALSE(read.ok()) << size;
    EXPECT_EQ(read.status().code(), StatusCode::parse_error) << size << read.status().message();
  }
  expect_refused(parsed(bytes_.substr(0, 70)), StatusCode::parse_error, Status::no_index,
                 name + "a model that was read before, cut off after 70 bytes, expected 72 before the model");
  expect_refused(parsed(bytes_ + "!"), StatusCode::parse_error, Status::no_index,
                 name + "a model that was read before, found ");
  std::string damaged = bytes_;
  damaged[greeting_size + 8] = 100;  // no status has this number
  expect_refused(parsed(damaged), StatusCode::parse_error, Status::no_index, name + "a damaged model");
  std::string other = bytes_;
  other[greeting_begin.size()] = '9';
  expect_refused(parsed(other), StatusCode::unsupported, Status::no_index,
                 name + "a model that was read before by \"tessera-cad-reader 9");
}

TEST_F(KeptModel, HoldsSplinesAlone) {
  Model model = part();
  model.surfaces.push_back({"flat", value_of(BezierPatch::polynomial(1, 1, std::vector<Vec3>(4)))});
  expect_refused(cad_model_bytes(model), StatusCode::unsupported, 1, "surface 1 (flat): it must be a B-spline");
  model.surfaces.pop_back();
  Shape shape;
  shape.name = std::string("box");
  shape.faces.push_back({{"flat", value_of(BezierPatch::polynomial(1, 1, std::vector<Vec3>(4)))}});
  model.shapes = {shape};
  expect_refused(cad_model_bytes(model), StatusCode::unsupported, Status::no_index,
                 "a face of shape \"box\" must be a B-spline");
}

}}  // namespace tessera::test
