// Seeded mutations of STEP texts: each ends soon, as an error or as a model that can be used.
//
// TESSERA_MUTATIONS sets their number; the default takes a few seconds. TESSERA_FIRST_MUTATION is the first one.
// TESSERA_MUTATION_FILE names a file that receives each text before it is read, for those that crash or never end.

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "io_step/step_builder.h"
#include "io_step/step_mutator.h"
#include "support/real_files.h"
#include "support/scratch_folder.h"

namespace tessera::test { namespace {

/// A ball, a tube without seam, a box and a turned spline.
std::string mixed_part() {
  StepBuilder b;
  const int ball = b.face(b.placed("SPHERICAL_SURFACE", b.axes({0, 0, 0}), {2}), {b.vertex_loop({0, 0, 2})});
  const auto circle = [&](double z) { return b.placed("CIRCLE", b.axes({9, 0, z}), {1}); };
  const int low = b.edge({10, 0, 0}, {10, 0, 0}, circle(0)), high = b.edge({10, 0, 3}, {10, 0, 3}, circle(3));
  const int tube = b.face(b.placed("CYLINDRICAL_SURFACE", b.axes({9, 0, 0}), {1}), {b.loop({low}), b.loop({-high})});
  const int lids[] = {b.flat({9, 0, 0}, {0, 0, -1}, {1, 0, 0}, {b.loop({-low})}),
                      b.flat({9, 0, 3}, {0, 0, 1}, {1, 0, 0}, {b.loop({high})})};
  const int profile = b.add("B_SPLINE_CURVE_WITH_KNOTS('',2," + b.list(b.points({{2, 0, 9}, {0, 0, 10}, {2, 0, 11}})) +
                            ",.UNSPECIFIED.,.F.,.F.,(3,3),(0.,1.),.UNSPECIFIED.)");
  const int turned = b.add("SURFACE_OF_REVOLUTION(''," + b.list({profile, b.axes({0, 0, 0})}).substr(1));
  const auto rim = [&](double z) { return b.edge({2, 0, z}, {2, 0, z}, b.placed("CIRCLE", b.axes({0, 0, z}), {2})); };
  const int first = rim(9), last = rim(11), seam = b.edge({2, 0, 9}, {2, 0, 11}, profile);
  const int waist = b.face(turned, {b.loop({first, seam, -last, -seam})});
  return b.file({b.solid({ball}), b.solid({tube, lids[0], lids[1]}), b.solid(b.box_faces({20, 0, 0}, {21, 2, 3})),
                 b.add("SHELL_BASED_SURFACE_MODEL(''," + b.list({b.shell({waist}, "OPEN_SHELL")}) + ")")});
}

/// Small real files, and one that is made.
std::vector<std::string> seeds() {
  std::vector<std::string> out{mixed_part()};
  const char* const folder = std::getenv("TESSERA_TEST_DATA");
  if (folder == nullptr) return out;
  std::vector<std::pair<std::uintmax_t, std::filesystem::path>> files;
  for (const std::filesystem::path& path : step_files_below(folder))
    files.emplace_back(std::filesystem::file_size(path), path);
  std::sort(files.begin(), files.end());
  constexpr std::size_t most = 120;
  for (std::size_t k = 0; k < std::min(most, files.size()); ++k) out.push_back(content_of(files[k].second));
  return out;
}

/// Returns how reading ended.
std::string end_of(const std::string& text) {
  const Result<Model> model = read_step(text, "mutation");
  if (!model) {
    EXPECT_FALSE(model.status().message().empty());
    EXPECT_NE(model.status().code(), StatusCode::internal) << model.status().message();
    EXPECT_NE(model.status().code(), StatusCode::out_of_memory) << model.status().message();
    return "an error";
  }
  EXPECT_FALSE(model->surfaces.empty());
  const Status topology = check_topology(*model);
  EXPECT_TRUE(topology.ok()) << topology.message();
  for (const ModelSurface& surface : model->surfaces) {
    const Domain d = domain(surface.surface);
    EXPECT_TRUE(d.u0 < d.u1 && d.v0 < d.v1);
    const Result<SurfaceJet> jet = evaluate_jet(surface, d.u_at(0.5), d.v_at(0.5));
    EXPECT_TRUE(jet ? is_finite(jet->position) : jet.status().code() == StatusCode::non_finite);
    for (const TrimLoop& loop : *surface.trims) EXPECT_FALSE(loop.curves.empty());
  }
  return model->warnings.empty() ? "a model" : "a model with warnings";
}

TEST(StepMutations, EndAsErrorsOrUsableModels) {
  const auto setting = [](const char* name, std::uint64_t otherwise) {
    const char* const value = std::getenv(name);
    return value ? std::strtoull(value, nullptr, 10) : otherwise;
  };
  const std::uint64_t count = setting("TESSERA_MUTATIONS", 3000), first = setting("TESSERA_FIRST_MUTATION", 0);
  const char* const file = std::getenv("TESSERA_MUTATION_FILE");
  const std::vector<std::string> texts = seeds();
  std::map<std::string, std::size_t> ends;
  double longest = 0;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    const std::string text = StepMutator(seed).mutated(texts[seed % texts.size()]);
    if (file) std::ofstream(file, std::ios::binary) << text;
    SCOPED_TRACE("mutation " + std::to_string(seed));
    const auto start = std::chrono::steady_clock::now();
    ++ends[end_of(text)];
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    EXPECT_LT(seconds, 20);
    if (seconds > longest) {
      longest = seconds;
      std::printf("mutation %llu: %.3f s\n", static_cast<unsigned long long>(seed), seconds);
      std::fflush(stdout);
    }
    if (HasFailure()) break;
  }
  for (const auto& [end, cases] : ends) std::printf("%s: %zu\n", end.c_str(), cases);
  EXPECT_GT(ends["a model"] + ends["a model with warnings"], count / 4);
}

TEST(StepMutations, TruncatedTextsEndAsErrorsOrUsableModels) {
  std::map<std::string, std::size_t> ends;
  for (const std::string& text : seeds())
    for (std::size_t length = 0; length < text.size() && !HasFailure(); length += 97) {
      SCOPED_TRACE(text.substr(0, length));
      ++ends[end_of(text.substr(0, length))];
    }
  EXPECT_GT(ends["an error"], 100u);
}

}}  // namespace tessera::test
