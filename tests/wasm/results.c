/* Results of the C interface for files, as tests/wasm/results.mjs makes them by tessera.wasm:
 *   results FILE...
 * prints for each file "error CODE BYTES" and the sentence; or "mesh WARNINGS VERTICES TRIANGLES BYTES RAYS", the
 * warnings, positions, normals, corners of triangles, a .glb of so many bytes, and the closest hits of so many rays.
 * Every number before a line's end is followed by that many bytes or records. Models are read as bytes, and divided
 * with a tolerance of a thousandth of their size.
 */

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tessera/tessera_c_files.h"

static void* allocate(size_t bytes) {
  void* const memory = malloc(bytes > 0 ? bytes : 1);
  if (!memory) abort();
  return memory;
}

static void print(const void* data, size_t bytes) {
  if (fwrite(data, 1, bytes, stdout) != bytes) abort();
}

static char* content_of(const char* path, size_t* size) {
  FILE* const file = fopen(path, "rb");
  if (!file || fseek(file, 0, SEEK_END) != 0) abort();
  *size = (size_t)ftell(file);
  rewind(file);
  char* const bytes = allocate(*size);
  if (fread(bytes, 1, *size, file) != *size) abort();
  fclose(file);
  return bytes;
}

/* The warnings of a model, a line each. */
static char* warnings_of(const tsr_model* model) {
  tsr_model_info info = {.struct_size = sizeof info};
  if (tsr_model_describe(model, &info)) abort();
  size_t bytes = 1;
  for (size_t k = 0; k < info.warnings; ++k) bytes += strlen(tsr_model_text(model, TSR_TEXT_WARNING, k)) + 1;
  char* const text = allocate(bytes);
  *text = 0;
  for (size_t k = 0; k < info.warnings; ++k) strcat(strcat(text, tsr_model_text(model, TSR_TEXT_WARNING, k)), "\n");
  return text;
}

enum { ray_count = 200 };

/* The closest hits of rays, an array a member. */
struct hits {
  double t[ray_count], uv[2 * ray_count];
  uint32_t patch[ray_count];
  uint8_t kind[ray_count], flags[ray_count];
};

/* Fills rays from points in and around a box to points in it: the same numbers as raysOf() of results.mjs makes. The
 * box is rounded to float, so that its last bits, which may differ, do not count. */
static void aim(const tsr_set_info* set, double origin[][3], double direction[][3]) {
  int64_t state = 1;
  for (int n = 0; n < ray_count; ++n)
    for (int c = 0; c < 3; ++c) {
      const double low = (float)set->low[c], size = (float)set->high[c] - low;
      const double from = (double)(state = state * 48271 % 2147483647) / 2147483647;
      const double to = (double)(state = state * 48271 % 2147483647) / 2147483647;
      origin[n][c] = low + size * (3 * from - 1);
      direction[n][c] = low + size * to - origin[n][c];
    }
}

static tsr_status find_hits(const tsr_set* set, struct hits* hits) {
  tsr_set_info info = {.struct_size = sizeof info};
  tsr_scene* scene = NULL;
  tsr_status status = tsr_set_describe(set, &info);
  if (!status) status = tsr_scene_new(&scene, set, NULL, NULL);
  static double origin[ray_count][3], direction[ray_count][3];
  aim(&info, origin, direction);
  const tsr_rays rays = {.struct_size = sizeof rays,
                         .is_double = 1,
                         .origin = {.data = origin, .count = ray_count},
                         .direction = {.data = direction, .count = ray_count}};
  const tsr_hits_out out = {.struct_size = sizeof out,
                            .is_double = 1,
                            .kind = {.data = hits->kind, .count = ray_count},
                            .flags = {.data = hits->flags, .count = ray_count},
                            .patch = {.data = hits->patch, .count = ray_count},
                            .t = {.data = hits->t, .count = ray_count},
                            .patch_uv = {.data = hits->uv, .count = ray_count}};
  if (!status) status = tsr_scene_closest(scene, &rays, &out, NULL);
  tsr_release(scene);
  return status;
}

/* Meshes a set and prints the result, and hits of its surfaces. */
static tsr_status print_mesh(const tsr_model* model, const tsr_set* set) {
  tsr_plan* plan = NULL;
  tsr_plan_options options;
  tsr_plan_defaults(&options);
  options.tolerance = 1e-3;
  options.flags = TSR_PLAN_RELATIVE;
  tsr_status status = tsr_plan_new(&plan, set, &options, NULL);
  tsr_plan_info info = {.struct_size = sizeof info};
  if (!status) status = tsr_plan_describe(plan, &info);
  tsr_mesh mesh = {.struct_size = sizeof mesh};
  mesh.position.count = mesh.normal.count = (size_t)info.vertices;
  mesh.triangle_count = (size_t)info.triangles;
  mesh.position.data = allocate(12 * mesh.position.count);
  mesh.normal.data = allocate(12 * mesh.normal.count);
  mesh.triangles = allocate(12 * mesh.triangle_count);
  if (!status) status = tsr_plan_write(plan, &mesh, NULL);
  tsr_bytes* file = NULL;
  if (!status) status = tsr_mesh_bytes(&file, &mesh, set, "model.glb");
  static struct hits hits;
  if (!status) status = find_hits(set, &hits);
  if (!status) {
    size_t size = 0;
    const void* const data = tsr_bytes_data(file, &size);
    char* const warnings = warnings_of(model);
    printf("mesh %zu %zu %zu %zu %d\n", strlen(warnings), mesh.position.count, mesh.triangle_count, size, ray_count);
    print(warnings, strlen(warnings));
    print(mesh.position.data, 12 * mesh.position.count), print(mesh.normal.data, 12 * mesh.normal.count);
    print(mesh.triangles, 12 * mesh.triangle_count), print(data, size);
    print(hits.t, sizeof hits.t), print(hits.uv, sizeof hits.uv), print(hits.patch, sizeof hits.patch);
    print(hits.kind, sizeof hits.kind), print(hits.flags, sizeof hits.flags);
    free(warnings);
  }
  free(mesh.position.data), free(mesh.normal.data), free(mesh.triangles);
  tsr_release(file), tsr_release(plan);
  return status;
}

static void print_result(const char* path) {
  size_t size = 0;
  char* const bytes = content_of(path, &size);
  const char* const slash = strrchr(path, '/');
  tsr_model* model = NULL;
  tsr_set* set = NULL;
  tsr_status status = tsr_model_read_bytes(&model, bytes, size, slash ? slash + 1 : path, NULL, NULL);
  if (!status) status = tsr_set_new(&set, model, NULL, NULL);
  if (!status) status = print_mesh(model, set);
  if (status) {
    const char* const message = tsr_last_message(NULL);
    printf("error %d %zu\n", (int)status, strlen(message));
    print(message, strlen(message));
  }
  tsr_release(set), tsr_release(model);
  free(bytes);
}

int main(int count, char** arguments) {
  for (int k = 1; k < count; ++k) print_result(arguments[k]);
  return 0;
}
