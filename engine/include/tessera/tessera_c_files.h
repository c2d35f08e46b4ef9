#ifndef TESSERA_TESSERA_C_FILES_H
#define TESSERA_TESSERA_C_FILES_H
/* Tessera for C: files in memory, of models and of meshes, and options of reading.
 *
 *   tsr_model* model = NULL;
 *   tsr_read_options options;
 *   tsr_read_defaults(&options);
 *   options.format = "step";
 *   if (tsr_model_read_bytes(&model, bytes, size, "upload", &options, NULL)) puts(tsr_last_message(NULL));
 *   tsr_release(model);
 *
 * Statuses, handles, structs, memory and threads are those of tessera_c.h. io.h and cad.h describe the formats in
 * full. */

#include "tessera/tessera_c.h"
#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/* Who reads STEP files: the library itself, the program tessera-cad-reader by OpenCASCADE, or the library and, where it
 * fails or warns, also the program. */
enum { TSR_STEP_READER_TESSERA = 0, TSR_STEP_READER_OPENCASCADE, TSR_STEP_READER_EITHER };

typedef struct tsr_read_options {
  size_t struct_size;
  const char* format;     /* the extension that decides, such as "step" or "bpt.gz"; NULL: that of the name */
  const char* cad_reader; /* the path of the program tessera-cad-reader; NULL: it is looked for, see cad.h */
  int32_t step_reader;    /* TSR_STEP_READER_... */
  int32_t reserved;       /* 0 */
} tsr_read_options;
void tsr_read_defaults(tsr_read_options* options);

/* Reads a file as tsr_model_read() does, with options. tsr_run.cancel ends the reading of a STEP file, and the
 * program tessera-cad-reader; tsr_run.progress tells of STEP files that the library reads. Errors: as
 * tsr_model_read(), TSR_CANCELLED. */
tsr_status tsr_model_read_file(tsr_model** model, const char* path, const tsr_read_options* options,
                               const tsr_run* run);
/* Reads the bytes of a file, which may be packed. `name`: stands for the file in messages, and its extension states the
 * format if the options leave it open; NULL: "bytes". Errors: as tsr_model_read_file(). */
tsr_status tsr_model_read_bytes(tsr_model** model, const void* bytes, size_t size, const char* name,
                                const tsr_read_options* options, const tsr_run* run);

/* The bytes of a file that never was. They stay where they are until the handle is released. */
typedef struct tsr_bytes tsr_bytes;
/* Returns the first byte, NULL for a handle of no bytes. *size, unless `size` is NULL: how many there are. */
const void* tsr_bytes_data(const tsr_bytes* bytes, size_t* size);

/* Make the bytes of the file that tsr_mesh_save(), tsr_model_save_meshes() or tsr_model_save() writes. `name`: its
 * extension states the format, and it stands for the file in messages. Errors: as these functions, but for
 * TSR_IO_ERROR. */
tsr_status tsr_mesh_bytes(tsr_bytes** bytes, const tsr_mesh* mesh, const tsr_set* set, const char* name);
tsr_status tsr_model_mesh_bytes(tsr_bytes** bytes, const tsr_model* model, const tsr_mesh* const* meshes,
                                const tsr_set* const* sets, size_t count, const char* name);
tsr_status tsr_model_bytes(tsr_bytes** bytes, const tsr_model* model, const char* name);
/* Keeps a model that a STEP, IGES or BREP file was read as, with its unit, colours, parts and edges. These bytes can be
 * read in place of the file, under its name, by the same version of the library and without tessera-cad-reader. Errors:
 * TSR_UNSUPPORTED (a surface that is no B-spline; index = the surface). */
tsr_status tsr_model_cad_bytes(tsr_bytes** bytes, const tsr_model* model);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
