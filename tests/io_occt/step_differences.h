#pragma once
// The STEP files of TESSERA_TEST_DATA that Tessera and OpenCASCADE read in different ways, and who is right.

#include <string_view>

namespace tessera::test {

/// A file's known differences.
struct StepDifference {
  std::string_view file;    ///< how its path ends
  std::string_view kinds;   ///< of StepComparison::kinds, in order, with a space between
  std::string_view reason;  ///< who is right, and why
};

constexpr std::string_view own_seam =
    "OpenCASCADE cuts a closed edge in two where it adds a seam; Tessera has the file's edges";
constexpr std::string_view rough =
    "Tessera says that a curve of a border reached its limit of points; its gaps are no larger than OpenCASCADE's";
constexpr std::string_view exact_offset =
    "Tessera reads the offset of a swept circle or line as the cylinder that it is; OpenCASCADE's reader fits it";
constexpr std::string_view own_pieces =
    "the file states one solid of one closed shell; OpenCASCADE makes a solid of each of its pieces. The volumes are "
    "equal together";
constexpr std::string_view axis =
    "OpenCASCADE moves the part by an axis placement that its representation lists beside it; ISO 10303-43 gives such "
    "an item no effect on the others, and the file's edges lie where Tessera has them";
constexpr std::string_view seam_and_axis = "a seam that OpenCASCADE adds, and an axis placement by which it moves";

constexpr StepDifference step_differences[] = {
    {"30274_ca0d10b2_1.stp", "warnings", rough},
    {"wing_fuselage.step", "warnings", rough},
    {"issues_16__54360_db08c779_0036_2.step", "area",
     "an arc of face 41 ends 9e-8 beside the corner. Of the half disc, 9.81747704, Tessera's area lacks 2.6e-7 and "
     "OpenCASCADE's has 6.8e-7 too much"},
    {"Torus__dobleCodo.stp", "solids",
     "the file states one BREP_WITH_VOIDS of four shells that lie beside each other; OpenCASCADE makes four solids"},
    {"wallcut_tool_0.step", "shells solids", own_pieces},
    {"ap214_collapsed_wavy_periodic_band.stp", "edges places", seam_and_axis},
    {"ap214_conical_closed_edge_band.stp", "places", axis},
    {"ap214_contractible_periodic_neighbor.stp", "edges", own_seam},
    {"ap214_face_wr2_off_surface_torus_invalid.stp", "read by OpenCASCADE alone",
     "the file is invalid on purpose: the face's loop lies off its torus"},
    {"ap214_four_face_keyhole.stp", "shells solids",
     "the file's closed shell is open; OpenCASCADE makes two shells of no solid, Tessera has the file's"},
    {"ap214_horn_torus_keyhole.stp", "places", axis},
    {"ap214_lazy_many_solids.stp", "edges",
     "64 solids of the file have the same six edges; OpenCASCADE makes six for each solid"},
    {"ap214_measured_periodic_winding.stp", "edges", own_seam},
    {"ap214_nurbs_terminal_extension.stp", "read by OpenCASCADE alone",
     "the file is invalid on purpose: an edge between two vertices in one place has an open curve"},
    {"ap214_offset_extrusion.stp", "warnings", exact_offset},
    {"ap214_offset_revolution.stp", "warnings", exact_offset},
    {"ap214_offset_vertex_periodic_band.stp", "places", axis},
    {"ap214_parallel_failure.stp", "solids",
     "the file's first solid has an open shell; OpenCASCADE makes no solid of it, Tessera has the file's"},
    {"ap214_periodic_face_branch.stp", "edges places", seam_and_axis},
    {"ap214_permissive_shared_dangling_spur.stp", "edges volume",
     "a loop of the file runs along an edge and back; OpenCASCADE leaves that edge out, so that its solid is closed. "
     "Tessera keeps the file's edge, and its solid is open"},
    {"ap214_representation_tolerance_periodic_cap.stp", "edges", own_seam},
    {"ap214_shared_conical_surface_bands.stp", "places shells",
     "an axis placement by which OpenCASCADE moves the part; it also splits the file's open shell in two"},
    {"ap214_shared_periodic_edge.stp", "edges", own_seam},
    {"ap214_shifted_two_arc_sphere.stp", "edges", own_seam},
    {"ap214_spherical_antipodal_boundary.stp", "edges solids",
     "OpenCASCADE adds the pole's edges, and makes no solid of the file's solid, whose shell is open"},
    {"ap214_surface_shells.stp", "edges", "OpenCASCADE has edges twice that two shells of the file share"},
    {"ap203_doubly_periodic_segmented_band.stp", "edges", own_seam},
    {"ap203_faceted_tetra.stp", "read by Tessera alone", "OpenCASCADE does not read a FACETED_BREP of FACE_SURFACE"},
    {"ap203_false_face_closed_edge_use.stp", "places", axis},
    {"ap203_mapped_assembly.stp", "read by Tessera alone", "OpenCASCADE does not read a FACETED_BREP of FACE_SURFACE"},
    {"ap203_shared_periodic_boundary_split.stp", "edges", own_seam},
    {"ap203_single_singular_periodic_branch.stp", "places", axis},
    {"ap203_toroidal_band_topology_seam.stp", "edges", own_seam},
    {"kcl-samples/step__3d-boaty.step", "area edges faces",
     "a hole of the file crosses itself at a corner; OpenCASCADE makes a face of the crossing. Its areas are right (by "
     "Green's formula along the loops), the measures of Tessera's crossed loops are not, and are called unproven"},
    {"kcl-samples/step__car-wheel-assembly.step", "shells solids", own_pieces},
    {"kcl-samples/step__enclosure.step", "shells solids", own_pieces},
    {"kcl-samples/step__poopy-shoe.step", "shells solids", own_pieces},
    {"ap214_periodic_edge_propagation.stp", "edges places", seam_and_axis},
};

}  // namespace tessera::test
