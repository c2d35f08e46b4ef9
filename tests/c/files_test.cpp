// Models of bytes in memory, options of reading, and files as bytes, through C.

#include <filesystem>

#include "c/c_objects.h"
#include "support/scratch_folder.h"
#include "tessera/tessera_c_files.h"

namespace tessera::test { namespace {

tsr_read_options options_of(const char* format) {
  tsr_read_options options;
  tsr_read_defaults(&options);
  options.format = format;
  return options;
}

class CFiles : public testing::Test {
 protected:
  /// Reads bytes; the model lives as long as the test.
  tsr_status read(const std::string& bytes, const char* name, const tsr_read_options* options) {
    tsr_model* made = nullptr;
    const tsr_status status = tsr_model_read_bytes(&made, bytes.data(), bytes.size(), name, options, nullptr);
    EXPECT_EQ(made != nullptr, status == TSR_OK);
    model_.reset(made);
    return status;
  }
  std::size_t surfaces() const {
    tsr_model_info info = sized<tsr_model_info>();
    EXPECT_C(tsr_model_describe(model_.get(), &info));
    return info.surfaces;
  }

  /// A program in the place of tessera-cad-reader.
  std::string reader(const std::string& script) const {
    const std::string path = folder_.file("reader", "#!/bin/sh\n" + script + "\n");
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
    return path;
  }

  Handle<tsr_model> model_;
  const ScratchFolder folder_;
};

TEST_F(CFiles, TheNameOrTheOptionsStateTheFormat) {
  const std::string bpt = content_of(TESSERA_SOURCE_DIR "/tests/corpus/bpt/bilinear.bpt");
  ASSERT_C(read(bpt, "memory.bpt", nullptr));
  EXPECT_EQ(surfaces(), 2u);
  const tsr_read_options options = options_of("bpt");
  for (const char* const name : {static_cast<const char*>(nullptr), "upload", "other.json"}) {
    ASSERT_C(read(bpt, name, &options));
    EXPECT_EQ(surfaces(), 2u);
  }
  expect_c_error(read(bpt, nullptr, nullptr), TSR_UNSUPPORTED, "bytes: unsupported format \"\"");
  expect_c_error(read("nonsense", "upload", &options), TSR_PARSE_ERROR, "upload:1: ");
  expect_c_error(read("", "upload", &options), TSR_PARSE_ERROR, "upload: the file is empty");
  const tsr_read_options unknown = options_of("bmp");
  expect_c_error(read(bpt, "a.bpt", &unknown), TSR_UNSUPPORTED,
                 "a.bpt: unsupported format \".bmp\": surfaces are read");
  tsr_model* made = nullptr;
  ASSERT_C(tsr_model_read_file(&made, folder_.file("upload", bpt).c_str(), &options, nullptr));
  model_.reset(made);
  EXPECT_EQ(surfaces(), 2u);
}

TEST_F(CFiles, TheOptionsChooseTheReader) {
  const std::string program = reader("exit 11");
  tsr_read_options options = options_of("step");
  options.cad_reader = program.c_str();
  options.step_reader = TSR_STEP_READER_OPENCASCADE;
  expect_c_error(read("ISO-10303-21;", "part", &options), TSR_INTERNAL,
                 "part: the CAD reader " + program + " ended without a greeting (exit status 11)");
  tsr_model* made = nullptr;
  const std::string file = folder_.file("part", "ISO-10303-21;");
  expect_c_error(tsr_model_read_file(&made, file.c_str(), &options, nullptr), TSR_INTERNAL,
                 file + ": the CAD reader " + program + " ended without a greeting");
  // The library's reader starts no program.
  options.step_reader = TSR_STEP_READER_TESSERA;
  EXPECT_NE(read("ISO-10303-21;", "part", &options), TSR_OK);
  EXPECT_EQ(std::string(tsr_last_message(nullptr)).find("the CAD reader"), std::string::npos)
      << tsr_last_message(nullptr);
  // An interrupt ends the program.
  const std::string slow = reader("exec sleep 60");
  const volatile std::uint8_t cancel = 1;
  tsr_run run = sized<tsr_run>();
  run.cancel = &cancel;
  options.step_reader = TSR_STEP_READER_OPENCASCADE, options.cad_reader = slow.c_str();
  expect_c_error(tsr_model_read_file(&made, file.c_str(), &options, &run), TSR_CANCELLED, "cancelled");
}

TEST_F(CFiles, BadOptionsAreNamed) {
  tsr_model* made = nullptr;
  tsr_read_options options = options_of("bpt");
  const auto refused = [&](const std::string& words) {
    expect_c_error(read("x", "a", &options), TSR_INVALID_ARGUMENT, words);
    options = options_of("bpt");
  };
  for (const std::int32_t reader : {-1, 3}) {
    options.step_reader = reader;
    refused("tsr_read_options: step_reader is " + std::to_string(reader) + ", expected 0 to 2");
  }
  options.reserved = 1;
  refused("tsr_read_options: reserved is 1");
  options.struct_size = 8;
  refused("struct_size is 8");
  expect_c_error(tsr_model_read_bytes(&made, nullptr, 0, "a", nullptr, nullptr), TSR_INVALID_ARGUMENT,
                 "bytes is a null pointer");
  expect_c_error(tsr_model_read_bytes(nullptr, "", 0, "a", nullptr, nullptr), TSR_INVALID_ARGUMENT,
                 "model is a null pointer");
  expect_c_error(tsr_model_read_file(&made, nullptr, nullptr, nullptr), TSR_INVALID_ARGUMENT, "path is a null pointer");
  tsr_read_defaults(nullptr);
}

std::string bytes_of(const Handle<tsr_bytes>& bytes) {
  std::size_t size = 0;
  const void* const data = tsr_bytes_data(bytes.get(), &size);
  return std::string(static_cast<const char*>(data), size);
}

TEST(CBytes, AreThoseOfTheFiles) {
  const ScratchFolder folder;
  const Handle<tsr_set> set = set_of(wavy_field(2, 2));
  const Handle<tsr_plan> plan = plan_of(set.get(), 1e-2);
  MeshMemory memory(plan.get());
  const tsr_mesh mesh = memory.mesh();
  ASSERT_C(tsr_plan_write(plan.get(), &mesh, nullptr));
  for (const std::string name : {"a.obj", "a.ply", "a.stl", "a.glb", "a.gltf"}) {
    tsr_bytes* made = nullptr;
    ASSERT_C(tsr_mesh_bytes(&made, &mesh, set.get(), name.c_str())) << name;
    const Handle<tsr_bytes> bytes(made);
    ASSERT_C(tsr_mesh_save(&mesh, set.get(), (folder / name).c_str())) << name;
    EXPECT_TRUE(bytes_of(bytes) == content_of(folder / name)) << name;
    EXPECT_EQ(tsr_bytes_data(bytes.get(), nullptr), tsr_bytes_data(bytes.get(), nullptr));
  }
}

TEST(CBytes, OfModelsAndOfTheirShapes) {
  const ScratchFolder folder;
  const Handle<tsr_model> model = model_of(wavy_field(1, 2));
  for (const std::string name : {"m.json", "m.obj", "m.bpt"}) {
    tsr_bytes* made = nullptr;
    ASSERT_C(tsr_model_bytes(&made, model.get(), name.c_str())) << name;
    ASSERT_C(tsr_model_save(model.get(), (folder / name).c_str())) << name;
    EXPECT_TRUE(bytes_of(Handle<tsr_bytes>(made)) == content_of(folder / name)) << name;
  }
  tsr_model* joined_model = nullptr;
  ASSERT_C(tsr_model_join(&joined_model, model.get(), 0));
  const Handle<tsr_model> joined(joined_model);
  const Handle<tsr_set> set = set_of(joined.get(), 0, 0);
  const Handle<tsr_plan> plan = plan_of(set.get(), 1e-2);
  MeshMemory memory(plan.get());
  const tsr_mesh mesh = memory.mesh();
  ASSERT_C(tsr_plan_write(plan.get(), &mesh, nullptr));
  const tsr_mesh* const meshes[] = {&mesh};
  const tsr_set* const sets[] = {set.get()};
  tsr_bytes* made = nullptr;
  ASSERT_C(tsr_model_mesh_bytes(&made, joined.get(), meshes, sets, 1, "two.glb"));
  const Handle<tsr_bytes> bytes(made);
  ASSERT_C(tsr_model_save_meshes(joined.get(), meshes, sets, 1, (folder / "two.glb").c_str()));
  EXPECT_TRUE(bytes_of(bytes) == content_of(folder / "two.glb"));
  expect_c_error(tsr_model_mesh_bytes(&made, joined.get(), meshes, sets, 2, "two.glb"), TSR_COUNT_MISMATCH, "1 shapes");
  EXPECT_EQ(made, nullptr);
}

TEST(CBytes, OfModelsInPlaceOfCadFiles) {
  tsr_model *part = nullptr, *again = nullptr;
  ASSERT_C(tsr_model_read(&part, TESSERA_SOURCE_DIR "/tools/models/bearing_block.step", nullptr));
  const Handle<tsr_model> model(part);
  tsr_bytes* made = nullptr;
  ASSERT_C(tsr_model_cad_bytes(&made, model.get()));
  const std::string kept = bytes_of(Handle<tsr_bytes>(made));
  ASSERT_C(tsr_model_read_bytes(&again, kept.data(), kept.size(), "bearing_block.igs", nullptr, nullptr));
  const Handle<tsr_model> read(again);
  ASSERT_C(tsr_model_cad_bytes(&made, read.get()));
  EXPECT_TRUE(bytes_of(Handle<tsr_bytes>(made)) == kept);
  expect_c_error(tsr_model_read_bytes(&again, kept.data(), kept.size() - 1, "part.igs", nullptr, nullptr),
                 TSR_PARSE_ERROR, "part.igs: a model that was read before, found");
  expect_c_error(tsr_model_cad_bytes(&made, model_of(wavy_field(1, 1)).get()), TSR_UNSUPPORTED, "must be a B-spline",
                 0);
  expect_c_error(tsr_model_cad_bytes(&made, nullptr), TSR_INVALID_HANDLE, "is null");
  expect_c_error(tsr_model_cad_bytes(nullptr, model.get()), TSR_INVALID_ARGUMENT, "bytes is a null");
}

TEST(CBytes, ErrorsNameTheFile) {
  const Handle<tsr_model> model = model_of(wavy_field(1, 1));
  const Handle<tsr_set> set = set_of(model.get());
  tsr_bytes* made = nullptr;
  tsr_mesh none = sized<tsr_mesh>();
  expect_c_error(tsr_mesh_bytes(&made, &none, nullptr, "a.xyz"), TSR_UNSUPPORTED, "a.xyz: unsupported format");
  expect_c_error(tsr_mesh_bytes(&made, &none, nullptr, "a.ply"), TSR_INVALID_ARGUMENT, "a.ply: ");
  expect_c_error(tsr_mesh_bytes(&made, &none, nullptr, nullptr), TSR_INVALID_ARGUMENT, "name is a null");
  expect_c_error(tsr_mesh_bytes(nullptr, &none, nullptr, "a.ply"), TSR_INVALID_ARGUMENT, "bytes is a null");
  expect_c_error(tsr_model_bytes(&made, model.get(), "a.ply"), TSR_UNSUPPORTED, "a.ply: unsupported format");
  expect_c_error(tsr_model_bytes(&made, nullptr, "a.bpt"), TSR_INVALID_HANDLE, "is null");
  std::size_t size = 7;
  EXPECT_EQ(tsr_bytes_data(reinterpret_cast<const tsr_bytes*>(model.get()), &size), nullptr);
  EXPECT_EQ(size, 0u);
}

}}  // namespace tessera::test
