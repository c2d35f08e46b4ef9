// Models do not depend on threads, and shapes may be read meanwhile.

#include <gtest/gtest.h>
#include <tbb/task_arena.h>
#include <opencascade/BRepAdaptor_Curve.hxx>
#include <opencascade/BRepAdaptor_Surface.hxx>
#include <opencascade/TopExp_Explorer.hxx>
#include <opencascade/TopoDS.hxx>

#include <atomic>
#include <thread>

#include "occt/occt_shapes.h"
#include "tessera/occt.h"
#include "tessera/throw.h"

namespace tessera::test { namespace {

void expect_same(const OcctModel& a, const OcctModel& b, const std::string& name) {
  EXPECT_EQ(a.model.warnings, b.model.warnings) << name;
  ASSERT_EQ(a.model.surfaces.size(), b.model.surfaces.size()) << name;
  for (std::size_t k = 0; k < a.model.surfaces.size(); ++k) {
    const auto& one = std::get<BSplineSurface>(a.model.surfaces[k].surface);
    const auto& other = std::get<BSplineSurface>(b.model.surfaces[k].surface);
    EXPECT_TRUE(std::ranges::equal(one.points(), other.points()) && one.domain() == other.domain()) << name;
    EXPECT_TRUE(a.face(k).IsEqual(b.face(k))) << name;
    EXPECT_TRUE(*a.model.surfaces[k].trims == *b.model.surfaces[k].trims) << name;
  }
  ASSERT_EQ(a.model.shapes.size(), b.model.shapes.size()) << name;
  for (std::size_t k = 0; k < a.model.shapes.size(); ++k)
    for (std::size_t edge = 0; edge < a.model.shapes[k].edges.size(); ++edge)
      EXPECT_TRUE(a.model.shapes[k].edges[edge].curve == b.model.shapes[k].edges[edge].curve) << name;
}

TEST(ShapeThreads, ModelsAreTheSameForAnyNumber) {
  std::vector<TopoDS_Shape> all;
  for (const NamedShape& one : occt_shapes()) all.push_back(one.shape);
  const TopoDS_Compound shape = compound_of(all);
  const auto made_by = [&](int threads) {
    tbb::task_arena arena(threads);
    return arena.execute([&] { return value_or_throw(model_from(shape)); });
  };
  const OcctModel alone = made_by(1);
  for (const int threads : {2, 7}) expect_same(alone, made_by(threads), std::to_string(threads) + " threads");
}

/// Evaluates all faces and edges of a shape, as a viewer does.
double read_all(const TopoDS_Shape& shape) {
  double sum = 0;
  for (TopExp_Explorer face(shape, TopAbs_FACE); face.More(); face.Next()) {
    const BRepAdaptor_Surface surface(TopoDS::Face(face.Current()));
    sum += surface.Value(surface.FirstUParameter(), surface.FirstVParameter()).X();
  }
  for (TopExp_Explorer edge(shape, TopAbs_EDGE); edge.More(); edge.Next()) {
    const BRepAdaptor_Curve curve(TopoDS::Edge(edge.Current()));
    if (curve.Is3DCurve()) sum += curve.Value(curve.LastParameter()).Y();
  }
  return sum;
}

TEST(ShapeThreads, AnotherThreadMayReadTheShape) {
  std::vector<TopoDS_Shape> parts;
  for (const NamedShape& one : occt_shapes()) parts.push_back(one.shape);
  const TopoDS_Compound shape = compound_of(parts);
  const double sum = read_all(shape);
  const OcctModel first = value_or_throw(model_from(shape));
  std::atomic<bool> stop{false};
  std::atomic<int> rounds{0}, wrong{0};
  std::vector<std::thread> readers;
  for (int k = 0; k < 2; ++k)
    readers.emplace_back([&] {
      while (!stop || rounds < 4) {
        wrong += read_all(shape) != sum;
        ++rounds;
      }
    });
  std::thread other([&] { expect_same(value_or_throw(model_from(shape)), first, "another thread"); });
  for (int k = 0; k < 3; ++k) expect_same(value_or_throw(model_from(shape)), first, "while it is read");
  stop = true;
  other.join();
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(wrong, 0);
}

}}  // namespace tessera::test
