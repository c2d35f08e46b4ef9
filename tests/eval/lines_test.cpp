// Compares patch-contiguous results with block-interleaved ones, bit for bit, in every layout: any place in a cache
// line, records with and without gaps, arrays, columns far apart, plain and streamed stores. Nothing is written beyond.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "support/grids.h"

namespace tessera::test { namespace {

/// Positions and normals of a set with whole and partial blocks, from the block-interleaved layout.
template <class T>
struct Reference {
  PatchSet set;
  GridPlan plan;
  AlignedVector<T> position, normal;
  AlignedVector<NormalKind> kind;

  Reference(int nu, int nv, Isa isa)
      : set(make_set()),
        plan(value_of(GridPlan::make(set, parameters(nu), parameters(nv), {.precision = precision_of<T>, .isa = isa}))),
        position(plan.block_capacity()),
        normal(position.size()),
        kind(position.size() / 3) {
    EXPECT_TRUE(
        evaluate(set, plan, QuantityBlocks<T>{.position = position, .normal = normal, .normal_kind = kind}).ok());
  }
  static PatchSet make_set() {
    Random random(37);
    std::vector<BezierPatch> patches;
    for (int k = 0; k < 21; ++k) patches.push_back(random_polynomial(random, 3, 3));
    for (int k = 0; k < 5; ++k) patches.push_back(random_rational(random, 2, 4));
    for (int k = 0; k < 3; ++k) patches.push_back(random_rational(random, 3, 3));
    patches.push_back(polynomial(3, 3, std::vector<Vec3>(16, Vec3{1, 2, 3})));  // no normal anywhere
    patches.push_back(with_pole(random_polynomial(random, 3, 3)));
    patches.insert(patches.begin() + 9, random_polynomial(random, 1, 2));
    PatchSetOptions options;
    options.blocks.double_bernstein = true;
    return set_of(patches, options);
  }
  /// The patch with one point for its side u = 0.
  static BezierPatch with_pole(const BezierPatch& patch) {
    std::vector<Vec3> points(patch.points().begin(), patch.points().end());
    std::fill_n(points.begin(), patch.degree_v() + 1, points[0]);
    return polynomial(patch.degree_u(), patch.degree_v(), points);
  }
  static std::vector<double> parameters(int count) {
    std::vector<double> t;
    for (int k = 0; k < count; ++k) t.push_back(k == 0 ? 0 : (k + 0.3) / count);
    return t;
  }
  /// Where a component of a record lies in the blocks.
  std::size_t place(std::size_t record, std::size_t component) const {
    const std::size_t samples = plan.count_u() * plan.count_v();
    const PatchSet::Slot slot = set.slot(record / samples);
    return ((slot.block * samples + record % samples) * 3 + component) * PatchSet::lanes + slot.lane;
  }
  std::size_t kind_place(std::size_t record) const {
    const std::size_t samples = plan.count_u() * plan.count_v();
    const PatchSet::Slot slot = set.slot(record / samples);
    return (slot.block * samples + record % samples) * PatchSet::lanes + slot.lane;
  }
};

/// Runs with both views placed at `memory + first` by `place`, and compares every value of the memory.
template <class T, class Place>
void check_lines(const Reference<T>& r, std::size_t values, Stores stores, Place&& place, bool with_kinds = true) {
  const T untouched = T(-7);
  std::vector<T> memory(values, untouched), expected(values, untouched);
  const auto views_of = [&](std::vector<T>& all) { return place(std::span<T>(all)); };
  QuantityViews<T> out = views_of(memory);
  std::vector<NormalKind> kinds(3 * r.plan.capacity(), NormalKind{9});
  if (with_kinds) out.normal_kind = View1<NormalKind>::interleaved(kinds, 3, 1);
  Execution execution;
  execution.stores = stores;
  const Status status = evaluate(r.set, r.plan, out, execution);
  ASSERT_TRUE(status.ok()) << status.message();
  const QuantityViews<T> wanted = views_of(expected);
  for (std::size_t k = 0; k < r.plan.capacity(); ++k) {
    for (int c = 0; c < 3; ++c) {
      wanted.position.at(k, c) = r.position[r.place(k, static_cast<std::size_t>(c))];
      wanted.normal.at(k, c) = r.normal[r.place(k, static_cast<std::size_t>(c))];
    }
    ASSERT_EQ(kinds[3 * k + 1], with_kinds ? r.kind[r.kind_place(k)] : NormalKind{9});
    ASSERT_EQ(kinds[3 * k], NormalKind{9});
  }
  ASSERT_EQ(std::memcmp(memory.data(), expected.data(), values * sizeof(T)), 0);
}

template <class T>
void check_line_grid(int nu, int nv, Isa isa, const std::vector<std::size_t>& shifts) {
  const Reference<T> r(nu, nv, isa);
  const std::size_t count = r.plan.capacity();
  for (const Stores stores : {Stores::plain, Stores::streaming}) {
    SCOPED_TRACE(testing::Message() << nu << "x" << nv << " " << name(isa)
                                    << (stores == Stores::plain ? "" : " streamed"));
    for (const std::size_t shift : shifts) {  // one record of both; two packed arrays
      const auto record = [&](std::span<T> all) {
        const auto memory = all.subspan(shift);
        return QuantityViews<T>{.position = View3<T>::interleaved(memory, 6, 3),
                                .normal = View3<T>::interleaved(memory, 6, 0)};
      };
      check_lines(r, 6 * count + shift, stores, record);
      check_lines(r, 6 * count + shift, stores, record, false);
      check_lines(r, 6 * count + 2 * shift, stores, [&](std::span<T> all) {
        return QuantityViews<T>{.position = View3<T>::interleaved(all.subspan(shift, 3 * count)),
                                .normal = View3<T>::interleaved(all.subspan(2 * shift + 3 * count))};
      });
    }
    check_lines(r, 6 * count + 3, stores, [&](std::span<T> all) {  // arrays; of the normal in another order
      const auto array = [&](std::size_t k) { return all.subspan(1 + k * count, count); };
      return QuantityViews<T>{.position = View3<T>::soa({array(0), array(1), array(2)}),
                              .normal = View3<T>::soa({array(5), array(3), array(4)})};
    });
    for (const std::size_t record : {7u, 8u, 15u, 40u})  // with gaps
      check_lines(r, record * count + 1, stores, [&](std::span<T> all) {
        const auto memory = all.subspan(1);
        return QuantityViews<T>{.position = View3<T>::interleaved(memory, record, record - 3),
                                .normal = View3<T>::interleaved(memory, record, 1)};
      });
    check_lines(r, 5 * count + 4 * count, stores, [&](std::span<T> all) {  // a stride of its own each
      return QuantityViews<T>{.position = View3<T>::interleaved(all.first(5 * count), 5, 1),
                              .normal = View3<T>::interleaved(all.subspan(5 * count), 4, 0)};
    });
  }
}

TEST(Lines, AnyPlaceInALine) {
  const std::vector<std::size_t> all{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  for (const Isa isa : available_isas()) {
    check_line_grid<float>(3, 3, isa, all);
    check_line_grid<double>(3, 3, isa, all);
  }
}

TEST(Lines, AnySizeOfGrid) {
  for (const Isa isa : available_isas())
    for (const auto& [nu, nv] :
         {std::pair{1, 1}, {1, 2}, {2, 2}, {1, 5}, {2, 3}, {4, 4}, {5, 5}, {1, 16}, {17, 1}, {8, 8}, {9, 7}, {33, 5}}) {
      check_line_grid<float>(nu, nv, isa, {0, 3, 5});
      check_line_grid<double>(nu, nv, isa, {0, 3, 5});
    }
}

/// Positions and normals at the start of longer records take kernels of their own: vertices of 32 bytes with uv at
/// their end, and others. The reference is made by other kernels; the gap between records keeps its values.
TEST(Lines, VerticesWithAGap) {
  for (const Isa isa : available_isas())
    for (const auto& [nu, nv] : {std::pair{1, 1}, {1, 2}, {3, 3}, {4, 4}, {9, 9}, {2, 31}, {3, 32}, {2, 33}, {5, 70}}) {
      const Reference<float> r(nu, nv, isa);
      const std::size_t count = r.plan.capacity();
      for (const Stores stores : {Stores::plain, Stores::streaming})
        for (const std::size_t record : {7u, 8u, 9u, 16u})
          for (const std::size_t shift : {0u, 1u, 2u, 5u, 8u}) {
            SCOPED_TRACE(testing::Message() << nu << "x" << nv << " " << name(isa) << " " << record << "+" << shift);
            const auto vertices = [&](std::span<float> all) {
              const auto memory = all.subspan(shift);
              return QuantityViews<float>{.position = View3<float>::interleaved(memory, record, 0),
                                          .normal = View3<float>::interleaved(memory, record, 3)};
            };
            check_lines(r, record * count + shift, stores, vertices, false);
            check_lines(r, record * count + shift, stores, vertices, true);
          }
    }
}

TEST(Lines, VerticesInPieces) {
  for (const Isa isa : available_isas()) {
    const Reference<float> r(67, 61, isa);
    check_lines(
        r, 8 * r.plan.capacity(), Stores::automatic,
        [](std::span<float> all) {
          return QuantityViews<float>{.position = View3<float>::interleaved(all, 8, 0),
                                      .normal = View3<float>::interleaved(all, 8, 3)};
        },
        false);
  }
}

/// Large grids are cut into rows, which begin and end in the middle of cache lines and of other threads' cache lines.
TEST(Lines, GridsInPieces) {
  for (const Isa isa : available_isas()) check_line_grid<float>(67, 61, isa, {3});
}

}}  // namespace tessera::test
