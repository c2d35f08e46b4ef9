// Malformed files: errors with their reason, and no harm.

#include <gtest/gtest.h>
#include <opencascade/BRepAlgoAPI_Cut.hxx>
#include <opencascade/BRepBuilderAPI_MakeFace.hxx>
#include <opencascade/BRepPrimAPI_MakeBox.hxx>
#include <opencascade/BRepPrimAPI_MakeCylinder.hxx>
#include <opencascade/BRepPrimAPI_MakeTorus.hxx>
#include <opencascade/BRep_Builder.hxx>
#include <opencascade/Geom_BSplineSurface.hxx>
#include <opencascade/Geom_BezierSurface.hxx>
#include <opencascade/TColgp_Array2OfPnt.hxx>
#include <opencascade/TopoDS_Compound.hxx>

#include <array>
#include <atomic>
#include <random>
#include <thread>

#include "io_occt/cad_shapes.h"
#include "support/errors.h"
#include "support/scratch_folder.h"
#include "tessera/cad.h"
#include "tessera/io.h"

namespace tessera::test { namespace {

/// A small part that has planes, splines and a hole.
TopoDS_Shape part() {
  return BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(4, 3, 2).Shape(),
                         BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(2, 1, -1), gp_Dir(0, 0, 1)), 0.5, 9).Shape())
      .Shape();
}

std::string part_text(const ScratchFolder& folder, const char* name) {
  write_cad(part(), folder / name);
  return content_of(folder / name);
}

/// A face on a surface that the parameters make wavy.
TopoDS_Shape bezier_face(int degree, bool rational) {
  TColgp_Array2OfPnt poles(1, degree + 1, 1, 3);
  TColStd_Array2OfReal weights(1, degree + 1, 1, 3);
  weights.Init(1);
  for (int i = 1; i <= degree + 1; ++i)
    for (int j = 1; j <= 3; ++j) poles(i, j) = gp_Pnt(i, j, (i * j) % 3);
  if (rational) weights(2, 2) = 0.625;
  return BRepBuilderAPI_MakeFace(new Geom_BezierSurface(poles, weights), 1e-7).Shape();
}

TEST(ReadCad, CutFilesAreRefused) {
  const ScratchFolder folder;
  for (const char* const name : {"part.step", "part.igs", "part.brep", "part.binary.brep"}) {
    const std::string whole = part_text(folder, name);
    for (std::size_t k = 0; k < 60; ++k) {
      // The end of the last line may be missing.
      const std::size_t size = k * (whole.size() - 90) / 59;
      const Result<Model> model = read_by_opencascade(folder.file(name, whole.substr(0, size)));
      ASSERT_FALSE(model.ok()) << name << " cut after " << size << " of " << whole.size() << " bytes";
      EXPECT_EQ(model.status().code(), StatusCode::parse_error) << model.status().message();
      EXPECT_EQ(model.status().message().find(folder / name + ":"), 0u) << model.status().message();
    }
  }
}

TEST(ReadCad, DamagedFilesDoNoHarm) {
  const ScratchFolder folder;
  std::mt19937 random(3);
  std::size_t read = 0, refused = 0, crashed = 0;
  for (const char* const name : {"part.step", "part.igs", "part.brep", "part.binary.brep"}) {
    const std::string whole = part_text(folder, name);
    for (int k = 0; k < 60; ++k) {
      std::string damaged = whole;
      for (int hit = 0; hit < 1 + k / 4; ++hit)
        damaged[random() % damaged.size()] = "0123456789,.;#DE -()'"[random() % 21];
      const Result<Model> model = read_by_opencascade(folder.file(name, damaged));
      if (model) {
        ++read;
        EXPECT_FALSE(model->surfaces.empty());
      } else {
        ++refused;
        EXPECT_EQ(model.status().message().find(folder / name + ":"), 0u) << model.status().message();
        crashed += model.status().message().find("OpenCASCADE crashed") != std::string::npos;
      }
    }
  }
  std::printf("of 240 damaged files %zu are read and %zu refused, %zu of them since OpenCASCADE crashed\n", read,
              refused, crashed);
}

TEST(ReadCad, OtherFilesAreRefused) {
  const ScratchFolder folder;
  const auto expect = [&](const std::string& path, StatusCode code, const std::string& words) {
    expect_refused(read_by_opencascade(path), code, Status::no_index, words);
  };
  expect(folder.file("text.step", "A letter,\nnot a part.\n"), StatusCode::parse_error,
         "text.step: OpenCASCADE cannot read it as STEP: Line 2: Incorrect syntax");
  expect(folder.file("text.igs", "A letter,\nnot a part.\n"), StatusCode::parse_error,
         "text.igs:1: this is not IGES: the first line has no S in column 73");
  std::string binary(73, ' ');
  binary.back() = 'B';
  binary.resize(3073);
  expect(folder.file("noise.iges", binary), StatusCode::unsupported, "IGES in its binary form");
  expect(folder.file("text.brep", "A letter,\nnot a part.\n"), StatusCode::parse_error,
         "text.brep: this is not BREP: it does not begin with \"CASCADE Topology V\"");
  expect(folder.file("new.brep", "\nCASCADE Topology V9, (c) Nobody\n"), StatusCode::parse_error,
         "new.brep: OpenCASCADE cannot read it as BREP: ");
  expect(folder.file("empty.step", ""), StatusCode::parse_error, "empty.step: the file is empty");
  expect(folder.file("empty.igs", ""), StatusCode::parse_error, "empty.igs: the file is empty");
  expect(folder / "none.stp", StatusCode::io_error, "none.stp: cannot be opened: No such file");
  std::filesystem::create_directory(folder / "folder.igs");
  expect(folder / "folder.igs", StatusCode::io_error, "folder.igs: is a directory");
  expect(folder.file("part.dxf", "0"), StatusCode::unsupported,
         "are read as .brep, .brp, .iges, .igs, .p21, .step, .stp, .stpz");
  const std::string step = part_text(folder, "part.step");
  expect_refused(read_by_opencascade(folder.file("part.step", step), {.format = CadFormat::iges}),
                 StatusCode::parse_error, Status::no_index, "this is not IGES");
}

TEST(ReadCad, UnreadableFacesAreNamedAndLeftOut) {
  const ScratchFolder folder;
  write_cad(bezier_face(18, false), folder / "steep.step");
  expect_refused(read_by_opencascade(folder / "steep.step"), StatusCode::unsupported_degree, Status::no_index,
                 "is left out: degree u is 18, it must be 1 to 15; the file holds 1 SHELL_BASED_SURFACE_MODEL, "
                 "1 ADVANCED_FACE");

  TopoDS_Compound both;
  BRep_Builder().MakeCompound(both);
  BRep_Builder().Add(both, bezier_face(18, false));
  BRep_Builder().Add(both, bezier_face(3, false));
  write_cad(both, folder / "both.step");
  const Result<Model> model = read_by_opencascade(folder / "both.step");
  ASSERT_TRUE(model.ok()) << model.status().message();
  EXPECT_EQ(model->surfaces.size(), 1u);
  ASSERT_EQ(model->warnings.size(), 1u);
  EXPECT_EQ(model->warnings[0].find(folder / "both.step" + ": face #"), 0u) << model->warnings[0];
  EXPECT_NE(model->warnings[0].find("is left out: degree u is 18"), std::string::npos) << model->warnings[0];
}

TEST(ReadCad, NegativeWeightsAreRefused) {
  const ScratchFolder folder;
  std::string messages;
  for (const char* const name : {"weight.step", "weight.igs"}) {
    write_cad(bezier_face(3, true), folder / name);
    ASSERT_TRUE(read_by_opencascade(folder / name).ok());
    std::string text = content_of(folder / name);
    const std::size_t place = text.find("0.625");
    ASSERT_NE(place, std::string::npos);
    text.replace(place, 5, "-.125");
    const Result<Model> model = read_by_opencascade(folder.file(name, text));
    ASSERT_FALSE(model.ok()) << name;
    EXPECT_EQ(model.status().message().find(folder / name + ":"), 0u) << model.status().message();
    messages += model.status().message() + '\n';
  }
  EXPECT_NE(messages.find(": Surface has not been created"), std::string::npos) << messages;
  EXPECT_NE(messages.find(": surface D3: weight [1][1] is -0.125, it must be greater than 0"), std::string::npos)
      << messages;
}

TEST(ReadCad, PrintsNothing) {
  const ScratchFolder folder;
  const std::string path = folder / "part.step", bad = folder.file("bad.step", "ISO-10303-21;\nHEADER;\nnonsense");
  write_cad(part(), path);
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  const bool read = read_by_opencascade(path).ok(), refused = !read_by_opencascade(bad).ok();
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_TRUE(read && refused);
}

TEST(ReadCad, ManyThreadsReadAtOnce) {
  const ScratchFolder folder;
  write_cad(part(), folder / "part.step");
  write_cad(part(), folder / "part.igs");
  write_cad(part(), folder / "part.brep");
  const std::array names{"part.step", "part.igs", "part.brep"};
  std::atomic<int> good{0};
  std::vector<std::thread> threads;
  for (int k = 0; k < 8; ++k)
    threads.emplace_back([&, k] {
      for (int round = 0; round < 3; ++round) {
        const Result<Model> model = read_by_opencascade(folder / names[(k + round) % 3]);
        good += model.ok() && model->surfaces.size() == 7;
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(good, 24);
}

}}  // namespace tessera::test
