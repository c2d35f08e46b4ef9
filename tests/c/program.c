/* A program in C: a surface from control points, its mesh and a ray. */

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "layout.h"
#include "tessera/tessera_c_queries.h"

static int failed(tsr_status status, const char* what) {
  if (status == TSR_OK) return 0;
  fprintf(stderr, "%s: %s: %s\n", what, tsr_status_name(status), tsr_last_message(NULL));
  return 1;
}

static int meshed(const tsr_set* set) {
  tsr_plan* plan = NULL;
  tsr_plan_options options;
  tsr_plan_info info = {.struct_size = sizeof info};
  tsr_mesh mesh = {.struct_size = sizeof mesh};
  tsr_mesh_report report = {.struct_size = sizeof report};
  int faults;
  tsr_plan_defaults(&options);
  options.tolerance = 1e-3;
  faults = failed(tsr_plan_new(&plan, set, &options, NULL), "tsr_plan_new") ||
           failed(tsr_plan_describe(plan, &info), "tsr_plan_describe");
  if (faults) return 0;
  mesh.position.data = malloc(3 * sizeof(float) * (size_t)info.vertices);
  mesh.position.count = (size_t)info.vertices;
  mesh.triangles = malloc(3 * sizeof(uint32_t) * (size_t)info.triangles);
  mesh.triangle_count = (size_t)info.triangles;
  faults = failed(tsr_plan_write(plan, &mesh, NULL), "tsr_plan_write") ||
           failed(tsr_mesh_check(&mesh, &report), "tsr_mesh_check");
  printf("%lu triangles, within %g\n", (unsigned long)report.triangles, info.bound);
  free(mesh.position.data);
  free(mesh.triangles);
  return !failed(tsr_release(plan), "tsr_release") && !faults && report.triangles == info.triangles &&
         info.bound <= 1e-3;
}

static int met(const tsr_set* set) {
  const double origin[3] = {0.5, 0.5, 5}, direction[3] = {0, 0, -1};
  double t = 0;
  tsr_rays rays = {.struct_size = sizeof rays};
  tsr_hits_out hits = {.struct_size = sizeof hits};
  tsr_scene* scene = NULL;
  int faults;
  rays.is_double = hits.is_double = 1;
  rays.origin.data = origin;
  rays.direction.data = direction;
  rays.origin.count = rays.direction.count = 1;
  hits.t.data = &t;
  hits.t.count = 1;
  faults = failed(tsr_scene_new(&scene, set, NULL, NULL), "tsr_scene_new") ||
           failed(tsr_scene_closest(scene, &rays, &hits, NULL), "tsr_scene_closest") ||
           failed(tsr_release(scene), "tsr_release");
  printf("the ray meets the surface at t = %.17g\n", t);
  return !faults && fabs(t - 4.75) < 1e-12;
}

int main(void) {
  /* z = u v: 1/4 in the middle. */
  const double points[12] = {0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 1};
  tsr_bspline saddle = {.struct_size = sizeof saddle};
  tsr_model* model = NULL;
  tsr_set* set = NULL;
  int good;
  saddle.degree_u = saddle.degree_v = 1;
  saddle.count_u = saddle.count_v = 2;
  saddle.points = points;
  saddle.name = "saddle";
  if (layout_faults() != 0 || failed(tsr_model_new(&model, &saddle, 1), "tsr_model_new") ||
      failed(tsr_set_new(&set, model, NULL, NULL), "tsr_set_new") || failed(tsr_release(model), "tsr_release"))
    return 1;
  good = meshed(set) && met(set);
  return failed(tsr_release(set), "tsr_release") || !good;
}
