// The grid by OpenSubdiv: a mesh of quadrilaterals without boundary faces has one regular bicubic B-spline patch per
// face. EvalPatches() evaluates the basis at every point. Limit stencils hold the basis, 16 weights per point (and 32
// for r_u and r_v), so they are tried only on small grids.

#include <opensubdiv/far/patchMap.h>
#include <opensubdiv/far/patchTableFactory.h>
#include <opensubdiv/far/stencilTableFactory.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefinerFactory.h>
#include <opensubdiv/osd/cpuEvaluator.h>
#include <opensubdiv/osd/cpuPatchTable.h>

#include <memory>

#include "peers/grid_task.h"
#include "peers/interleaved.h"

namespace tessera::bench { namespace {

namespace Far = OpenSubdiv::Far;
namespace Osd = OpenSubdiv::Osd;
namespace Sdc = OpenSubdiv::Sdc;

constexpr std::size_t max_stencils = 200'000;

/// The inner face (a, b) is number (a + 1) * faces + b + 1; its s runs along i.
std::unique_ptr<Far::TopologyRefiner> refiner_of(const GridTask& task) {
  const int side = task.side(), faces = side - 1;
  std::vector<int> sizes(static_cast<std::size_t>(faces * faces), 4), corners;
  for (int i = 0; i < faces; ++i)
    for (int j = 0; j < faces; ++j)
      for (const int corner : {i * side + j, (i + 1) * side + j, (i + 1) * side + j + 1, i * side + j + 1})
        corners.push_back(corner);
  Far::TopologyDescriptor mesh;
  mesh.numVertices = side * side;
  mesh.numFaces = faces * faces;
  mesh.numVertsPerFace = sizes.data();
  mesh.vertIndicesPerFace = corners.data();
  Sdc::Options options;
  options.SetVtxBoundaryInterpolation(Sdc::Options::VTX_BOUNDARY_NONE);
  using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
  return std::unique_ptr<Far::TopologyRefiner>(Factory::Create(mesh, Factory::Options(Sdc::SCHEME_CATMARK, options)));
}

int face_of(const GridTask& task, int a, int b) { return (a + 1) * (task.side() - 1) + b + 1; }

/// Shared by both ways: the mesh, its patches, and memory.
class Evaluation {
 public:
  explicit Evaluation(const GridTask& task) : task_(task), refiner_(refiner_of(task)) {
    refiner_->RefineAdaptive(Far::TopologyRefiner::AdaptiveOptions(0));
    patches_.reset(Far::PatchTableFactory::Create(*refiner_));
    for (const Vec3& p : task.net)
      for (const double x : {p.x, p.y, p.z}) net_.push_back(static_cast<float>(x));
    for (std::vector<float>* memory : {&position_, &du_, &dv_})
      if (memory == &position_ || task.tangents) memory->assign(3 * task.points(), 0.0f);
  }
  virtual ~Evaluation() = default;
  virtual bool evaluate() = 0;

  double run() {
    bool done = false;
    const double seconds = seconds_of([&] { done = evaluate(); });
    return done ? seconds : -1;
  }

  /// Points are ordered by spans (a, b), then by their parameters in the span.
  GridValue read(std::size_t i, std::size_t j) const {
    const auto n = static_cast<std::size_t>(task_.per_span);
    const std::size_t span = i / n * static_cast<std::size_t>(task_.spans) + j / n;
    const std::size_t at = 3 * ((span * n + i % n) * n + j % n);
    const auto vector = [&](const std::vector<float>& values) {
      return values.empty() ? Vec3{} : Vec3{values[at], values[at + 1], values[at + 2]};
    };
    return {vector(position_), vector(du_), vector(dv_)};
  }

 protected:
  const GridTask& task_;
  std::unique_ptr<Far::TopologyRefiner> refiner_;
  std::unique_ptr<const Far::PatchTable> patches_;
  const Osd::BufferDescriptor triples_{0, 3, 3};
  std::vector<float> net_, position_, du_, dv_;
};

class ByPatches : public Evaluation {
 public:
  explicit ByPatches(const GridTask& task) : Evaluation(task), table_(Osd::CpuPatchTable::Create(patches_.get())) {
    const Far::PatchMap map(*patches_);
    for (int a = 0; a < task.spans; ++a)
      for (int b = 0; b < task.spans; ++b) {
        const Far::PatchTable::PatchHandle* handle = map.FindPatch(face_of(task, a, b), 0.5, 0.5);
        if (handle == nullptr) return;  // the comparison fails without the points
        for (const double s : task.local)
          for (const double t : task.local) points_.emplace_back(*handle, static_cast<float>(s), static_cast<float>(t));
      }
  }
  bool evaluate() override {
    const auto count = static_cast<int>(points_.size());
    if (!task_.tangents)
      return Osd::CpuEvaluator::EvalPatches(net_.data(), triples_, position_.data(), triples_, count, points_.data(),
                                            table_->GetPatchArrayBuffer(), table_->GetPatchIndexBuffer(),
                                            table_->GetPatchParamBuffer());
    return Osd::CpuEvaluator::EvalPatches(net_.data(), triples_, position_.data(), triples_, du_.data(), triples_,
                                          dv_.data(), triples_, count, points_.data(), table_->GetPatchArrayBuffer(),
                                          table_->GetPatchIndexBuffer(), table_->GetPatchParamBuffer());
  }

 private:
  std::unique_ptr<Osd::CpuPatchTable> table_;
  std::vector<Osd::PatchCoord> points_;
};

class ByStencils : public Evaluation {
 public:
  explicit ByStencils(const GridTask& task) : Evaluation(task) {
    std::vector<float> s, t;
    for (const double x : task.local)
      for (const double y : task.local) {
        s.push_back(static_cast<float>(x));
        t.push_back(static_cast<float>(y));
      }
    Far::LimitStencilTableFactory::LocationArrayVec places;
    for (int a = 0; a < task.spans; ++a)
      for (int b = 0; b < task.spans; ++b) {
        Far::LimitStencilTableFactory::LocationArray place;
        place.ptexIdx = face_of(task, a, b);
        place.numLocations = static_cast<int>(s.size());
        place.s = s.data();
        place.t = t.data();
        places.push_back(place);
      }
    Far::LimitStencilTableFactory::Options options;
    options.generate1stDerivatives = task.tangents;
    stencils_.reset(Far::LimitStencilTableFactory::Create(*refiner_, places, nullptr, patches_.get(), options));
  }
  bool evaluate() override {
    const auto& all = *stencils_;
    const int count = all.GetNumStencils();
    if (!task_.tangents)
      return Osd::CpuEvaluator::EvalStencils(net_.data(), triples_, position_.data(), triples_, all.GetSizes().data(),
                                             all.GetOffsets().data(), all.GetControlIndices().data(),
                                             all.GetWeights().data(), 0, count);
    return Osd::CpuEvaluator::EvalStencils(net_.data(), triples_, position_.data(), triples_, du_.data(), triples_,
                                           dv_.data(), triples_, all.GetSizes().data(), all.GetOffsets().data(),
                                           all.GetControlIndices().data(), all.GetWeights().data(),
                                           all.GetDuWeights().data(), all.GetDvWeights().data(), 0, count);
  }

 private:
  std::unique_ptr<const Far::LimitStencilTable> stencils_;
};

GridRun run_of(std::shared_ptr<Evaluation> work, const char* way) {
  return {"OpenSubdiv " TESSERA_OPENSUBDIV_VERSION, way, false, [=] { return work->run(); },
          [=](std::size_t i, std::size_t j) { return work->read(i, j); }};
}

const bool registered = [] {
  grid_peers().push_back({"OpenSubdiv", [](const GridTask& task) {
                            std::vector<GridRun> runs{
                                run_of(std::make_shared<ByPatches>(task), "CpuEvaluator::EvalPatches")};
                            if (task.points() <= max_stencils)
                              runs.push_back(run_of(std::make_shared<ByStencils>(task), "limit stencils"));
                            return runs;
                          }});
  return true;
}();

}}  // namespace tessera::bench
