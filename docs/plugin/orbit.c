/* A Kepler ellipse by an emitted plugin, in C: what it is, its period, then a smaller step. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "plugin.h"

const struct hamgen_plugin* hamgen_plugin_entry(void);

static void print_list(const char* title, const struct hamgen_quantity* list) {
  printf("%s", title);
  for (; list->name; ++list) {
    if (list->is_array) {
      printf("  %s[%d..%d]", list->name, list->first, list->first + list->count - 1);
    } else {
      printf("  %s", list->name);
    }
    if (list->unit[0]) printf(" [%s]", list->unit);
  }
  printf("\n");
}

/* Up to time t; 0 if a step has no solution. */
static int advance_to(const struct hamgen_plugin* plugin, struct hamgen_run* run, double t) {
  struct hamgen_report report;
  const long long steps = llround((t - plugin->get_time(run, NULL)) / plugin->get_h(run, NULL));
  plugin->advance(run, steps, 0, &report);
  return report.status == HAMGEN_DONE;
}

int main(void) {
  const struct hamgen_plugin* plugin = hamgen_plugin_entry();
  if (!plugin || plugin->version != HAMGEN_PLUGIN_VERSION) return 1;
  printf("%s: %s\n", plugin->description, plugin->solver);
  print_list("variables ", plugin->variable_list);
  print_list("parameters", plugin->parameter_list);
  print_list("invariants", plugin->invariant_list);

  double* parameters = calloc((size_t)plugin->parameter_count + 1, sizeof *parameters);
  if (!parameters) return 1;
  plugin->default_parameters(parameters, NULL);
  const double start[4] = {0.4, 0.0, 0.0, 2.0}; /* eccentricity 0.6 */
  double end[4], values[3];
  const double period = 2 * acos(-1.0);
  struct hamgen_run* run = plugin->create(parameters, NULL, period / 1000, 0.0, start, NULL);
  if (!run) return 1;

  if (!advance_to(plugin, run, period)) return 1;
  plugin->get_state(run, end, NULL);
  printf("t = %.4f: off by %.1e\n", plugin->get_time(run, NULL), hypot(end[0] - 0.4, end[1]));

  /* From the same place again, with a tenth of the step. */
  plugin->set_state(run, 0.0, 0.0, start, NULL);
  plugin->set_h(run, period / 10000, 0.0);
  if (!advance_to(plugin, run, period)) return 1;
  plugin->get_state(run, end, NULL);
  plugin->invariants(parameters, NULL, end, NULL, values, NULL);
  printf("t = %.4f: off by %.1e, %s = %.12f\n", plugin->get_time(run, NULL),
         hypot(end[0] - 0.4, end[1]), plugin->invariant_list[0].name, values[0]);
  plugin->destroy(run);
  free(parameters);
  return 0;
}
