// Reads a part of a model, and finds the surfaces around it by the boxes that parts exchange.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "base/text.h"
#include "model/box_tree.h"
#include "parts/packed_message.h"
#include "tessera/guard.h"
#include "tessera/part_mesh.h"

namespace tessera { inline namespace abi_0_1 {
namespace {

/// A box of floats that holds the box of a surface.
struct SentBox {
  std::uint64_t surface = 0;
  std::array<float, 3> lower{}, upper{};
};

float at_most(double value) {
  const float rounded = static_cast<float>(value);
  return rounded <= value ? rounded : std::nextafter(rounded, -std::numeric_limits<float>::infinity());
}

SentBox sent(std::uint64_t surface, const Box3& box) {
  const Vec3 &a = box.lower, &b = box.upper;
  return {surface, {at_most(a.x), at_most(a.y), at_most(a.z)}, {-at_most(-b.x), -at_most(-b.y), -at_most(-b.z)}};
}

Box3 box_of(const SentBox& sent) {
  return {{sent.lower[0], sent.lower[1], sent.lower[2]}, {sent.upper[0], sent.upper[1], sent.upper[2]}};
}

/// The run of a part, its box and its fit error.
struct PartPlace {
  PartRun run;
  Box3 box;
  FitError fit_error;
};

/// Learns the places of all parts. Errors: invalid_argument (runs that are not the whole model in order).
Result<std::vector<PartPlace>> find_places(const PartPlace& own, std::uint64_t count, Transport& transport) {
  Message place;
  append(place, own);
  const Result<std::vector<Message>> all = transport.exchange({transport.part_count(), place});
  if (!all) return all.status();
  std::vector<PartPlace> places;
  std::uint64_t next = 0;
  for (std::size_t part = 0; part < all->size(); ++part) {
    const std::vector<PartPlace> met = read_all<PartPlace>((*all)[part]);
    if (met.size() != 1) return Status(StatusCode::count_mismatch, "part " + std::to_string(part) + " sent no place");
    const PartRun& run = met.front().run;
    if (run.begin != next || run.end < run.begin)
      return Status(StatusCode::invalid_argument, "part " + std::to_string(part) + " has the surfaces from " +
                                                      std::to_string(run.begin) + " until " + std::to_string(run.end) +
                                                      ", it must begin with " + std::to_string(next));
    next = run.end;
    places.push_back(met.front());
  }
  if (next == count) return places;
  return Status(StatusCode::invalid_argument,
                "the parts have " + counted(next, "surface") + " of " + std::to_string(count));
}

/// Returns the surfaces of other parts that come within reach of one of this part's.
Result<std::vector<SentBox>> find_nearest(std::span<const Box3> boxes, const PartRun& run,
                                          std::span<const PartPlace> places, double reach, Transport& transport) {
  const Box3& own = places[transport.part()].box;
  std::vector<Message> messages(places.size());
  for (std::size_t part = 0; part < places.size(); ++part) {
    const Box3& other = places[part].box;
    if (part == transport.part() || !are_near(other, own, reach)) continue;
    for (std::size_t k = 0; k < boxes.size(); ++k)
      if (are_near(other, boxes[k], reach)) append(messages[part], sent(run.begin + k, boxes[k]));
  }
  Result<std::vector<Message>> taken = transport.exchange(std::move(messages));
  if (!taken) return taken.status();
  std::vector<SentBox> received;
  std::vector<Box3> others;
  for (std::size_t part = 0; part < places.size(); ++part) {
    if (part == transport.part()) continue;
    std::ranges::copy(read_all<SentBox>((*taken)[part]), std::back_inserter(received));
    (*taken)[part] = {};
  }
  for (const SentBox& other : received) others.push_back(box_of(other));
  const BoxTree tree = tree_towards(others, boxes, reach);
  std::vector<SentBox> nearest;
  for (std::size_t k = 0; k < others.size(); ++k)
    if (tree.touches(others[k], reach)) nearest.push_back(received[k]);
  return nearest;
}

/// Appends to each message the surfaces of this part that come within reach of the boxes that another part has sent.
std::vector<Message> answers(std::span<const Box3> boxes, const PartRun& run, std::span<const Message> asked,
                             double reach) {
  std::vector<Message> messages(asked.size());
  for (std::size_t part = 0; part < asked.size(); ++part) {
    std::vector<Box3> wanted;
    for (const SentBox& sent : read_all<SentBox>(asked[part])) wanted.push_back(box_of(sent));
    if (wanted.empty()) continue;
    const BoxTree tree(wanted);
    for (std::size_t k = 0; k < boxes.size(); ++k)
      if (tree.touches(boxes[k], reach)) append(messages[part], run.begin + k);
  }
  return messages;
}

/// Returns the surfaces of other parts that come within reach of one of this part's, and those that come within reach
/// of these, in increasing order: see part_of().
Result<std::vector<std::uint64_t>> find_around(std::span<const Box3> boxes, const PartRun& run,
                                               std::span<const PartPlace> places, double reach, Transport& transport) {
  const Result<std::vector<SentBox>> nearest = find_nearest(boxes, run, places, reach, transport);
  if (!nearest) return nearest.status();
  std::vector<Message> messages(places.size());
  std::vector<std::uint64_t> surfaces;
  for (const SentBox& sent : *nearest) {
    surfaces.push_back(sent.surface);
    const Box3 box = box_of(sent);
    for (std::size_t part = 0; part < places.size(); ++part)
      if (part != transport.part() && are_near(places[part].box, box, reach)) append(messages[part], sent);
  }
  const Result<std::vector<Message>> asked = transport.exchange(std::move(messages));
  if (!asked) return asked.status();
  const Result<std::vector<Message>> answered = transport.exchange(answers(boxes, run, *asked, reach));
  if (!answered) return answered.status();
  for (const Message& message : *answered)
    std::ranges::copy(read_all<std::uint64_t>(message), std::back_inserter(surfaces));
  std::ranges::sort(surfaces);
  const auto repeated = std::ranges::unique(surfaces);
  surfaces.erase(repeated.begin(), repeated.end());
  return surfaces;
}

/// Appends surfaces that are read to a part.
Status read_into(const SurfaceSource& source, std::uint64_t first, std::uint64_t end, ModelPart& part) {
  Result<Model> read = source.read(first, end);
  if (!read) return read.status();
  if (read->surfaces.size() != end - first || !read->instances.empty())
    return Status(StatusCode::count_mismatch, "the surfaces from " + std::to_string(first) + " until " +
                                                  std::to_string(end) + " were read as " +
                                                  counted(read->surfaces.size(), "surface"));
  if (part.model.surfaces.empty()) {
    part.model = *std::move(read);
  } else {
    std::ranges::move(read->surfaces, std::back_inserter(part.model.surfaces));
    std::ranges::move(read->warnings, std::back_inserter(part.model.warnings));
  }
  for (; first < end; ++first) part.surfaces.push_back(first);
  return {};
}

/// Reads some surfaces, which are in increasing order, run by run.
Status read_listed(const SurfaceSource& source, std::span<const std::uint64_t> surfaces, ModelPart& part) {
  for (std::size_t begin = 0; begin < surfaces.size();) {
    std::size_t end = begin + 1;
    while (end < surfaces.size() && surfaces[end] == surfaces[end - 1] + 1) ++end;
    if (Status status = read_into(source, surfaces[begin], surfaces[end - 1] + 1, part); !status.ok()) return status;
    begin = end;
  }
  return {};
}

/// Returns where the surfaces of a run lie.
Result<SurfaceExtents> read_extents(const SurfaceSource& source, const PartRun& run, const FitOptions& fit) {
  if (run.begin >= run.end) return SurfaceExtents{};
  ModelPart part;
  if (Status status = read_into(source, run.begin, run.end, part); !status.ok()) return status;
  return surface_extents(part.model, fit);
}

}  // namespace

Result<PartOutline> find_part(const SurfaceSource& source, const PartRun& run, const TessellationOptions& options,
                              Transport& transport, const FitOptions& fit) {
  return guarded([&]() -> Result<PartOutline> {
    const Result<SurfaceExtents> own = guarded([&] { return read_extents(source, run, fit); });
    if (Status status = transport.agree(own.status()); !status.ok()) return status;
    const PartPlace place{run, own->box(), own->fit_error};
    const Result<std::vector<PartPlace>> places = find_places(place, source.count, transport);
    if (!places) return places.status();
    PartOutline outline{run, {}, place.box, {}, {}};
    for (const PartPlace& other : *places) {
      outline.box.extend(other.box);
      outline.fit_error.distance = std::max(outline.fit_error.distance, other.fit_error.distance);
      outline.fit_error.certified = outline.fit_error.certified && other.fit_error.certified;
    }
    Result<std::vector<std::uint64_t>> around =
        find_around(own->boxes, run, *places, part_reach(options, outline.box), transport);
    if (!around) return around.status();
    outline.around = *std::move(around);
    return outline;
  });
}

Result<ModelPart> load_part(const SurfaceSource& source, const PartOutline& outline) {
  return guarded([&]() -> Result<ModelPart> {
    const PartRun& run = outline.run;
    const std::span<const std::uint64_t> around = outline.around;
    const auto before = static_cast<std::size_t>(std::ranges::lower_bound(around, run.end) - around.begin());
    ModelPart part;
    part.own_box = outline.own_box, part.box = outline.box, part.fit_error = outline.fit_error;
    if (Status status = read_listed(source, around.first(before), part); !status.ok()) return status;
    part.first = part.surfaces.size();
    if (run.begin < run.end)
      if (Status status = read_into(source, run.begin, run.end, part); !status.ok()) return status;
    part.end = part.surfaces.size();
    if (Status status = read_listed(source, around.subspan(before), part); !status.ok()) return status;
    return part;
  });
}

}}  // namespace tessera::abi_0_1
