// The FMU inside the page: wheel.fmu's own sources as WebAssembly, called as any master calls them (FMI 2.0
// co-simulation). Variables are found by name in the description, which is made from modelDescription.xml.
import {variables} from '#dom';
import {bytesOf, Table} from '#table';

export const STEP = 0.01;  // s, between two instants at which the reader can change something
const [WARNING, DISCARD, LAST_TIME] = [1, 2, 2];
const ROOM = 64;  // values of one call, at most

export class Fmu {
  /** wasm: base64 of the module. */
  static async load({wasm, guid}) {
    const fmu = Object.assign(new Fmu(), {guid, messages: []});
    const log = (status, category, message) => fmu.messages.push(fmu.text(message));
    const module = await WebAssembly.compile(bytesOf(wasm));
    const imports = {page: {log}, wasi_snapshot_preview1: {}};
    // File functions of WASI that nothing here needs: 0 is success.
    for (const {module: from, name} of WebAssembly.Module.imports(module)) imports[from][name] ??= () => 0;
    const {exports} = await WebAssembly.instantiate(module, imports);
    exports._initialize();
    fmu.api = exports;
    const texts = ['wheel', guid, ''].map((text) => fmu.keep(text));
    fmu.unit = exports.fmi2Instantiate(texts[0], 1, texts[1], texts[2], exports.page_callbacks(), 0, 0);
    if (!fmu.unit) throw new Error(`the wheel could not be made: ${fmu.messages.at(-1)}`);
    [fmu.cells, fmu.list] = [exports.malloc(8 * ROOM), exports.malloc(4 * ROOM)];
    return fmu;
  }

  /** A C string in the module's memory, for good. */
  keep(text) {
    const bytes = new TextEncoder().encode(`${text}\0`);
    const place = this.api.malloc(bytes.length);
    this.view(Uint8Array, place).set(bytes);
    return place;
  }

  /** The memory from a place on, which moves when it grows. */
  view(Kind, place, length) { return new Kind(this.api.memory.buffer, place, length); }

  text(place) {
    const bytes = this.view(Uint8Array, place);
    return new TextDecoder().decode(bytes.subarray(0, bytes.indexOf(0)));
  }

  /** Calls a function of the FMU; throws with the wheel's own sentence if it refuses. */
  call(name, ...all) {
    const status = this.api[`fmi2${name}`](this.unit, ...all);
    if (status > WARNING) throw new Error(this.messages.at(-1) ?? `status ${status}`);
  }

  /** Get or Set of variables of one type; returns their values in the module's memory. */
  exchange(way, names, values = []) {
    const {type} = variables[names[0]];
    this.view(Uint32Array, this.list, names.length).set(names.map((name) => variables[name].reference));
    const cells = () => this.view(type === 'Real' ? Float64Array : Int32Array, this.cells, names.length);
    cells().set(values);
    this.call(way + type, this.list, names.length, this.cells);
    return cells();
  }

  set(name, value) { this.exchange('Set', [name], [value]); }

  /** A new start at these values {name: value}. */
  begin(values) {
    this.messages = [];
    this.call('Reset');
    for (const [name, value] of Object.entries(values)) this.set(name, value);
    this.call('SetupExperiment', 0, 0, 0, 0, 0);
    this.call('EnterInitializationMode');
    this.call('ExitInitializationMode');
  }

  /** The accelerations {theta_ddot, psi_ddot} at a start. */
  accelerations(values) {
    this.begin(values);
    const [theta_ddot, psi_ddot] = this.exchange('Get', ['theta_ddot', 'psi_ddot']);
    return {theta_ddot, psi_ddot};
  }

  /**
   * One run from time 0. plan: {values: {name: start value}, changes: [{t, name, value}, ...] by rising t, stop,
   * record: [names], interval: s from row to row, a part of STEP}. Returns {table, ended: sentence or null}.
   */
  run({values, changes, stop, record, interval = STEP}) {
    this.begin(values);
    const groups = Object.values(Object.groupBy(record, (name) => variables[name].type));
    const rows = [];
    const note = (t) => rows.push([t, ...groups.flatMap((names) => [...this.exchange('Get', names)])]);
    note(0);
    const steps = Math.round(stop / interval);
    let [next, ended] = [0, null];
    for (let k = 0; k < steps && !ended; ++k) {
      for (; next < changes.length && changes[next].t <= (k + 0.5) * interval; ++next)
        this.set(changes[next].name, changes[next].value);
      const status = this.api.fmi2DoStep(this.unit, k * interval, interval, 1);
      if (status > DISCARD) throw new Error(this.messages.at(-1) ?? `status ${status}`);
      if (status === DISCARD) ended = this.messages.at(-1) ?? 'The run has ended.';
      if (ended) this.call('GetRealStatus', LAST_TIME, this.cells);
      note(ended ? this.view(Float64Array, this.cells, 1)[0] : (k + 1) * interval);
    }
    const columns = ['time', ...groups.flat()].map((name, i) => [name, Float64Array.from(rows, (row) => row[i])]);
    return {table: new Table(Object.fromEntries(columns)), ended};
  }
}
