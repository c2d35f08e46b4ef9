/* Results of the C interface for files, as tests/wasm/results.mjs makes them by tessera.wasm:
 *   results FILE...
 * prints for each file "error CODE BYTES" and the sentence; or "mesh WARNINGS VERTICES TRIANGLES BYTES", the warnings,
 * positions, normals, corners of triangles, and a .glb of so many bytes. Every number before a line's end is followed
 * by that many bytes or records. Models are read as bytes, and divided with a tolerance of a thousandth of their size.
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

/* Meshes a set and prints the result. */
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
  if (!status) {
    size_t size = 0;
    const void* const data = tsr_bytes_data(file, &size);
    char* const warnings = warnings_of(model);
    printf("mesh %zu %zu %zu %zu\n", strlen(warnings), mesh.position.count, mesh.triangle_count, size);
    print(warnings, strlen(warnings));
    print(mesh.position.data, 12 * mesh.position.count), print(mesh.normal.data, 12 * mesh.normal.count);
    print(mesh.triangles, 12 * mesh.triangle_count), print(data, size);
    free(warnings);
  }
  free(mesh.position.data), free(mesh.normal.data), free(mesh.triangles);
  if (!status) tsr_release(file);
  tsr_release(plan);
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
