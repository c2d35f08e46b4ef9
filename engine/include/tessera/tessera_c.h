#ifndef TESSERA_TESSERA_C_H
#define TESSERA_TESSERA_C_H
/* Tessera for C and for languages that call C: models, patch sets, evaluation, meshes and rays.
 *
 *   tsr_model* model = NULL;
 *   tsr_set* set = NULL;
 *   tsr_plan* plan = NULL;
 *   tsr_plan_options options;
 *   tsr_plan_defaults(&options);
 *   options.tolerance = 1e-3;
 *   if (tsr_model_read(&model, "part.step", NULL) || tsr_set_new(&set, model, NULL, NULL) ||
 *       tsr_plan_new(&plan, set, &options, NULL))
 *     puts(tsr_last_message(NULL));
 *   tsr_release(plan), tsr_release(set), tsr_release(model);
 *
 * Status: functions return TSR_OK (0) or an error, with a sentence in tsr_last_message(). None aborts or throws. On an
 * error outputs are unchanged, unless the function says otherwise, and new handles are NULL.
 *
 * Handles: a function that makes one makes one reference, which tsr_release() gives up. A handle keeps what it needs: a
 * scene its set, a set its model. One that was released, or is of another kind, is TSR_INVALID_HANDLE.
 *
 * Structs: `struct_size` is sizeof the struct as the caller was compiled with, so that later versions can append
 * members. tsr_*_defaults() fills a struct of options; a null pointer stands for the defaults. In structs that are
 * filled, the caller sets struct_size alone. Members named is_... must be 0 or 1, and `reserved` must be 0.
 *
 * Memory: the library keeps no pointer of the caller's beyond a call, and returns nothing to free but handles.
 *
 * Threads: any number of calls at once, also on one handle. An edit of a set, an update of a plan and a refit of a
 * scene need it alone; the later call returns TSR_IN_USE. In a child that was forked after the library had computed,
 * calls that compute return TSR_UNSUPPORTED, since the threads are the parent's.
 */

#include <stddef.h>
#include <stdint.h>
#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/* --- Status ------------------------------------------------------------------------------------------------------ */
typedef int32_t tsr_status;
enum {
  TSR_OK = 0,
  TSR_INVALID_ARGUMENT,   /* a value outside its stated range, a null pointer, a struct of another size */
  TSR_NON_FINITE,         /* NaN or infinity in a number of a surface, a point or a parameter */
  TSR_INVALID_WEIGHT,     /* a weight that is not finite and positive */
  TSR_UNSUPPORTED_DEGREE, /* a degree below 1 or above 15 */
  TSR_COUNT_MISMATCH,     /* a list whose length does not fit the others */
  TSR_BUFFER_TOO_SMALL,   /* an output with less room than the call needs */
  TSR_UNSUPPORTED,        /* valid, but not available here */
  TSR_ISA_UNAVAILABLE,    /* an instruction set that is unknown or that this machine lacks */
  TSR_STALE,              /* an object made for an earlier state of the set, or for another set */
  TSR_PARSE_ERROR,        /* a file whose content does not follow its format */
  TSR_IO_ERROR,           /* a file that cannot be opened, read or written */
  TSR_OUT_OF_MEMORY,      /* an allocation failed */
  TSR_CANCELLED,          /* tsr_run.cancel was seen; outputs are partly written */
  TSR_INTERNAL,           /* a fault of the library or of a dependency */
  TSR_INVALID_HANDLE,     /* null, released, or of another kind */
  TSR_IN_USE              /* another call uses the object, and one of the two changes it */
};

/* Returns the library's version, 10000 * major + 100 * minor + patch. */
uint32_t tsr_version(void);
/* Returns the sentence of this thread's last error, or "", valid until its next call. *index, unless `index` is NULL:
 * the element that it names, or -1. */
const char* tsr_last_message(int64_t* index);
/* Returns a code's name, "invalid_argument"; "unknown" for other numbers. */
const char* tsr_status_name(tsr_status code);

/* Adds a reference to a handle of any kind. Errors: TSR_INVALID_HANDLE. */
tsr_status tsr_retain(void* handle);
/* Gives up a reference; the last one frees the object, after the calls that use it. NULL does nothing. Errors: same. */
tsr_status tsr_release(void* handle);

/* --- How calls run ----------------------------------------------------------------------------------------------- */
enum { TSR_MAX_THREADS = 1024 };
/* A NULL pointer to it: all threads of the machine. */
typedef struct tsr_run {
  size_t struct_size;
  int32_t threads;                            /* 1 to TSR_MAX_THREADS; 0: all of the machine */
  int32_t reserved;                           /* 0 */
  const volatile uint8_t* cancel;             /* NULL, or 0 until another thread sets it to 1: the call then ends */
  void (*progress)(double share, void* user); /* NULL, or called from any thread, one call at a time: 0 to 1 */
  void* user;                                 /* for `progress` */
} tsr_run;

/* Records of the caller's memory: component c of record k lies at data + k * record + c * component bytes. With strides
 * of 0 the records are packed: x, y, z, x, y, z, ... Null data: not wanted. The type of the numbers is stated where
 * a view is used; addresses must be aligned for it. */
typedef struct tsr_in {
  const void* data;
  size_t count; /* records */
  int64_t record, component;
} tsr_in;
typedef struct tsr_out {
  void* data;
  size_t count; /* records that fit */
  int64_t record, component;
} tsr_out;

/* --- Models ------------------------------------------------------------------------------------------------------ */
/* The surfaces of a file or of a program: with names, placements, trims, shapes, instances. */
typedef struct tsr_model tsr_model;

/* A spline surface; without knots a Bezier patch. */
typedef struct tsr_bspline {
  size_t struct_size;
  int32_t degree_u, degree_v;        /* 1 to 15 */
  size_t count_u, count_v;           /* control points along u and v */
  const double* points;              /* [count_u][count_v][3] */
  const double* weights;             /* [count_u][count_v], above 0; NULL: polynomial */
  const double *knots_u, *knots_v;   /* both NULL: Bezier, with degree + 1 points each way */
  size_t knot_count_u, knot_count_v; /* count + degree + 1 */
  const char* name;                  /* NULL: none */
} tsr_bspline;

/* Reads a file: .json, .step, .iges, .brep, .g2, .obj, .rib, .bpt, .bv; the extension decides. IGES and BREP need the
 * program tessera-cad-reader, beside the library or on PATH. Errors: TSR_IO_ERROR, TSR_PARSE_ERROR,
 * TSR_UNSUPPORTED, and those of surfaces. */
tsr_status tsr_model_read(tsr_model** model, const char* path, const tsr_run* run);
/* Reads the text of a JSON file, which has surfaces of every kind; `name` stands for the file in messages. */
tsr_status tsr_model_parse(tsr_model** model, const char* text, size_t length, const char* name);
/* Makes a model of spline surfaces; all have the same struct_size. Errors: those of splines, index = the surface. */
tsr_status tsr_model_new(tsr_model** model, const tsr_bspline* surfaces, size_t count);
/* Makes a model whose faces share edges where these run side by side within `distance`, a length; 0: a distance that
 * suits the faces. Edges that the file states stay. */
tsr_status tsr_model_join(tsr_model** joined, const tsr_model* model, double distance);
/* Writes the surfaces as .json, .obj or .bpt. */
tsr_status tsr_model_save(const tsr_model* model, const char* path);

typedef struct tsr_model_info {
  size_t struct_size;
  uint64_t surfaces, shapes, instances, warnings;
  uint64_t trimmed; /* surfaces with trimming loops */
} tsr_model_info;
tsr_status tsr_model_describe(const tsr_model* model, tsr_model_info* info);
enum {
  TSR_TEXT_UNIT = 0,     /* of all lengths: "mm"; "": none is stated */
  TSR_TEXT_WARNING,      /* a part of the file that is skipped */
  TSR_TEXT_SURFACE,      /* a surface's name */
  TSR_TEXT_SURFACE_KIND, /* "B-spline surface" */
  TSR_TEXT_SHAPE,        /* a shape's name */
  TSR_TEXT_INSTANCE      /* an instance's name */
};
/* Returns a text of a model in UTF-8, as long as the model lives; NULL if the index or the handle is none. */
const char* tsr_model_text(const tsr_model* model, int32_t kind, size_t index);

typedef struct tsr_surface_info {
  size_t struct_size;
  double domain[4]; /* u0, u1, v0, v1 */
  uint64_t loops;   /* trimming loops */
} tsr_surface_info;
tsr_status tsr_model_surface(const tsr_model* model, size_t surface, tsr_surface_info* info);

/* A shape at its place. Its faces are the surfaces from first_surface on. */
typedef struct tsr_instance_info {
  size_t struct_size;
  uint64_t shape, first_surface;
  double placement[12]; /* three columns, then the translation */
  float colour[4];      /* sRGB and alpha, 0 to 1 */
  int32_t has_colour;
} tsr_instance_info;
tsr_status tsr_model_instance(const tsr_model* model, size_t instance, tsr_instance_info* info);

/* --- Patch sets -------------------------------------------------------------------------------------------------- */
/* Bezier patches of a model, packed for evaluation, meshes and rays. */
typedef struct tsr_set tsr_set;

enum {
  TSR_SET_WHOLE = 1,  /* trimming loops do not count */
  TSR_SET_POINTS = 2, /* prepared for tsr_set_evaluate() */
  TSR_SET_DOUBLE = 4  /* for grids in double */
};
typedef struct tsr_set_options {
  size_t struct_size;
  int64_t shape;        /* the faces of one shape, in its own space; -1 (default): all surfaces in the model's */
  uint32_t flags;       /* TSR_SET_* */
  uint32_t reserved;    /* 0 */
  double fit_tolerance; /* of surfaces that have no exact patches, a length; 0 (default): 1e-6 of the size */
} tsr_set_options;
void tsr_set_defaults(tsr_set_options* options);
tsr_status tsr_set_new(tsr_set** set, const tsr_model* model, const tsr_set_options* options, const tsr_run* run);

typedef struct tsr_set_info {
  size_t struct_size;
  uint64_t patches, surfaces, cut_patches, memory_bytes, revision;
  double low[3], high[3], origin[3]; /* the box of all control points; what float positions are relative to */
  double fit_error;                  /* 0: all patches are exact */
  uint64_t unused_loops;             /* surfaces whose loops could not be used; they are whole */
} tsr_set_info;
tsr_status tsr_set_describe(const tsr_set* set, tsr_set_info* info);

typedef struct tsr_patch_info {
  size_t struct_size;
  int32_t degree_u, degree_v, is_rational, is_cut;
  uint64_t surface;
  double domain[4]; /* its rectangle of the surface's parameters: u0, u1, v0, v1 */
} tsr_patch_info;
/* Describes a patch, and copies its (degree_u + 1) * (degree_v + 1) control points to `points` [i][j][3] and weights to
 * `weights`, where these are not NULL. */
tsr_status tsr_set_patch(const tsr_set* set, size_t patch, tsr_patch_info* info, double* points, double* weights);
/* Sets all control points of some patches: those of patches[k] follow those of patches[k - 1]. `point_count` is that of
 * all. Plans and scenes are stale until they are updated. After an error at patches[index] those before it are set. */
tsr_status tsr_set_edit(tsr_set* set, const uint32_t* patches, size_t count, const double* points, size_t point_count);

/* Outputs of an evaluation; null data: not computed. Vectors have three components, the rest one. */
typedef struct tsr_jets {
  size_t struct_size;
  int32_t is_double;                         /* 1: numbers are double; 0: float */
  int32_t reserved;                          /* 0 */
  tsr_out position;                          /* in the model; of grids in float relative to the set's origin */
  tsr_out du, dv, duu, duv, dvv;             /* derivatives */
  tsr_out normal;                            /* unit, along du x dv; 0 where undefined */
  tsr_out first_form, second_form;           /* E, F, G and L, M, N */
  tsr_out gaussian, mean;                    /* curvatures */
  tsr_out first_curvature, second_curvature; /* k1 >= k2 */
  tsr_out first_direction, second_direction; /* unit tangents */
} tsr_jets;
/* Evaluates at count_u * count_v points of each patch, u and v in [0,1]: record (patch * count_u + iu) * count_v + iv.
 * Derivatives are by the patch's parameters. In double the set needs TSR_SET_DOUBLE. */
tsr_status tsr_set_grid(const tsr_set* set, const double* u, size_t count_u, const double* v, size_t count_v,
                        const tsr_jets* out, const tsr_run* run);
/* Evaluates one point for each record of u, in double. Without TSR_SET_POINTS the first call after each edit packs the
 * set. `surface`: uint32_t, null data: surface 0; `u`, `v`: double, in the surface's parameters, as are derivatives. */
tsr_status tsr_set_evaluate(const tsr_set* set, const tsr_in* surface, const tsr_in* u, const tsr_in* v,
                            const tsr_jets* out, const tsr_run* run);

/* --- Meshes ------------------------------------------------------------------------------------------------------ */
/* How a set is divided into triangles. */
typedef struct tsr_plan tsr_plan;
enum {
  TSR_PLAN_RELATIVE = 1,     /* the tolerance is a share of the set's size */
  TSR_PLAN_SHARE = 2,        /* patches share the vertices of their borders by index */
  TSR_PLAN_QUADS = 4,        /* whole cells are quads */
  TSR_PLAN_FEWEST = 8,       /* look for fewer triangles, at a hundred times the time */
  TSR_PLAN_SMALLEST = 16,    /* the smallest tolerance for which max_triangles suffice */
  TSR_PLAN_DOUBLE = 32,      /* positions in double */
  TSR_PLAN_APART = 64,       /* faces of shapes do not share vertices along edges */
  TSR_PLAN_UV_SURFACE = 128, /* parameters of the surface: the default, but none with TSR_PLAN_SHARE */
  TSR_PLAN_UV_UNIT = 256,    /* as shares of its domain */
  TSR_PLAN_UV_PATCH = 512,   /* of the patch: not with TSR_PLAN_SHARE */
  TSR_PLAN_EDGES = 1024      /* prepared for tsr_plan_edges(): not with TSR_PLAN_APART */
};
/* At least one of tolerance(s), angle, pixels and TSR_PLAN_SMALLEST is needed, or rates alone. */
typedef struct tsr_plan_options {
  size_t struct_size;
  double tolerance; /* the largest distance between surfaces and mesh, proven; 0 (default): none */
  double angle;     /* the largest turn of the normals in a triangle, radians, to pi/2; 0 (default): none */
  double pixels;    /* the largest distance in the picture of `eye`, ...; 0 (default): none */
  double eye[3], target[3], up[3];
  double field_of_view;   /* radians, across the shorter side; 40 degrees by default */
  double extent;          /* above 0: parallel rays, and the length that the shorter side shows; 0 by default */
  double near_distance;   /* 0 (default): a thousandth of the target's distance */
  int32_t width, height;  /* of the picture; 1280 x 800 by default */
  int32_t rate_u, rate_v; /* segments of every patch, 1 to 4096, proving nothing; 0 (default): none */
  uint32_t flags;         /* TSR_PLAN_* */
  uint32_t reserved;      /* 0 */
  double weld;            /* the largest distance of borders that are joined; below 0 (default): as suits */
  double crease_angle;    /* the largest angle of normals that are joined, radians; below 0 (default): none are */
  double max_gap;         /* edges with faces farther apart stay open; below 0 (default): none */
  double spare;           /* cells that an edited patch may have too many, as a share; 0.25 by default */
  uint64_t max_triangles; /* 2^30 by default */
  double headroom;        /* the part of the tolerances that is left for updates, 0 (default) to 0.9 */
  const double* surface_tolerances; /* instead of `tolerance`, for each surface of the set; NULL (default): none */
  size_t surface_tolerance_count;
} tsr_plan_options;
void tsr_plan_defaults(tsr_plan_options* options);
tsr_status tsr_plan_new(tsr_plan** plan, const tsr_set* set, const tsr_plan_options* options, const tsr_run* run);
typedef struct tsr_plan_info {
  size_t struct_size;
  uint64_t vertices, triangles, quads; /* of the mesh, exactly */
  double tolerance;                    /* as a length */
  double bound;                        /* the distance that is proven, infinite with rates */
  double gap;                          /* how far faces fail to meet at edges: points lie within bound + gap */
  double angle, pixels;                /* proven, 0 if not wanted */
  int32_t is_certified, has_normals;
  uint64_t open_edges;      /* edges of one triangle */
  uint64_t crossed_patches; /* left out, since their loops are no polygon */
  double seen_bound;        /* with pixels: `bound` of the patches that the view sees; else `bound` */
} tsr_plan_info;
tsr_status tsr_plan_describe(const tsr_plan* plan, tsr_plan_info* info);
/* A mesh in the caller's memory. Null data: not wanted. */
typedef struct tsr_mesh {
  size_t struct_size;
  tsr_out position;                       /* float, relative to the set's origin */
  tsr_out normal;                         /* float, unit */
  tsr_out parameter;                      /* float, u and v: see TSR_PLAN_UV_SURFACE */
  tsr_out position_f64;                   /* double, in the model: with TSR_PLAN_DOUBLE */
  uint32_t *triangles, *triangle_patches; /* three vertices each, counter-clockwise; and the patch */
  uint32_t *quads, *quad_patches;         /* four each: with TSR_PLAN_QUADS */
  size_t triangle_count, quad_count;      /* that fit */
} tsr_mesh;
/* Writes the mesh of the plan's set; positions and triangles are required. Errors: TSR_BUFFER_TOO_SMALL, TSR_STALE. */
tsr_status tsr_plan_write(const tsr_plan* plan, const tsr_mesh* mesh, const tsr_run* run);
/* Takes the view, `eye` to `height`, that the next tsr_plan_update() plans for, with or without edits. */
tsr_status tsr_plan_set_view(tsr_plan* plan, const tsr_plan_options* view);
/* Sets control points as tsr_set_edit(), proves the tolerances again, and moves the mesh that was written. *topology is
 * 1 if the mesh has other triangles now: nothing was written, describe and write again. */
tsr_status tsr_plan_update(tsr_plan* plan, const uint32_t* patches, size_t count, const double* points,
                           size_t point_count, const tsr_mesh* mesh, int32_t* topology, const tsr_run* run);
typedef struct tsr_mesh_report {
  size_t struct_size;
  uint64_t vertices, distinct_positions, triangles, quads;
  uint64_t open_edges, non_manifold_edges, inconsistent_edges, t_junctions;
  uint64_t flipped_triangles, degenerate_triangles, non_finite_vertices;
} tsr_mesh_report;
/* Counts the faults of a mesh. */
tsr_status tsr_mesh_check(const tsr_mesh* mesh, tsr_mesh_report* report);
/* Writes .obj, .ply, .stl, .glb or .gltf. `set`: of the plan, for origin, names and colours; NULL: the origin is 0. */
tsr_status tsr_mesh_save(const tsr_mesh* mesh, const tsr_set* set, const char* path);
/* *rounding: how far that file may move vertices, which adds to tsr_plan_info.bound. */
tsr_status tsr_mesh_rounding(const tsr_mesh* mesh, const tsr_set* set, const char* path, double* rounding);
/* Writes one mesh per shape of a model, each at all its places, with names and colours. `sets`: those of the meshes. */
tsr_status tsr_model_save_meshes(const tsr_model* model, const tsr_mesh* const* meshes, const tsr_set* const* sets,
                                 size_t count, const char* path);

/* --- Rays -------------------------------------------------------------------------------------------------------- */
/* A set prepared for rays, which meet the surfaces themselves, within their trimming loops. */
typedef struct tsr_scene tsr_scene;
typedef struct tsr_scene_options {
  size_t struct_size;
  double tolerance;    /* how far a point may lie from the ray, a length; 0 (default): 2e-12 of the size */
  int32_t pieces;      /* of a patch, per direction: 1 (default), 2, 4 or 8 */
  int32_t is_editable; /* 1: prepared for refits; rays take a fifth longer */
} tsr_scene_options;
void tsr_scene_defaults(tsr_scene_options* options);
tsr_status tsr_scene_new(tsr_scene** scene, const tsr_set* set, const tsr_scene_options* options, const tsr_run* run);
/* Follows edits of the set. */
tsr_status tsr_scene_refit(tsr_scene* scene, const tsr_run* run);
typedef struct tsr_scene_info {
  size_t struct_size;
  uint64_t memory_bytes;
  double low[3], high[3]; /* the box of all that rays can meet */
  double spawn_offset;    /* tsr_rays.spawn_offset for rays that start on a surface */
} tsr_scene_info;
tsr_status tsr_scene_describe(const tsr_scene* scene, tsr_scene_info* info);
/* Rays origin + t * direction, tnear <= t <= tfar. One ray for each record of `direction`; other views with 1 record
 * hold for all rays. A ray that is not valid is a miss. */
typedef struct tsr_rays {
  size_t struct_size;
  int32_t is_double; /* 1: numbers are double; 0: float */
  int32_t reserved;  /* 0 */
  tsr_in origin, direction;
  tsr_in tnear, tfar;  /* null data: 0, and infinity */
  tsr_in spawn_offset; /* how far from the origin surfaces do not count; null data: 0 */
} tsr_rays;

enum { TSR_MISS = 0, TSR_HIT, TSR_INVALID_RAY };
enum {
  TSR_HIT_DEGENERATE_NORMAL = 2, /* the normal is a limit, or 0 */
  TSR_HIT_UNCERTIFIED = 4,       /* within the tolerance of the ray, but not proven to be the only root nearby */
  TSR_HIT_INCOMPLETE = 8,        /* there may be other hits */
  TSR_HIT_TANGENTIAL = 16,       /* uncertified, along the tangent plane */
  TSR_HIT_WITHIN_TOLERANCE = 32, /* uncertified, off the ray by more than rounding */
  TSR_HIT_EDGE = 64              /* the ray passes an edge of a shape within its gap */
};
/* Hits, one record per ray. A miss has t = infinity, indices of 0xffffffff and 0 elsewhere. */
typedef struct tsr_hits_out {
  size_t struct_size;
  int32_t is_double;      /* 1: numbers are double; 0: float */
  int32_t reserved;       /* 0 */
  tsr_out kind;           /* uint8_t: TSR_MISS, ... */
  tsr_out flags;          /* uint8_t: TSR_HIT_* */
  tsr_out surface, patch; /* uint32_t */
  tsr_out t;
  tsr_out uv, patch_uv;     /* two components: in the surface's domain, and in [0,1]^2 of the patch */
  tsr_out position, normal; /* in the model; unit, along du x dv */
  tsr_out du, dv;           /* derivatives by the surface's parameters */
  tsr_out residual;         /* distance from the ray */
} tsr_hits_out;
/* Finds the closest hit of each ray. */
tsr_status tsr_scene_closest(const tsr_scene* scene, const tsr_rays* rays, const tsr_hits_out* hits,
                             const tsr_run* run);
/* Writes 1 where anything lies on the ray, else 0; uint8_t. */
tsr_status tsr_scene_occluded(const tsr_scene* scene, const tsr_rays* rays, const tsr_out* occluded,
                              const tsr_run* run);

/* All hits of rays: a list that is read once it is known how many there are. */
typedef struct tsr_hits tsr_hits;
tsr_status tsr_scene_all(tsr_hits** hits, const tsr_scene* scene, const tsr_rays* rays, const tsr_run* run);
/* Writes the hits, ray after ray, by growing t. `first`: NULL, or one number more than there are rays: hits first[k] to
 * first[k + 1] - 1 are those of ray k. `out`: NULL, or as many records as `count` says, which may be NULL. */
tsr_status tsr_hits_read(const tsr_hits* hits, size_t* count, uint64_t* first, const tsr_hits_out* out);

typedef struct tsr_limits_info {
  size_t struct_size;
  double float_operations_per_second, double_operations_per_second; /* fused multiply-adds, of one thread */
  double store_bytes_per_second;
} tsr_limits_info;
/* Measures this machine on the calling thread, in a fraction of a second. `store_bytes`: of the output; 0: 160 MiB. */
tsr_status tsr_limits(size_t store_bytes, tsr_limits_info* info);
/* *seconds: the least that tsr_set_grid() takes one thread of a machine with these limits, whatever the program. */
tsr_status tsr_set_grid_limit(const tsr_set* set, size_t count_u, size_t count_v, const tsr_jets* out,
                              const tsr_limits_info* limits, double* seconds);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
