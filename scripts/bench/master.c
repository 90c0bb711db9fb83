/* A small co-simulation master: loads the library out of wheel.fmu, runs a scene again and again, and prints as JSON
 * what it cost and what came out. Times are wall-clock seconds. No paper equation, no frame.
 *
 *   master solve --library wheel.so --guid {...} [--set r7=0.03]... [--read 27,28,29,30] [--count 46,47]
 *                [--tolerance 1e-8] [--step 0.1] [--stop 10] [--seconds 0.2 | --repetitions 20] [--rows]
 *                [--jump 21=1e-9]  sets Real 21 to 1 and 2 times the value in turn, before each step
 *   master many  the same, and --instances 10000: see many.c */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmu.h"
#include "many.h"

enum { MOST_REPETITIONS = 100000 };

typedef struct Outcome {
  fmi2Status status;
  double time; /* reached */
  long steps;
} Outcome;

/* Steps to the stop time and reads the outputs after each step; rows (may be null) keeps them. Its own function, so
 * that callgrind can count it alone. */
__attribute__((noinline)) Outcome solve_scene(const Fmu* fmu, const Run* run, fmi2Component instance, double* rows);
Outcome solve_scene(const Fmu* fmu, const Run* run, fmi2Component instance, double* rows) {
  Outcome outcome = {fmi2OK, 0, 0};
  double unread[MOST_READ];
  const long steps = (long)(run->stop / run->step + 0.5);
  if (run->output_count)
    outcome.status = fmu->get_real(instance, run->outputs, run->output_count, rows ? rows : unread);
  while (outcome.steps < steps && outcome.status <= fmi2Warning) {
    const double t = (double)outcome.steps * run->step;
    if (run->jump_variable >= 0) {
      const fmi2ValueReference variable = (fmi2ValueReference)run->jump_variable;
      const double value = run->jump_value * (double)(1 + outcome.steps % 2);
      fmu->set_real(instance, &variable, 1, &value);
    }
    outcome.status = fmu->do_step(instance, t, run->step, fmi2True);
    if (outcome.status > fmi2Warning) break;
    ++outcome.steps;
    outcome.time = t + run->step;
    double* row = rows ? rows + (size_t)outcome.steps * run->output_count : unread;
    if (run->output_count) fmu->get_real(instance, run->outputs, run->output_count, row);
  }
  return outcome;
}

typedef struct Samples {
  double solve[MOST_REPETITIONS], start[MOST_REPETITIONS], end[MOST_REPETITIONS];
  double processor[MOST_REPETITIONS]; /* time of the processor in solve: no other program counts */
  long count;
} Samples;

static int by_size(const void* a, const void* b) {
  const double x = *(const double*)a, y = *(const double*)b;
  return (x > y) - (x < y);
}

static void print_times(const char* name, double* times, long count) {
  qsort(times, (size_t)count, sizeof *times, by_size);
  printf("\"%s_best\": %.9g, \"%s_median\": %.9g, ", name, times[0], name, times[count / 2]);
}

static void print_rows(const Run* run, const Outcome* outcome, const double* rows) {
  printf("\"rows\": [");
  for (long i = 0; i <= outcome->steps; ++i) {
    printf("%s[%.17g", i ? ", " : "", (double)i * run->step);
    for (size_t k = 0; k < run->output_count; ++k) printf(", %.17g", rows[(size_t)i * run->output_count + k]);
    printf("]");
  }
  printf("], ");
}

static void print_counters(const Fmu* fmu, const Run* run, fmi2Component instance) {
  fmi2Integer counters[MOST_READ] = {0};
  fmu->get_integer(instance, run->counters, run->counter_count, counters);
  printf("\"counters\": [");
  for (size_t k = 0; k < run->counter_count; ++k) printf("%s%d", k ? ", " : "", counters[k]);
  printf("], ");
}

/* One run apart from the clock: outputs, counters, how it ended. False if it could not start. */
static int print_result(const Fmu* fmu, const Run* run) {
  fmi2Component instance = start_instance(fmu, run);
  if (!instance) return 0;
  const size_t rows_size = ((size_t)(run->stop / run->step + 0.5) + 1) * (run->output_count + 1);
  double* rows = calloc(rows_size, sizeof *rows);
  const Outcome outcome = solve_scene(fmu, run, instance, rows);
  printf("\"status\": %d, \"reached\": %.17g, \"steps\": %ld, ", outcome.status, outcome.time, outcome.steps);
  print_counters(fmu, run, instance);
  if (run->print_rows) print_rows(run, &outcome, rows);
  free(rows);
  fmu->free_instance(instance);
  return 1;
}

static void measure(const Fmu* fmu, const Run* run, Samples* samples) {
  const double begin = now();
  const double seconds = run->repetitions > 0 ? 0 : run->seconds;
  long least = run->repetitions > 0 ? run->repetitions : 3;
  while (samples->count < MOST_REPETITIONS && (samples->count < least || now() - begin < seconds)) {
    const double t_0 = now();
    fmi2Component instance = start_instance(fmu, run);
    const double p_1 = processor_time(), t_1 = now();
    solve_scene(fmu, run, instance, NULL);
    const double t_2 = now();
    samples->processor[samples->count] = processor_time() - p_1;
    fmu->free_instance(instance);
    samples->start[samples->count] = t_1 - t_0;
    samples->solve[samples->count] = t_2 - t_1;
    samples->end[samples->count++] = now() - t_2;
    if (run->repetitions <= 0 && t_2 - t_1 > 0.1) least = 1; /* s: too slow to ask again */
  }
}

static size_t read_list(const char* text, fmi2ValueReference* list) {
  size_t count = 0;
  for (char* end = (char*)text; *text && count < MOST_READ; text = *end ? end + 1 : end)
    list[count++] = (fmi2ValueReference)strtoul(text, &end, 10);
  return count;
}

static void read_start(Run* run, const char* text) {
  Start* start = &run->starts[run->start_count];
  if (run->start_count < MOST_STARTS && sscanf(text, "%c%u=%lf", &start->kind, &start->variable, &start->value) == 3)
    ++run->start_count;
}

static void read_option(Run* run, const char* name, const char* text) {
  if (!strcmp(name, "--library")) run->library = text;
  if (!strcmp(name, "--guid")) run->guid = text;
  if (!strcmp(name, "--set")) read_start(run, text);
  if (!strcmp(name, "--read")) run->output_count = read_list(text, run->outputs);
  if (!strcmp(name, "--count")) run->counter_count = read_list(text, run->counters);
  if (!strcmp(name, "--tolerance")) run->tolerance = atof(text);
  if (!strcmp(name, "--step")) run->step = atof(text);
  if (!strcmp(name, "--stop")) run->stop = atof(text);
  if (!strcmp(name, "--seconds")) run->seconds = atof(text);
  if (!strcmp(name, "--repetitions")) run->repetitions = atol(text);
  if (!strcmp(name, "--instances")) run->instances = atol(text);
  if (!strcmp(name, "--jump")) sscanf(text, "%ld=%lf", &run->jump_variable, &run->jump_value);
}

int main(int argc, char** argv) {
  Run run = {.step = 0.1, .stop = 10, .seconds = 0.2, .jump_variable = -1, .instances = 1000};
  for (int i = 2; i < argc; ++i) {
    if (!strcmp(argv[i], "--rows"))
      run.print_rows = 1;
    else if (i + 1 < argc)
      read_option(&run, argv[i], argv[i + 1]), ++i;
  }
  if (argc < 2 || !run.library || !run.guid)
    return fputs("usage: master solve|many --library L --guid G ...\n", stderr), 2;
  const double begin = now();
  const Fmu fmu = load_fmu(run.library);
  printf("{\"load\": %.9g, ", now() - begin);
  if (!strcmp(argv[1], "many")) return print_many(&fmu, &run), puts("}"), 0;
  static Samples samples;
  if (!print_result(&fmu, &run)) return puts("\"status\": 3}"), 1;
  measure(&fmu, &run, &samples);
  const long count = samples.count;
  print_times("solve", samples.solve, count);
  print_times("processor", samples.processor, count);
  print_times("start", samples.start, count);
  print_times("end", samples.end, count);
  printf("\"repetitions\": %ld}\n", count);
  return 0;
}
