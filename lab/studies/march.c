/* The loop over the communication points of one run, in C: Python would take longer for a step than the wheel does.
   The caller compiles it and sends it to the workers; the functions are those of FMI 2.0 for co-simulation. */

#include <stddef.h>

enum { WARNING = 1 }; /* fmi2Status: a step up to here is complete */

typedef int DoStep(void* component, double time, double step, int no_set_state_prior);
typedef int GetReal(void* component, const unsigned* references, size_t count, double* values);

/* Steps along times[0], where the component stands, ... times[points - 1]; row k of `rows` gets `count` values at
   times[k]. Returns the status of the call that was not completed, or of the last one; *reached rows are filled. */
int march(DoStep* step, GetReal* get, void* component, const double* times, size_t points, const unsigned* references,
          size_t count, double* rows, size_t* reached) {
  int status = 0;
  for (*reached = 0; *reached < points; ++*reached) {
    const size_t k = *reached;
    if (k > 0 && (status = step(component, times[k - 1], times[k] - times[k - 1], 0)) > WARNING) break;
    if (count > 0 && (status = get(component, references, count, rows + k * count)) > WARNING) break;
  }
  return status;
}
