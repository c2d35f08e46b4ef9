#ifndef TESSERA_TESTS_C_LAYOUT_H
#define TESSERA_TESTS_C_LAYOUT_H
/* Tables of what never changes: offsets of members, sizes of structs, values of constants. */

#include <stddef.h>

#define PLACE(type, member, at) \
  { #type "." #member, offsetof(type, member), at }
#define SIZE(type, size) \
  { "sizeof " #type, sizeof(type), size }
#define VALUE(name, value) \
  { #name, name, value }

struct layout {
  const char* name; /* NULL ends a table */
  size_t found, wanted;
};
extern const struct layout layout_of_queries[];

/* Counts what is not as it was. */
int layout_faults(void);

#endif
