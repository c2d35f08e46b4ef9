#ifndef TESSERA_TESSERA_C_SHAPES_H
#define TESSERA_TESSERA_C_SHAPES_H
/* Tessera for C: faces and edges of shapes.
 *
 *   tsr_face_info face = {sizeof face};
 *   if (!tsr_model_face(model, surface, &face) && face.has_colour) paint(face.colour);
 *
 * Statuses, handles, structs, memory and threads are those of tessera_c.h. */

#include "tessera/tessera_c.h"
#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/* A surface as the face of a shape. */
typedef struct tsr_face_info {
  size_t struct_size;
  uint32_t instance, shape, face; /* 0xffffffff: the surface is no instance's face */
  float colour[4];                /* sRGB and alpha, 0 to 1: the face's, or else its instance's */
  int32_t has_colour;
} tsr_face_info;
tsr_status tsr_model_face(const tsr_model* model, size_t surface, tsr_face_info* info);

/* Writes the edges of shapes as lines from vertex to vertex of the mesh, two indices each: every edge once, with the
 * vertices of one of its faces. Plans by rates, and sets made with TSR_SET_WHOLE, have none. *count: how many lines
 * there are. `vertices`: NULL: none is written; else room for 2 * `capacity` indices. Errors, with *count set:
 * TSR_BUFFER_TOO_SMALL. TSR_INVALID_ARGUMENT (a plan without TSR_PLAN_EDGES). */
tsr_status tsr_plan_edges(const tsr_plan* plan, uint32_t* vertices, size_t capacity, size_t* count);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
