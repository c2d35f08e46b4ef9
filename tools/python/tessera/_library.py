"""The C library: where it lies, and its structs and functions, declared from two tables as in tessera_c.h,
tessera_c_files.h, tessera_c_shapes.h and tessera_c_queries.h."""

from __future__ import annotations

import ctypes
import os
import pathlib
from typing import Any

# --- Structs ----------------------------------------------------------------------------------------------------------
# Members in order, without struct_size, which begins all but two.
_STRUCTS = {
    "tsr_run": "int32 threads, int32 reserved, pointer cancel, pointer progress, pointer user",
    "tsr_in": "pointer data, size count, int64 record, int64 component",
    "tsr_out": "pointer data, size count, int64 record, int64 component",
    "tsr_bspline": "int32 degree_u, int32 degree_v, size count_u, size count_v, pointer points, pointer weights, "
    "pointer knots_u, pointer knots_v, size knot_count_u, size knot_count_v, string name",
    "tsr_read_options": "string format, string cad_reader, int32 step_reader, int32 reserved",
    "tsr_model_info": "uint64 surfaces, uint64 shapes, uint64 instances, uint64 warnings, uint64 trimmed",
    "tsr_surface_info": "double domain[4], uint64 loops",
    "tsr_instance_info": "uint64 shape, uint64 first_surface, double placement[12], float colour[4], int32 has_colour",
    "tsr_face_info": "uint32 instance, uint32 shape, uint32 face, float colour[4], int32 has_colour",
    "tsr_set_options": "int64 shape, uint32 flags, uint32 reserved, double fit_tolerance",
    "tsr_set_info": "uint64 patches, uint64 surfaces, uint64 cut_patches, uint64 memory_bytes, uint64 revision, "
    "double low[3], double high[3], double origin[3], double fit_error, uint64 unused_loops",
    "tsr_patch_info": "int32 degree_u, int32 degree_v, int32 is_rational, int32 is_cut, uint64 surface, "
    "double domain[4]",
    "tsr_jets": "int32 is_double, int32 reserved, tsr_out position, tsr_out du, tsr_out dv, tsr_out duu, tsr_out duv, "
    "tsr_out dvv, tsr_out normal, tsr_out first_form, tsr_out second_form, tsr_out gaussian, tsr_out mean, "
    "tsr_out first_curvature, tsr_out second_curvature, tsr_out first_direction, tsr_out second_direction",
    "tsr_plan_options": "double tolerance, double angle, double pixels, double eye[3], double target[3], double up[3], "
    "double field_of_view, double extent, double near_distance, int32 width, int32 height, int32 rate_u, "
    "int32 rate_v, uint32 flags, uint32 reserved, double weld, double crease_angle, double max_gap, double spare, "
    "uint64 max_triangles, double headroom, pointer surface_tolerances, size surface_tolerance_count",
    "tsr_plan_info": "uint64 vertices, uint64 triangles, uint64 quads, double tolerance, double bound, double gap, "
    "double angle, double pixels, int32 is_certified, int32 has_normals, uint64 open_edges, uint64 crossed_patches, "
    "double seen_bound",
    "tsr_mesh": "tsr_out position, tsr_out normal, tsr_out parameter, tsr_out position_f64, pointer triangles, "
    "pointer triangle_patches, pointer quads, pointer quad_patches, size triangle_count, size quad_count",
    "tsr_mesh_report": "uint64 vertices, uint64 distinct_positions, uint64 triangles, uint64 quads, uint64 open_edges, "
    "uint64 non_manifold_edges, uint64 inconsistent_edges, uint64 t_junctions, uint64 flipped_triangles, "
    "uint64 degenerate_triangles, uint64 non_finite_vertices",
    "tsr_scene_options": "double tolerance, int32 pieces, int32 is_editable",
    "tsr_scene_info": "uint64 memory_bytes, double low[3], double high[3], double spawn_offset",
    "tsr_rays": "int32 is_double, int32 reserved, tsr_in origin, tsr_in direction, tsr_in tnear, tsr_in tfar, "
    "tsr_in spawn_offset",
    "tsr_hits_out": "int32 is_double, int32 reserved, tsr_out kind, tsr_out flags, tsr_out surface, tsr_out patch, "
    "tsr_out t, tsr_out uv, tsr_out patch_uv, tsr_out position, tsr_out normal, tsr_out du, tsr_out dv, "
    "tsr_out residual",
    "tsr_point_scene_info": "uint64 memory_bytes, uint64 revision",
    "tsr_query_points": "int32 is_double, int32 patches, tsr_in position, tsr_in max_distance",
    "tsr_nearest_out": "int32 is_double, int32 reserved, tsr_out kind, tsr_out flags, tsr_out surface, tsr_out patch, "
    "tsr_out distance, tsr_out uv, tsr_out patch_uv, tsr_out position, tsr_out normal",
    "tsr_solid_info": "uint64 open_borders, int32 is_closed, int32 reserved",
    "tsr_sides_out": "tsr_out side, tsr_out is_certified",
    "tsr_measure_options": "double accuracy, uint64 max_cells, uint32 flags, uint32 reserved",
    "tsr_measures_info": "uint64 surfaces, uint64 bodies, uint64 faults",
    "tsr_area": "double area, double area_error, double centroid[3], double centroid_error, int32 is_proven, "
    "int32 reserved",
    "tsr_body": "uint32 instance, uint32 shape, uint32 solid, uint32 shell, double volume, double volume_error, "
    "double centroid[3], double centroid_error, double inertia[6], double inertia_error, double moments[3], "
    "double moments_error, double axes[9], double gap, int32 is_proven, int32 reserved",
    "tsr_box": "double low[3], double high[3], double low_error[3], double high_error[3], int32 is_proven, "
    "int32 reserved",
    "tsr_section_options": "double tolerance, double contact, double max_gap, uint64 max_points, int32 limit, "
    "int32 reserved",
    "tsr_sections_info": "uint64 planes, uint64 polylines, uint64 points, uint64 contacts, uint64 coplanar, "
    "uint64 unproven, double tolerance, double contact_size",
    "tsr_plane_section": "double offset, uint64 first_polyline, uint64 polyline_count, uint64 first_contact, "
    "uint64 contact_count, uint64 first_coplanar, uint64 coplanar_count, uint64 open_count, double length, "
    "double bound, double largest_gap, int32 limit, int32 reserved",
    "tsr_sections_out": "tsr_out first, tsr_out is_closed, tsr_out length, tsr_out position, tsr_out uv, "
    "tsr_out patch, tsr_out bridges_gap, tsr_out contact_position, tsr_out contact_patch, "
    "tsr_out contact_is_tangent, tsr_out coplanar, tsr_out unproven",
    "tsr_limits_info": "double float_operations_per_second, double double_operations_per_second, "
    "double store_bytes_per_second",
}
_WITHOUT_SIZE = ("tsr_in", "tsr_out")

# --- Functions --------------------------------------------------------------------------------------------------------
# The result and the arguments: i int32, u uint32, l int64, s size_t, d double, z text, p any pointer, - nothing.
_FUNCTIONS = {
    "tsr_version": "u",
    "tsr_last_message": "zp",
    "tsr_status_name": "zi",
    "tsr_retain": "ip",
    "tsr_release": "ip",
    "tsr_model_read": "ipzp",
    "tsr_model_parse": "ipzsz",
    "tsr_read_defaults": "-p",
    "tsr_model_read_file": "ipzpp",
    "tsr_model_read_bytes": "ippszpp",
    "tsr_bytes_data": "ppp",
    "tsr_mesh_bytes": "ipppz",
    "tsr_model_mesh_bytes": "ippppsz",
    "tsr_model_bytes": "ippz",
    "tsr_model_cad_bytes": "ipp",
    "tsr_model_new": "ipps",
    "tsr_model_join": "ippd",
    "tsr_model_save": "ipz",
    "tsr_model_describe": "ipp",
    "tsr_model_text": "zpis",
    "tsr_model_surface": "ipsp",
    "tsr_model_instance": "ipsp",
    "tsr_model_face": "ipsp",
    "tsr_set_defaults": "-p",
    "tsr_set_new": "ipppp",
    "tsr_set_describe": "ipp",
    "tsr_set_patch": "ipsppp",
    "tsr_set_edit": "ippsps",
    "tsr_set_grid": "ippspspp",
    "tsr_set_evaluate": "ipppppp",
    "tsr_plan_defaults": "-p",
    "tsr_plan_new": "ipppp",
    "tsr_plan_describe": "ipp",
    "tsr_plan_write": "ippp",
    "tsr_plan_edges": "ippsp",
    "tsr_plan_set_view": "ipp",
    "tsr_plan_update": "ippspsppp",
    "tsr_mesh_check": "ipp",
    "tsr_mesh_save": "ippz",
    "tsr_mesh_rounding": "ippzp",
    "tsr_model_save_meshes": "ipppsz",
    "tsr_scene_defaults": "-p",
    "tsr_scene_new": "ipppp",
    "tsr_scene_refit": "ipp",
    "tsr_scene_describe": "ipp",
    "tsr_scene_closest": "ipppp",
    "tsr_scene_occluded": "ipppp",
    "tsr_scene_all": "ipppp",
    "tsr_hits_read": "ipppp",
    "tsr_point_scene_new": "ippp",
    "tsr_point_scene_refit": "ipp",
    "tsr_point_scene_describe": "ipp",
    "tsr_point_scene_nearest": "ipppp",
    "tsr_solid_new": "ippp",
    "tsr_solid_describe": "ipp",
    "tsr_solid_contains": "ipppp",
    "tsr_solid_winding_numbers": "ipppp",
    "tsr_solid_distances": "ippppp",
    "tsr_measure_defaults": "-p",
    "tsr_measures_new": "ipppp",
    "tsr_measures_describe": "ipp",
    "tsr_measures_fault": "zpsp",
    "tsr_measures_area": "iplp",
    "tsr_measures_body": "iplp",
    "tsr_measures_box": "ipp",
    "tsr_section_defaults": "-p",
    "tsr_sections_new": "ippppspp",
    "tsr_sections_describe": "ipp",
    "tsr_sections_plane": "ipsp",
    "tsr_sections_read": "ipp",
    "tsr_limits": "isp",
    "tsr_set_grid_limit": "ipssppp",
}

_TYPES: dict[str, Any] = {
    "int32": ctypes.c_int32,
    "uint32": ctypes.c_uint32,
    "int64": ctypes.c_int64,
    "uint64": ctypes.c_uint64,
    "size": ctypes.c_size_t,
    "double": ctypes.c_double,
    "float": ctypes.c_float,
    "pointer": ctypes.c_void_p,
    "string": ctypes.c_char_p,
}
_LETTERS = {
    "i": ctypes.c_int32,
    "u": ctypes.c_uint32,
    "l": ctypes.c_int64,
    "s": ctypes.c_size_t,
    "d": ctypes.c_double,
    "z": ctypes.c_char_p,
    "p": ctypes.c_void_p,
    "-": None,
}


def _declare_struct(name: str, members: str) -> None:
    fields: list[tuple[str, Any]] = [] if name in _WITHOUT_SIZE else [("struct_size", ctypes.c_size_t)]
    for member in members.split(", "):
        kind, field = member.split(" ")
        field, _, length = field.partition("[")
        fields.append((field, _TYPES[kind] * int(length[:-1]) if length else _TYPES[kind]))
    _TYPES[name] = type(name, (ctypes.Structure,), {"_fields_": fields})


for _name, _members in _STRUCTS.items():
    _declare_struct(_name, _members)


def struct(name: str) -> ctypes.Structure:
    """Returns a new struct of zeros with its struct_size."""
    made = _TYPES[name]()
    made.struct_size = ctypes.sizeof(made)
    return made


In, Out = _TYPES["tsr_in"], _TYPES["tsr_out"]


def _places() -> list[pathlib.Path]:
    """Returns the files that may be the library, the best first."""
    named = os.environ.get("TESSERA_C_LIBRARY")
    if named:
        return [pathlib.Path(named)]
    here = pathlib.Path(__file__).resolve().parent
    places = [here / "lib" / "libtessera_c.so"]
    # In the source tree: the build that was made last.
    if (here.parents[2] / "engine" / "include").is_dir():
        built = here.parents[2].glob("build/*/engine/libtessera_c.so")
        places += sorted(built, key=lambda file: file.stat().st_mtime, reverse=True)
    # Installed by CMake: PREFIX/lib/pythonX/dist-packages/tessera.
    above = here.parents[2]
    places += [above / "libtessera_c.so.0", *above.glob("*-linux-gnu/libtessera_c.so.0")]
    return places


def _load() -> ctypes.CDLL:
    places = _places()
    for file in places:
        if file.is_file():
            library = ctypes.CDLL(str(file))
            reader = file.resolve().parents[1] / "tools" / "tessera-cad-reader"
            if reader.is_file():  # in a build; elsewhere the library finds the program itself
                os.environ.setdefault("TESSERA_CAD_READER", str(reader))
            break
    else:
        raise ImportError(
            "tessera: found no libtessera_c.so; expected it at one of "
            + ", ".join(str(file) for file in places)
            + ". Build the target tessera_c_library, or name the file by TESSERA_C_LIBRARY"
        )
    for name, letters in _FUNCTIONS.items():
        function = getattr(library, name)
        function.restype = _LETTERS[letters[0]]
        function.argtypes = [_LETTERS[letter] for letter in letters[1:]]
    return library


library = _load()
