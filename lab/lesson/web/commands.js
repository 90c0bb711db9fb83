// The commands that make the same run outside of the page: fmpy's command line, Python with FMPy, and C.
import {variables} from '#dom';

const instant = (t) => Number(t.toFixed(4));  // s, a communication point in plain digits

/** fmpy: changes as an input file, each jump as two rows at one instant. */
function byFmpy({values, changes, stop}, given, interval) {
  const names = [...new Set(changes.map(({name}) => name))];
  const now = Object.fromEntries(names.map((name) => [name, values[name] ?? variables[name].start ?? 0]));
  const row = (t) => [instant(t), ...names.map((name) => now[name])].join(',');
  const rows = [['time', ...names].join(','), row(0)];
  for (const {t, name, value} of changes) {
    rows.push(row(t));
    now[name] = value;
    rows.push(row(t));
  }
  const input = `printf '${[...rows, row(stop)].join('\\n')}\\n' >inputs.csv`;
  const options = [
    'fmpy simulate wheel.fmu', `--stop-time ${stop}`, `--output-interval ${interval}`,
    ...(given.length ? [`--start-values ${given.flat().join(' ')}`] : []),
    ...(changes.length ? ['--input-file inputs.csv'] : []), '--output-file motion.csv'
  ];
  return [...(changes.length ? [input] : []), options.join(' \\\n  ')].join('\n');
}

function byPython({changes, stop}, given, interval) {
  const values = given.map(([name, value]) => `"${name}": ${value === true ? 'True' : value}`);
  const list = changes.map(({t, name, value}) => `(${instant(t)}, "${name}", ${value})`);
  const end = `stop_time=${stop}, output_interval=${interval}, start_values={${values.join(', ')}}`;
  if (!changes.length)
    return `from fmpy import simulate_fmu\n\nmotion = simulate_fmu("wheel.fmu", ${end})\nprint(motion["theta"][-1])`;
  return `from fmpy import read_model_description, simulate_fmu

changes = [${list.join(', ')}]  # s, variable, value
reference = {v.name: v.valueReference for v in read_model_description("wheel.fmu").modelVariables}


def change(time, recorder):
    while changes and changes[0][0] <= time + ${interval / 2}:
        _, name, value = changes.pop(0)
        recorder.fmu.setReal([reference[name]], [value])
    return True


motion = simulate_fmu("wheel.fmu", ${end}, step_finished=change)
print(motion["theta"][-1])`;
}

function byC({changes, stop}, given, interval, guid) {
  const set = (name, value) =>
      `${value === true ? 'set_boolean' : 'set'}(${variables[name].reference}, ${Number(value)});`;
  const start = given.map((pair) => `  ${set(...pair)}\n`);
  const later = changes.map(({t, name, value}) => `    if (k == ${Math.round(t / interval)}) ${set(name, value)}\n`);
  const shown = ['theta', 'omega_z', 'X_O', 'Y_O'];
  return `// unzip wheel.fmu 'binaries/*' && cc run.c ./binaries/linux64/wheel.so -o run && ./run
#include <stdio.h>
#include <stdlib.h>

typedef void (*logger)(void*, const char*, int, const char*, const char*, ...);
typedef struct {
  logger log;
  void* (*allocate)(size_t, size_t);
  void (*release)(void*);
  void *done, *environment;
} callbacks;
void* fmi2Instantiate(const char*, int, const char*, const char*, const callbacks*, int, int);
int fmi2SetupExperiment(void*, int, double, double, int, double), fmi2EnterInitializationMode(void*);
int fmi2ExitInitializationMode(void*), fmi2DoStep(void*, double, double, int), fmi2Terminate(void*);
int fmi2SetBoolean(void*, const unsigned*, size_t, const int*), fmi2SetReal(void*, const unsigned*, size_t, const double*);
int fmi2GetReal(void*, const unsigned*, size_t, double*);
void fmi2FreeInstance(void*);

static void report(void* e, const char* name, int status, const char* category, const char* text, ...) {
  fprintf(stderr, "%s\\n", text);
}

static void* wheel;
static inline void set(unsigned reference, double value) { fmi2SetReal(wheel, &reference, 1, &value); }
static inline void set_boolean(unsigned reference, int value) { fmi2SetBoolean(wheel, &reference, 1, &value); }

int main(void) {
  static const callbacks functions = {report, calloc, free, NULL, NULL};
  static const unsigned shown[] = {${shown.map((name) => variables[name].reference).join(', ')}}; /* ${
      shown.join(', ')} */
  double value[${shown.length}];
  int status = 0;
  if (!(wheel = fmi2Instantiate("wheel", 1, "${guid}", "", &functions, 0, 0))) return 1;
${start.join('')}  fmi2SetupExperiment(wheel, 0, 0, 0, 0, 0);
  if (fmi2EnterInitializationMode(wheel) > 1 || fmi2ExitInitializationMode(wheel) > 1) return 1;
  for (int k = 0; k < ${Math.round(stop / interval)} && status < 2; ++k) {
${later.join('')}    status = fmi2DoStep(wheel, k * ${interval}, ${interval}, 1);
    fmi2GetReal(wheel, shown, ${shown.length}, value);
    printf("%.2f %.17g %.17g %.17g %.17g\\n", (k + 1) * ${interval}, value[0], value[1], value[2], value[3]);
  }
  fmi2Terminate(wheel);
  fmi2FreeInstance(wheel);
}`;
}

/** {label: text} for a plan {values, changes, stop}; interval: s from row to row. */
export function commands(plan, interval, guid) {
  const typed = ([name, value]) => [name, variables[name].type === 'Boolean' ? Boolean(value) : value];
  const given = Object.entries(plan.values).filter(([name, value]) => value !== variables[name].start).map(typed);
  return {
    fmpy: byFmpy(plan, given, interval),
    Python: byPython(plan, given, interval),
    C: byC(plan, given, interval, guid)
  };
}
