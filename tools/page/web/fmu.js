// The FMU inside the page: wheel.fmu's own sources as WebAssembly, called as any master calls them (FMI 2.0
// co-simulation). Variables are found by name in the description, which is made from modelDescription.xml.
import {bytesOf, Table} from '#table';

const [OK, WARNING, DISCARD, LAST_TIME] = [0, 1, 2, 2];

export class Fmu {
  /** wasm: base64 of the module; description: {guid, variables: {name: {reference, type, start, ...}}}. */
  static async load(wasm, description) {
    const fmu = new Fmu();
    const unused = () => 0;  // file functions of WASI that nothing here needs: 0 is success
    const wasi = new Proxy({}, {get: () => unused});
    const log = (status, category, message) => fmu.messages.push({status, text: fmu.text(message)});
    const module = await WebAssembly.compile(bytesOf(wasm));
    const imports = {page: {log}, wasi_snapshot_preview1: {}};
    for (const {module: from, name} of WebAssembly.Module.imports(module)) imports[from][name] ??= wasi[name];
    const {exports} = await WebAssembly.instantiate(module, imports);
    exports._initialize();
    return fmu.instantiate(exports, description);
  }

  instantiate(exports, description) {
    const {guid: id, variables} = description;
    Object.assign(this, {api: exports, guid: id, variables, messages: []});
    const [name, guid, place] = ['wheel', description.guid, ''].map((text) => this.keep(text));
    this.unit = this.api.fmi2Instantiate(name, 1, guid, place, this.api.page_callbacks(), 0, 0);
    if (!this.unit) throw new Error(`the wheel could not be made: ${this.messages.at(-1)?.text}`);
    this.cell = this.api.malloc(8 * 64);  // values of one call
    this.list = this.api.malloc(4 * 64);  // their value references
    return this;
  }

  /** A C string in the module's memory, for good. */
  keep(text) {
    const bytes = new TextEncoder().encode(`${text}\0`);
    const place = this.api.malloc(bytes.length);
    new Uint8Array(this.api.memory.buffer, place, bytes.length).set(bytes);
    return place;
  }

  text(place) {
    const bytes = new Uint8Array(this.api.memory.buffer, place);
    return new TextDecoder().decode(bytes.subarray(0, bytes.indexOf(0)));
  }

  /** Throws with the wheel's own sentence if it refuses. */
  demand(status) {
    if (status !== OK && status !== WARNING) throw new Error(this.messages.at(-1)?.text ?? `status ${status}`);
  }

  variable(name) {
    const variable = this.variables[name];
    if (!variable) throw new Error(`wheel.fmu has no variable ${name}`);
    return variable;
  }

  set(name, value) {
    const {reference, type} = this.variable(name);
    const memory = new DataView(this.api.memory.buffer);
    memory.setUint32(this.list, reference, true);
    if (type === 'Real')
      memory.setFloat64(this.cell, value, true);
    else
      memory.setInt32(this.cell, Number(value), true);
    const call = type === 'Real' ? 'fmi2SetReal' : type === 'Boolean' ? 'fmi2SetBoolean' : 'fmi2SetInteger';
    this.demand(this.api[call](this.unit, this.list, 1, this.cell));
  }

  /** Values of several variables of one kind (reals, or integers), into an array. */
  get(names, real) {
    const memory = new DataView(this.api.memory.buffer);
    names.forEach((name, i) => memory.setUint32(this.list + 4 * i, this.variable(name).reference, true));
    const call = real ? 'fmi2GetReal' : 'fmi2GetInteger';
    this.demand(this.api[call](this.unit, this.list, names.length, this.cell));
    const after = new DataView(this.api.memory.buffer);
    return names.map(
        (_, i) => (real ? after.getFloat64(this.cell + 8 * i, true) : after.getInt32(this.cell + 4 * i, true)));
  }

  /**
   * One run from time 0. plan: {values: {name: start value}, changes: [{t, name, value}, ...] by rising t, stop, step,
   * record: [names]}; the changes fall on communication points. Returns {table, ended: sentence or null}.
   */
  run({values, changes, stop, step, record}) {
    this.messages = [];
    this.demand(this.api.fmi2Reset(this.unit));
    for (const [name, value] of Object.entries(values)) this.set(name, value);
    this.demand(this.api.fmi2SetupExperiment(this.unit, 0, 0, 0, 0, 0));
    this.demand(this.api.fmi2EnterInitializationMode(this.unit));
    this.demand(this.api.fmi2ExitInitializationMode(this.unit));
    const reals = record.filter((name) => this.variable(name).type === 'Real');
    const whole = record.filter((name) => this.variable(name).type !== 'Real');
    const rows = [];
    const note = (t) => rows.push([t, ...this.get(reals, true), ...(whole.length ? this.get(whole, false) : [])]);
    note(0);
    const steps = Math.round(stop / step);
    let [next, ended] = [0, null];
    for (let k = 0; k < steps && !ended; ++k) {
      for (; next < changes.length && changes[next].t <= (k + 0.5) * step; ++next)
        this.set(changes[next].name, changes[next].value);
      const status = this.api.fmi2DoStep(this.unit, k * step, step, 1);
      if (status === DISCARD)
        ended = this.messages.at(-1)?.text ?? 'The run has ended.';
      else
        this.demand(status);
      note(ended ? this.lastTime() : (k + 1) * step);
    }
    const columns = {};
    ['time', ...reals, ...whole].forEach((name, i) => (columns[name] = Float64Array.from(rows, (row) => row[i])));
    return {table: new Table(columns), ended};
  }

  /** The instant at which a discarded step stopped, s. */
  lastTime() {
    this.demand(this.api.fmi2GetRealStatus(this.unit, LAST_TIME, this.cell));
    return new DataView(this.api.memory.buffer).getFloat64(this.cell, true);
  }
}
