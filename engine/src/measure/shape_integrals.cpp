#include "measure/shape_integrals.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "measure/body_sums.h"
#include "parallel/call_progress.h"
#include "parallel/parallel_for.h"

namespace tessera { inline namespace abi_0_1 {

Status ShapeIntegrals::run(const std::vector<bool>& faces, const MeasureOptions& options, const Execution& execution) {
  const std::size_t count = shape_.faces.size();
  faces_.assign(count, {});
  std::vector<std::optional<MeasuredFace>> made(count);
  constexpr std::array ends{0.3, 0.4, 1.0};
  CallProgress progress(execution, ends);
  Status status = parallel_for(count, 1, progress.loops(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      if (!faces[k]) continue;
      Result<MeasuredFace> face = make_face(shape_.faces[k], *shape_.faces[k].trims);
      faces_[k].status = face.status();
      if (!face) continue;
      faces_[k].proven = face->proven;
      faces_[k].directions = directions_of(shape_.faces[k]);
      made[k] = *std::move(face);
    }
  });
  for (std::size_t k = 0; k < count && status.ok(); ++k) {
    const std::string& name = *shape_.faces[k].name;
    if (!faces_[k].status.ok())
      return Status(faces_[k].status.code(), "face " + std::to_string(k) + (name.empty() ? "" : " (" + name + ")") +
                                                 ": " + faces_[k].status.message());
    if (made[k]) faces_[k].box = made[k]->grid.box(), box_.extend(faces_[k].box);
    directions_.push_back(faces_[k].directions);
    directions_.back().resize(edge_loops(shape_.faces[k]).size());
  }
  if (!status.ok()) return status;
  const Result<EdgeUses> uses = edge_uses(shape_);
  if (!uses) return uses.status();
  Result<std::vector<EdgeSlit>> slits = edge_slits(shape_, *uses, progress.loops());
  if (!slits) return slits.status();
  slits_ = *std::move(slits);
  centre_ = box_.empty() ? Vec3{} : box_.centre();
  return progress.finish(parallel_for(count, 1, progress.loops(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      if (!made[k]) continue;
      const bool is_fit = made[k]->grid.fit_error().distance > 0;  // its error needs the area
      const FaceIntegrals found = integrate(*made[k], centre_, is_fit, true, options);
      faces_[k].flux = found.flux, faces_[k].proven = found.proven;
      made[k].reset();
    }
  }));
}

void ShapeIntegrals::add_slits(const std::vector<std::uint32_t>& faces, Skin& skin, ExactSums& sums) const {
  std::vector<bool> seen(shape_.edges.size());
  for (const std::uint32_t face : faces) {
    if (shape_.faces[face].trims->empty()) skin.box.extend(faces_[face].box);
    for (const TrimLoop& loop : edge_loops(shape_.faces[face]))
      for (const Coedge& coedge : loop.coedges) {
        if (seen[coedge.edge]) continue;
        seen[coedge.edge] = true;
        const EdgeSlit& slit = slits_[coedge.edge];
        skin.gap = std::max(skin.gap, slit.width);
        skin.box.extend(slit.box);
        if (slit.box.empty()) continue;
        const double reach = length(slit.box.centre() - centre_) + slit.box.diagonal() + slit.width;
        Integrals error;
        for (int k = 0; k < 10; ++k)
          error.error[static_cast<std::size_t>(k)] =
              slit.width * slit.length * reach * std::pow(reach, moment_degree(k));
        sums.add(error, 1);
      }
  }
}

namespace {

/// Turns a skin inside out if its volume is negative.
void make_positive(Skin& skin) {
  if (skin.moments.value[0] < 0)
    for (double& value : skin.moments.value) value = -value;
}

/// Adds what it would change to turn the one of two faces that matters less.
void add_conflict(const Integrals& a, const Integrals& b, ExactSums& sums) {
  const Integrals& less = std::abs(a.value[0]) <= std::abs(b.value[0]) ? a : b;
  Integrals error;
  for (std::size_t k = 0; k < error.error.size(); ++k) error.error[k] = 2 * (std::abs(less.value[k]) + less.error[k]);
  sums.add(error, 1);
}

}  // namespace

Skin ShapeIntegrals::whole_skin() const {
  Skin skin;
  skin.box = box_;
  ExactSums sums;
  for (const Face& face : faces_) {
    sums.add(face.flux);
    skin.proven = skin.proven && face.proven;
  }
  skin.moments = volume_moments(sums.sums());
  make_positive(skin);
  return skin;
}

Status ShapeIntegrals::add_skins(const Shell& shell, std::vector<Skin>& skins) const {
  const Result<OrientedShell> oriented = oriented_shell(shape_, shell.faces, directions_, slits_);
  if (!oriented) return oriented.status();
  for (std::uint32_t part = 0; part < oriented->parts; ++part) {
    ExactSums sums;
    Skin skin;
    skin.proven = oriented->conflicts.empty();
    std::vector<std::uint32_t> faces;
    for (const OrientedFace& face : oriented->faces) {
      if (face.part != part) continue;
      sums.add(faces_[face.face].flux.sums(), face.sign);
      skin.proven = skin.proven && faces_[face.face].proven;
      faces.push_back(face.face);
    }
    add_slits(faces, skin, sums);
    for (const auto& [a, b] : oriented->conflicts) add_conflict(faces_[a].flux.sums(), faces_[b].flux.sums(), sums);
    skin.moments = volume_moments(sums.sums());
    make_positive(skin);
    skins.push_back(std::move(skin));
  }
  return {};
}

}}  // namespace tessera::abi_0_1
