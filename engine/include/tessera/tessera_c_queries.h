#ifndef TESSERA_TESSERA_C_QUERIES_H
#define TESSERA_TESSERA_C_QUERIES_H
/* Tessera for C: nearest points, points inside of solids, areas and volumes, sections by planes.
 *
 *   tsr_model* model = NULL;
 *   tsr_measures* measures = NULL;
 *   tsr_body body = {sizeof body};
 *   if (tsr_model_read(&model, "part.step", NULL) || tsr_measures_new(&measures, model, NULL, NULL) ||
 *       tsr_measures_body(measures, -1, &body))
 *     puts(tsr_last_message(NULL));
 *   else
 *     printf("volume %g, off by at most %g\n", body.volume, body.volume_error);
 *   tsr_release(measures), tsr_release(model);
 *
 * Statuses, handles, structs, memory and threads are those of tessera_c.h. nearest_points.h, solid.h, measures.h and
 * sections.h describe methods and bounds in full. */

#include "tessera/tessera_c.h"
#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/* --- Nearest points ---------------------------------------------------------------------------------------------- */
/* A set prepared for queries by points. After an edit of the set it is TSR_STALE until a refit. */
typedef struct tsr_point_scene tsr_point_scene;
tsr_status tsr_point_scene_new(tsr_point_scene** scene, const tsr_set* set, const tsr_run* run);
/* Follows edits of the set. */
tsr_status tsr_point_scene_refit(tsr_point_scene* scene, const tsr_run* run);
typedef struct tsr_point_scene_info {
  size_t struct_size;
  uint64_t memory_bytes, revision; /* the set's revision when the scene was made or last refitted */
} tsr_point_scene_info;
tsr_status tsr_point_scene_describe(const tsr_point_scene* scene, tsr_point_scene_info* info);

/* Points in the model's coordinates, one for each record of `position`. */
typedef struct tsr_query_points {
  size_t struct_size;
  int32_t is_double;   /* 1: numbers are double; 0: float */
  int32_t patches;     /* 0 or 1: the nearest point; n: those of the n nearest patches, in records n k to n k + n - 1 */
  tsr_in position;     /* three components */
  tsr_in max_distance; /* surfaces farther away count as none; null data: infinity; 1 record holds for all points */
} tsr_query_points;

enum { TSR_NEAREST_NONE = 0, TSR_NEAREST_FOUND, TSR_NEAREST_INVALID_POINT };
enum {
  TSR_NEAREST_CERTIFIED = 1,        /* no other point is nearer, up to rounding: proven */
  TSR_NEAREST_AMBIGUOUS = 2,        /* another point is as near */
  TSR_NEAREST_BORDER = 4,           /* on a border or a crease: the line to it is not perpendicular to the surface */
  TSR_NEAREST_DEGENERATE_NORMAL = 8 /* the normal is a limit, or 0 */
};
/* Nearest points, one record per point; null data: not computed. Unless a point is found, its distance is infinity, its
 * indices are 0xffffffff, and all but kind and flags is 0. */
typedef struct tsr_nearest_out {
  size_t struct_size;
  int32_t is_double;        /* 1: numbers are double; 0: float */
  int32_t reserved;         /* 0 */
  tsr_out kind;             /* uint8_t: TSR_NEAREST_NONE, ... */
  tsr_out flags;            /* uint8_t: TSR_NEAREST_CERTIFIED, ... */
  tsr_out surface, patch;   /* uint32_t */
  tsr_out distance;         /* a length */
  tsr_out uv, patch_uv;     /* two components: in the surface's domain, and in [0,1]^2 of the patch */
  tsr_out position, normal; /* in the model; unit, along du x dv */
} tsr_nearest_out;
/* Finds the nearest point of the surfaces, within their trimming loops, to each point. A point that is not finite, or
 * whose max_distance is NaN or below 0, is TSR_NEAREST_INVALID_POINT. Errors: TSR_INVALID_ARGUMENT (patches below 0 or
 * above 2^20), TSR_COUNT_MISMATCH, TSR_BUFFER_TOO_SMALL,
 * TSR_STALE. */
tsr_status tsr_point_scene_nearest(const tsr_point_scene* scene, const tsr_query_points* points,
                                   const tsr_nearest_out* nearest, const tsr_run* run);

/* --- Solids ------------------------------------------------------------------------------------------------------ */
/* A surface, closed or open, prepared for the question which points lie inside. It keeps its scene; make it anew after
 * the scene's refit. */
typedef struct tsr_solid tsr_solid;
tsr_status tsr_solid_new(tsr_solid** solid, const tsr_scene* scene, const tsr_run* run);
typedef struct tsr_solid_info {
  size_t struct_size;
  uint64_t open_borders; /* edges and borders of patches where the surface is open */
  int32_t is_closed;
  int32_t reserved; /* 0 */
} tsr_solid_info;
tsr_status tsr_solid_describe(const tsr_solid* solid, tsr_solid_info* info);

enum { TSR_SIDE_OUTSIDE = 0, TSR_SIDE_INSIDE, TSR_SIDE_UNKNOWN, TSR_SIDE_INVALID_POINT };
/* Answers, one record per point; null data: not wanted. */
typedef struct tsr_sides_out {
  size_t struct_size;
  tsr_out side;         /* uint8_t: TSR_SIDE_OUTSIDE, ... */
  tsr_out is_certified; /* uint8_t: 1 if the side is proven, unless the point lies on the surface up to rounding */
} tsr_sides_out;
/* Tells on which side each point lies. points->max_distance must be null data, and patches 0 or 1. Memory: 32 bytes per
 * point during the call. Errors: TSR_BUFFER_TOO_SMALL, TSR_STALE. */
tsr_status tsr_solid_contains(const tsr_solid* solid, const tsr_query_points* points, const tsr_sides_out* sides,
                              const tsr_run* run);
/* Writes the generalized winding number of each point, double: the solid angle that the surface covers, seen from
 * there, as a share of the whole sphere. A closed surface has 1 inside and 0 outside, an open one numbers in between;
 * where the surface is open, tsr_solid_contains() tells sides by them: inside above 0.5 in absolute value, unknown at
 * 0.5 within 1e-6. NaN for a point that is not finite. solid.h tells how faces are turned. Otherwise as
 * tsr_solid_contains(). */
tsr_status tsr_solid_winding_numbers(const tsr_solid* solid, const tsr_query_points* points, const tsr_out* numbers,
                                     const tsr_run* run);
/* Writes the distance of each point from the surface, double, negative inside; NaN where the side is unknown, and for a
 * point that is not finite. `scene`: of the solid's set, else TSR_STALE. Otherwise as tsr_solid_contains(). */
tsr_status tsr_solid_distances(const tsr_solid* solid, const tsr_point_scene* scene, const tsr_query_points* points,
                               const tsr_out* distances, const tsr_run* run);

/* --- Measures ---------------------------------------------------------------------------------------------------- */
/* Areas, volumes and boxes of a model, each with a bound of its error. */
typedef struct tsr_measures tsr_measures;
enum {
  TSR_MEASURE_AREAS = 1,   /* of all surfaces */
  TSR_MEASURE_BODIES = 2,  /* of the solids and closed shells of all instances */
  TSR_MEASURE_BOX = 4,     /* of the whole model */
  TSR_MEASURE_ENCLOSED = 8 /* instead of solids, the one body that all surfaces enclose, taking for granted that they
                              leave no gap, and that all normals point outwards, or all inwards */
};
typedef struct tsr_measure_options {
  size_t struct_size;
  double accuracy;    /* the error as a share, 1e-14 to 1e-2; 1e-10 by default */
  uint64_t max_cells; /* parts of a patch, at least 1; 4096 by default */
  uint32_t flags;     /* TSR_MEASURE_*, at least one; all but TSR_MEASURE_ENCLOSED by default */
  uint32_t reserved;  /* 0 */
} tsr_measure_options;
void tsr_measure_defaults(tsr_measure_options* options);
/* Measures a model. Errors: TSR_INVALID_ARGUMENT (options; with TSR_MEASURE_BODIES: a solid that is open, faces that
 * cannot be oriented, index = the shape). */
tsr_status tsr_measures_new(tsr_measures** measures, const tsr_model* model, const tsr_measure_options* options,
                            const tsr_run* run);
typedef struct tsr_measures_info {
  size_t struct_size;
  uint64_t surfaces, bodies; /* that are measured; 0 without the flag */
  uint64_t faults;           /* surfaces whose loops could not be used: they are measured whole, and not proven */
} tsr_measures_info;
tsr_status tsr_measures_describe(const tsr_measures* measures, tsr_measures_info* info);
/* Returns why the loops of a surface could not be used, as long as the measures live; NULL if there is no such fault.
 * *surface, unless `surface` is NULL: the index of the surface. */
const char* tsr_measures_fault(const tsr_measures* measures, size_t index, size_t* surface);

typedef struct tsr_area {
  size_t struct_size;
  double area, area_error; /* of the kept part; the true number is off by at most the error, as elsewhere */
  double centroid[3], centroid_error;
  int32_t is_proven; /* 0: the errors rest on samples, or on a fit */
  int32_t reserved;  /* 0 */
} tsr_area;
/* `surface`: -1: all together. */
tsr_status tsr_measures_area(const tsr_measures* measures, int64_t surface, tsr_area* area);

/* A body of density 1. */
typedef struct tsr_body {
  size_t struct_size;
  uint32_t instance, shape, solid, shell; /* 0xffffffff: none */
  double volume, volume_error;            /* without cavities */
  double centroid[3], centroid_error;
  double inertia[6], inertia_error; /* about the centroid: xx, yy, zz, xy, yz, zx; xy = integral of -x y */
  double moments[3], moments_error; /* principal moments, rising */
  double axes[9];                   /* their directions, of length 1, one after the other */
  double gap;                       /* the largest distance of two faces along an edge; slits are part of the errors */
  int32_t is_proven;
  int32_t reserved; /* 0 */
} tsr_body;
/* `body`: -1: all together, as bodies that do not overlap; an error if there is none. */
tsr_status tsr_measures_body(const tsr_measures* measures, int64_t body, tsr_body* filled);

typedef struct tsr_box {
  size_t struct_size;
  double low[3], high[3];             /* contains the model */
  double low_error[3], high_error[3]; /* how far each side is from the model at most */
  int32_t is_proven;
  int32_t reserved; /* 0 */
} tsr_box;
tsr_status tsr_measures_box(const tsr_measures* measures, tsr_box* box);

/* --- Sections ---------------------------------------------------------------------------------------------------- */
/* Where parallel planes cut a set, as polylines whose points lie on the surface. */
typedef struct tsr_sections tsr_sections;
enum {
  TSR_LIMIT_AUTOMATIC = 0, /* below; above where there is nothing below */
  TSR_LIMIT_BELOW,         /* of planes with a smaller offset */
  TSR_LIMIT_ABOVE          /* of planes with a larger offset */
};
typedef struct tsr_section_options {
  size_t struct_size;
  double tolerance;    /* the largest distance of a chord from the curve; 0 (default): 1e-4 of the size */
  double contact;      /* the height within which a point counts as one of the plane's; below 0 (default): as suits */
  double max_gap;      /* ends on one edge farther apart stay open; below 0 (default): 5e-3 of the size */
  uint64_t max_points; /* of all polylines; 2^28 by default */
  int32_t limit;       /* where a plane runs along a face: TSR_LIMIT_AUTOMATIC (default), ... */
  int32_t reserved;    /* 0 */
} tsr_section_options;
void tsr_section_defaults(tsr_section_options* options);
/* Cuts a set by the planes of the points p with dot(normal, p) = offsets[k]. `normal`: three numbers, of any length but
 * 0. Errors: TSR_INVALID_ARGUMENT (index = the offset that is not finite; more than max_points). */
tsr_status tsr_sections_new(tsr_sections** sections, const tsr_set* set, const double* normal, const double* offsets,
                            size_t count, const tsr_section_options* options, const tsr_run* run);
typedef struct tsr_sections_info {
  size_t struct_size;
  uint64_t planes, polylines, points, contacts;
  uint64_t coplanar; /* patches that lie in a plane, which have no polylines */
  uint64_t unproven; /* patches whose section is not proven to be complete */
  double tolerance, contact_size;
} tsr_sections_info;
tsr_status tsr_sections_describe(const tsr_sections* sections, tsr_sections_info* info);
/* Ranges of the arrays below, and what is known of the section of one plane. */
typedef struct tsr_plane_section {
  size_t struct_size;
  double offset;
  uint64_t first_polyline, polyline_count, first_contact, contact_count, first_coplanar, coplanar_count;
  uint64_t open_count; /* polylines that are not closed */
  double length;       /* of all polylines */
  double bound;        /* the largest distance of a chord from the curve, proven */
  double largest_gap;  /* between two ends that were joined across faces */
  int32_t limit;       /* the side that was taken */
  int32_t reserved;    /* 0 */
} tsr_plane_section;
tsr_status tsr_sections_plane(const tsr_sections* sections, size_t plane, tsr_plane_section* section);
/* Arrays to write to; null data: not wanted. */
typedef struct tsr_sections_out {
  size_t struct_size;
  tsr_out first;       /* uint64_t, of polylines, and 1 more: points first[k] to first[k + 1] - 1 are polyline k's */
  tsr_out is_closed;   /* uint8_t, of polylines: a segment leads from the last point to the first */
  tsr_out length;      /* double, of polylines */
  tsr_out position;    /* double, three components, of points */
  tsr_out uv;          /* double, two components, of points: in the surface's domain */
  tsr_out patch;       /* uint32_t, of points */
  tsr_out bridges_gap; /* uint8_t, of points: the segment that follows crosses a gap between two faces */
  tsr_out contact_position, contact_patch; /* of contacts: double, three components; uint32_t */
  tsr_out contact_is_tangent; /* uint8_t, of contacts: 1: tangent, along a curve or at a saddle; 0: a point */
  tsr_out coplanar, unproven; /* uint32_t, patches */
} tsr_sections_out;
/* Copies the sections to arrays. Errors, with nothing written: TSR_BUFFER_TOO_SMALL. */
tsr_status tsr_sections_read(const tsr_sections* sections, const tsr_sections_out* out);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
