#pragma once
// The section of a set with one plane.

#include <vector>

#include "section/end_links.h"
#include "section/prepared_set.h"
#include "section/strands.h"
#include "tessera/sections.h"

namespace tessera { inline namespace abi_0_1 {

/// The section of one plane, with ranges of its own lists.
struct TracedPlane {
  PlaneSection plane;
  std::vector<SectionPolyline> polylines;
  std::vector<SectionPoint> points;
  std::vector<SectionContact> contacts;
  std::vector<std::uint32_t> coplanar;
};

/// The data that all planes of a call share.
struct PlaneTask {
  const PreparedSet* set;
  const Levels* levels;
  PlaneLimit limit;
  LinkOptions links;
  double merge;  ///< points that are joined and this near become one
};

/// Traces one plane after the other; keeps its memory. Threads: each has its own.
class PlaneTracer {
 public:
  explicit PlaneTracer(const PlaneTask& task) : task_(task), strand_tracer_(*task.levels) {}

  /// Traces a plane. `level`: index into the levels' heights.
  void trace(std::size_t level, TracedPlane& traced);
  bool is_full() const { return strand_tracer_.is_full(); }

 private:
  /// Traces the limit from one side. Returns whether the other one may differ.
  bool trace_limit(std::size_t level, PlaneLimit limit, TracedPlane& traced);
  void add_contacts(const PreparedPatch& patch, TracedPlane& traced);
  void add_tangent(const PreparedPatch& patch, const ParameterPoint& at, TracedPlane& traced);
  void assemble(TracedPlane& traced);
  void append_chain(std::uint32_t strand, bool backward, TracedPlane& traced);
  void append_strand(const Strand& strand, bool backward, TracedPlane& traced);
  void join_last(const SectionPoint& next, TracedPlane& traced);
  void finish_polyline(std::size_t first, bool closed, TracedPlane& traced);

  const PlaneTask task_;
  StrandTracer strand_tracer_;
  EndLinks links_;
  std::vector<Strand> strands_;
  std::vector<SectionPoint> points_;
  std::vector<std::uint8_t> is_used_;  ///< by strand
  double merged_ = 0;                  ///< the largest distance of points that became one
};

}}  // namespace tessera::abi_0_1
