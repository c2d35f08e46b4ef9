// Files that are written piece by piece: a .ply has the bytes of the whole mesh's, a .pvtp names its pieces.

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <cstring>

#include "io/mesh/mesh_pieces.h"
#include "io/mesh_samples.h"
#include "support/scratch_folder.h"
#include "tessera/io.h"

namespace tessera::test { namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

struct Kind {
  Attributes attributes;
  bool quads = false, doubles = false;
};

Mesh piece_of(std::size_t k, const Kind& kind) {
  Mesh mesh = random_mesh(1000 + 37 * k, 1800 + 11 * k, kind.attributes, {10, 20, 30});
  if (kind.doubles)
    for (const float x : mesh.positions) mesh.model_positions.push_back(double(x) + 1e-9);
  for (std::size_t n = 0; kind.quads && n < 50 + k; ++n) {
    for (std::size_t c = 0; c < 4; ++c) mesh.quads.push_back(static_cast<std::uint32_t>(7 * n + c));
    if (kind.attributes.patches) mesh.quad_patches.push_back(static_cast<std::uint32_t>(n));
  }
  return mesh;
}

constexpr std::size_t patches_per_piece = 1000;

/// The pieces one after the other, as one mesh. `places` gets their firsts.
Mesh joined(const std::vector<Mesh>& meshes, std::vector<PiecePlace>& places) {
  Mesh whole;
  whole.origin = meshes.front().origin;
  const auto add = [](auto& to, const auto& from, std::size_t shift) {
    for (const auto x : from) to.push_back(x + static_cast<std::remove_reference_t<decltype(to[0])>>(shift));
  };
  for (std::size_t k = 0; k < meshes.size(); ++k) {
    const Mesh& piece = meshes[k];
    const std::size_t vertices = whole.vertex_count(), patches = k * patches_per_piece;
    places.push_back({vertices, whole.triangle_count(), whole.quad_count(), patches});
    add(whole.positions, piece.positions, 0);
    add(whole.model_positions, piece.model_positions, 0);
    add(whole.normals, piece.normals, 0);
    add(whole.parameters, piece.parameters, 0);
    add(whole.indices, piece.indices, vertices);
    add(whole.quads, piece.quads, vertices);
    add(whole.patches, piece.patches, patches);
    add(whole.quad_patches, piece.quad_patches, patches);
  }
  return whole;
}

std::vector<Mesh> pieces_of(std::size_t count, const Kind& kind) {
  std::vector<Mesh> pieces;
  for (std::size_t k = 0; k < count; ++k) pieces.push_back(piece_of(k, kind));
  if (count > 2) pieces[1] = {};  // a part without a triangle
  return pieces;
}

const std::vector<Kind> file_kinds{{},
                                   {{.normals = false, .parameters = false, .patches = false}},
                                   {{.normals = true, .parameters = false, .patches = false}, true},
                                   {{.normals = false, .parameters = true, .patches = true}, true, true}};

TEST(PlyLayout, RecordsPackedAtTheirOffsetsMakeTheFile) {
  const ScratchFolder folder;
  for (const Kind& kind : file_kinds) {
    const std::vector<Mesh> pieces = pieces_of(3, kind);
    std::vector<PiecePlace> places;
    const Mesh whole = joined(pieces, places);
    ASSERT_TRUE(write_mesh(whole, folder / "whole.ply").ok());
    const Result<PlyLayout> layout = PlyLayout::make(MeshTotals::of(whole));
    ASSERT_TRUE(layout.ok());
    std::string bytes(layout->file_bytes(), 'x');
    layout->header().copy(bytes.data(), layout->header().size());
    for (std::size_t k = 0; k < pieces.size(); ++k)
      for (const MeshRecord record : {MeshRecord::vertex, MeshRecord::triangle, MeshRecord::quad}) {
        ASSERT_TRUE(layout->check(pieces[k], places[k]).ok());
        const ByteRange range = layout->range(pieces[k], places[k], record);
        const std::size_t count = range.bytes / layout->record_bytes(record), half = count / 2;
        char* const to = bytes.data() + range.offset;
        layout->pack(pieces[k], places[k], record, 0, half, to);
        layout->pack(pieces[k], places[k], record, half, count, to + half * layout->record_bytes(record));
      }
    EXPECT_TRUE(bytes == content_of(folder / "whole.ply"));
  }
}

TEST(PlyLayout, FaultsOfPiecesAreErrors) {
  const std::vector<Mesh> pieces = pieces_of(2, {});
  std::vector<PiecePlace> places;
  const Result<PlyLayout> layout = PlyLayout::make(MeshTotals::of(joined(pieces, places)));
  ASSERT_TRUE(layout.ok());
  PiecePlace far = places[1];
  ++far.first_vertex;
  EXPECT_EQ(layout->check(pieces[1], far).message(), "a piece of the mesh is not within the whole");
  Mesh other = pieces[0];
  other.normals.clear();
  EXPECT_EQ(layout->check(other, {}).code(), StatusCode::count_mismatch);
  other = pieces[0];
  other.indices[7] = 1000;
  EXPECT_EQ(layout->check(other, {}).index(), 7);
  far = places[1];
  far.first_patch = (std::uint64_t{1} << 32) - 100;
  EXPECT_EQ(layout->check(pieces[1], far).code(), StatusCode::unsupported);
}

TEST(PlyLayout, TotalsBeyondIndicesNameTheWayOut) {
  const Result<PlyLayout> layout = PlyLayout::make({.vertices = std::uint64_t{1} << 32, .triangles = 1});
  EXPECT_EQ(layout.status().code(), StatusCode::unsupported);
  EXPECT_EQ(layout.status().message(),
            "the mesh has 4294967296 vertices, a .ply file can index 2147483647: write it in pieces, as .pvtp");
  EXPECT_EQ(PlyLayout::make({}).status().code(), StatusCode::invalid_argument);
  // Places are in 64 bit.
  const Result<PlyLayout> large = PlyLayout::make({.vertices = 2000000000, .triangles = std::uint64_t{1} << 40});
  ASSERT_TRUE(large.ok());
  const Mesh mesh = piece_of(0, file_kinds[1]);
  const PiecePlace place{1999999000, (std::uint64_t{1} << 40) - 1800};
  ASSERT_TRUE(large->check(mesh, place).ok());
  EXPECT_EQ(
      large->range(mesh, place, MeshRecord::triangle).offset + large->range(mesh, place, MeshRecord::triangle).bytes,
      large->file_bytes());
}

/// Runs with files limited to 100 KB.
template <class Run>
void with_full_disk(const Run& run) {
  struct rlimit limit {};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &limit), 0);
  const struct rlimit small { .rlim_cur = 100000, .rlim_max = limit.rlim_max };
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  run();
  ::setrlimit(RLIMIT_FSIZE, &limit);
  std::signal(SIGXFSZ, handler);
}

PlyStream stream_of(const std::string& path) { return *PlyStream::make(*OutputFile::make(path)); }

TEST(PlyStream, BytesAreThoseOfTheWhole) {
  const ScratchFolder folder;
  for (const Kind& kind : file_kinds)
    for (const std::size_t count : {1u, 2u, 3u, 7u}) {
      const std::vector<Mesh> pieces = pieces_of(count, kind);
      std::vector<PiecePlace> places;
      const Mesh whole = joined(pieces, places);
      ASSERT_TRUE(write_mesh(whole, folder / "whole.ply").ok());
      PlyStream out = stream_of(folder / "pieces.ply");
      ASSERT_TRUE(out.append({}, 0).ok());
      for (const Mesh& piece : pieces) ASSERT_TRUE(out.append(piece, patches_per_piece).ok());
      EXPECT_EQ(out.totals().triangles, whole.triangle_count());
      EXPECT_EQ(folder.names().size(), 2u) << "the whole and a temporary";
      ASSERT_TRUE(out.commit().ok());
      EXPECT_TRUE(content_of(folder / "whole.ply") == content_of(folder / "pieces.ply")) << count << " pieces";
      fs::remove(folder / "pieces.ply");
    }
}

TEST(PlyStream, FaultsAreErrorsAndLeaveNothing) {
  const ScratchFolder folder;
  const std::string path = folder / "m.ply";
  EXPECT_EQ(stream_of(path).commit().message(), path + ": the mesh has no vertices");
  {
    PlyStream out = stream_of(path);
    Mesh other = piece_of(0, {}), bad = piece_of(0, {});
    ASSERT_TRUE(out.append(other, 1).ok());
    other.normals.clear();
    EXPECT_EQ(out.append(other, 1).code(), StatusCode::count_mismatch);
    bad.indices[7] = 1000;
    EXPECT_EQ(out.append(bad, 1).index(), 7);
  }
  Status written, status;
  with_full_disk([&] {
    PlyStream out = stream_of(path);
    for (std::size_t k = 0; k < 7; ++k) written = out.append(piece_of(k, {}), 0);
  });
  EXPECT_EQ(written.message(), path + ": cannot be written: File too large");
  with_full_disk([&] {
    PlyStream out = stream_of(path);
    for (std::size_t k = 0; k < 2; ++k) written = out.append(piece_of(k, {}), 0);
    status = out.commit();
  });
  EXPECT_TRUE(written.ok());
  EXPECT_EQ(status.message(), path + ": cannot be written: File too large");
  EXPECT_EQ(folder.names(), Names{});
}

/// The value of an attribute of the first element `element` that has the attribute `name`="`value`".
std::string attribute_of(const std::string& text, const std::string& name, const std::string& attribute) {
  std::size_t at = text.find("Name=\"" + name + "\"");
  EXPECT_NE(at, std::string::npos) << name;
  at = text.rfind('<', at);
  at = text.find(" " + attribute + "=\"", at) + attribute.size() + 3;
  return text.substr(at, text.find('"', at) - at);
}

template <class T>
std::vector<T> array_of(const std::string& text, const std::string& name) {
  const std::size_t begin = text.find("<AppendedData encoding=\"raw\">\n_") + 31;
  const std::size_t at = begin + std::stoull(attribute_of(text, name, "offset"));
  std::uint64_t bytes = 0;
  std::memcpy(&bytes, text.data() + at, sizeof bytes);
  EXPECT_LE(at + 8 + bytes, text.size());
  std::vector<T> values(bytes / sizeof(T));
  if (bytes > 0) std::memcpy(values.data(), text.data() + at + 8, bytes);
  return values;
}

TEST(VtpPieces, ArraysAreThoseOfTheMesh) {
  const ScratchFolder folder;
  for (const Kind& kind : file_kinds) {
    const Mesh mesh = piece_of(3, kind);
    ASSERT_TRUE(write_vtp_piece(mesh, MeshTotals::of(mesh), folder / "m.pvtp", 12, 5000).ok());
    const std::string text = content_of(folder / "m_0012.vtp");
    EXPECT_NE(text.find("NumberOfPoints=\"1111\""), std::string::npos);
    EXPECT_NE(text.find("NumberOfPolys=\"" + std::to_string(mesh.triangle_count() + mesh.quad_count()) + "\""),
              std::string::npos);
    EXPECT_TRUE(text.ends_with("\n</AppendedData>\n</VTKFile>\n"));
    if (kind.attributes.normals) {
      EXPECT_EQ(array_of<float>(text, "Normals"), mesh.normals);
    }
    if (kind.attributes.parameters) {
      EXPECT_EQ(array_of<float>(text, "TCoords"), mesh.parameters);
    }
    if (kind.doubles) {
      EXPECT_EQ(array_of<double>(text, "Points"), mesh.model_positions);
    } else {
      const std::vector<float> points = array_of<float>(text, "Points");
      ASSERT_EQ(points.size(), mesh.positions.size());
      EXPECT_EQ(points[5], static_cast<float>(mesh.origin.z + double(mesh.positions[5])));
    }
    std::vector<std::uint32_t> corners = mesh.indices;
    corners.insert(corners.end(), mesh.quads.begin(), mesh.quads.end());
    EXPECT_EQ(array_of<std::uint32_t>(text, "connectivity"), corners);
    const std::vector<std::int64_t> ends = array_of<std::int64_t>(text, "offsets");
    ASSERT_EQ(ends.size(), mesh.triangle_count() + mesh.quad_count());
    EXPECT_EQ(ends.front(), 3);
    EXPECT_EQ(ends[mesh.triangle_count() - 1], static_cast<std::int64_t>(mesh.indices.size()));
    EXPECT_EQ(ends.back(), static_cast<std::int64_t>(corners.size()));
    if (kind.attributes.patches) {
      const std::vector<std::uint32_t> patches = array_of<std::uint32_t>(text, "patch");
      EXPECT_EQ(patches.front(), mesh.patches.front() + 5000);
      EXPECT_EQ(patches.back(), (kind.quads ? mesh.quad_patches : mesh.patches).back() + 5000);
    }
  }
}

TEST(VtpPieces, TheIndexNamesAllPieces) {
  const ScratchFolder folder;
  const fs::path index = folder / "a & b.pvtp";
  const MeshTotals totals = MeshTotals::of(piece_of(0, {}));
  for (std::size_t k = 0; k < 3; ++k)
    ASSERT_TRUE(write_vtp_piece(k == 1 ? Mesh{} : piece_of(k, {}), totals, index, k).ok());
  ASSERT_TRUE(write_pvtp(totals, index, 3).ok());
  EXPECT_EQ(array_of<float>(content_of(folder / "a & b_0001.vtp"), "Normals").size(), 0u);  // VTK looks for it
  EXPECT_EQ(write_vtp_piece(piece_of(0, file_kinds[1]), totals, index, 3).code(), StatusCode::count_mismatch);
  EXPECT_EQ(folder.names(), (Names{"a & b.pvtp", "a & b_0000.vtp", "a & b_0001.vtp", "a & b_0002.vtp"}));
  const std::string text = content_of(index);
  for (const char* name : {"a &amp; b_0000.vtp", "a &amp; b_0001.vtp", "a &amp; b_0002.vtp"})
    EXPECT_NE(text.find("<Piece Source=\"" + std::string(name) + "\"/>"), std::string::npos) << text;
  EXPECT_EQ(write_pvtp(totals, index, 0).code(), StatusCode::invalid_argument);
}

TEST(VtpPieces, AFullDiskLeavesNothing) {
  const ScratchFolder folder;
  const Mesh mesh = piece_of(900, {});
  Status status;
  with_full_disk([&] { status = write_vtp_piece(mesh, MeshTotals::of(mesh), folder / "m.pvtp", 0); });
  EXPECT_EQ(status.message(), folder / "m_0000.vtp: cannot be written: File too large");
  EXPECT_EQ(folder.names(), Names{});
}

}}  // namespace tessera::test
