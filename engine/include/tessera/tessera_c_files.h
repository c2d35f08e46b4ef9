#ifndef TESSERA_TESSERA_C_FILES_H
#define TESSERA_TESSERA_C_FILES_H
/* Tessera for C: models of files in memory, and options of reading.
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

/* Reads a file as tsr_model_read() does, with options. tsr_run.cancel ends the program tessera-cad-reader. Errors: as
 * tsr_model_read(), TSR_CANCELLED. */
tsr_status tsr_model_read_file(tsr_model** model, const char* path, const tsr_read_options* options,
                               const tsr_run* run);
/* Reads the bytes of a file, which may be packed. `name`: stands for the file in messages, and its extension states the
 * format if the options leave it open; NULL: "bytes". Errors: as tsr_model_read_file(). */
tsr_status tsr_model_read_bytes(tsr_model** model, const void* bytes, size_t size, const char* name,
                                const tsr_read_options* options, const tsr_run* run);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
