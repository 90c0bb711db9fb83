// The live page: the wheel itself computes the whole motion anew, within some milliseconds, whenever the reader changes
// its start, or s or M_3 while it rolls. A change while it rolls leaves the past alone and makes a new future.
import {EMPTY} from '#address';
import {Fmu} from '#fmu';
import {NOW} from '#knobs';
import {Link} from '#link';
import {setUpPanel} from '#panel';
import {moving} from '#phases';
import {chapters, scenes} from '#scenes';

export const STEP = 0.01;  // s, between two rows
const RECORD =
    ['X_O', 'Y_O', 'Z_O', 'psi', 'theta', 'phi', 'X_O_dot', 'Y_O_dot', 'Z_O_dot', 'psi_dot', 'theta_dot', 'phi_dot'];
const SIGNALS = ['omega_z', 'lambda_1', 'lambda_2', 'lambda_3', 'E', 'friction_mode', 'n_events'];

/** What holds the wheel at omega_z = 0, and what may change while it rolls. */
const HOLDING = ['s', 'M_brake'];
const RUNNING = NOW.map(([name]) => name);
const PAPER_RADIUS = 0.35;  // m, r_0 + r

export class LiveWheel {
  constructor(page, fmu) {
    Object.assign(this, {page, fmu, wanted: false}, structuredClone(EMPTY.plan));
    this.record = [...RECORD, ...SIGNALS].filter((name) => name in fmu.variables);
  }

  /** What is done to the wheel: start values that are not the default's, changes while it rolls, end in s. */
  get plan() { return structuredClone({values: this.values, changes: this.changes, stop: this.stop}); }

  /** The start value that a run takes. */
  value(name) { return this.values[name] ?? this.fmu.variables[name]?.start ?? 0; }

  /** The value at the present, with the changes so far. */
  present(name) {
    const now = this.now();
    const before = this.changes.filter((change) => change.name === name && change.t <= now + STEP / 2);
    return before.length ? before.at(-1).value : this.value(name);
  }

  /** The present as a communication point. */
  now() { return Math.round(this.page.player.t / STEP) * STEP; }

  /** The sign of the present spin omega_z: negative rolls towards +e1, 0 does not roll. */
  spin() { return Math.sign(this.page.wheels[0].table.value('omega_z', this.page.player.t)); }

  /** Takes a plan; label: what its wheel is called. */
  load(plan, label = 'This wheel') {
    this.page.wheels[0].label = label;
    this.page.plots.axis = 'fitted';
    Object.assign(this, structuredClone({values: {}, changes: [], ...plan}));
    this.compute();
  }

  /** Keeps the present motion beside those to come, or lets it go. */
  keep(on, label = 'Kept') {
    const {page} = this;
    page.wheels.length = 1;
    this.kept = on ? this.plan : null;
    if (on) page.wheels.push({...page.wheels[0], name: 'kept', label, paint: 1});
    const [live, kept] = ['live', 'kept'];
    const both = [{label: 'Side by side', views: [[live], [kept]]}, {label: 'Together', views: [[live, kept]]}];
    const alone = {label: 'This wheel', views: [[live]]};
    page.choice = 0;
    page.offer(on ? [...both, alone] : [alone]);
    page.dress();
    this.compare();
  }

  setStart(name, value) {
    this.values[name] = value;
    if (name === 'J_x') this.values.J_y = value;
    this.page.plots.axis = 'fitted';
    this.wanted = true;
  }

  /** Another wheel: its spin and friction follow those of the paper's in proportion to its size. */
  setWheel(parameters) {
    const radius = parameters.r_0 + parameters.r;
    Object.assign(this.values, parameters);
    this.setStart('phi_dot_start', Number((-2 * Math.sqrt(PAPER_RADIUS / radius)).toPrecision(3)));
    if (this.value('s')) this.values.s = Number((0.03 * radius / PAPER_RADIUS).toPrecision(3));
    this.page.player.seek(0);
  }

  /** s or M_3 from now on; what had been planned for later is dropped. */
  setNow(name, value) {
    if (!RUNNING.includes(name)) throw new Error(`${name} cannot change while the wheel rolls`);
    const t = this.now();
    this.changes = this.changes.filter((change) => change.name !== name || change.t < t - STEP / 2);
    if (t <= 0)
      this.values[name] = value;
    else
      this.changes.push({t, name, value});
    this.changes.sort((a, b) => a.t - b.t);
    if (this.page.plots.axis === 'fitted') this.page.plots.axis = 'kept';
    this.wanted = true;
  }

  /** While the reader pushes or drags, the diagrams' axes stay. */
  hold(on) {
    this.page.plots.axis = on ? 'held' : 'kept';
    this.wanted = true;
  }

  /** The motion of the present plan, on the page. */
  compute() {
    [this.wanted, this.trouble] = [false, null];
    const {values, changes, stop, record} = this;
    const begin = performance.now();
    const wheel = this.page.wheels[0];
    const {table, ended} = this.fmu.run({values, changes, stop, step: STEP, record});
    this.took = performance.now() - begin;
    const shape = ['r_0', 'r', 'slope', 'slope_direction'];
    const given = Object.fromEntries(shape.map((name) => [name, this.value(name)]));
    const reshaped = given.r_0 !== wheel.r_0 || given.r !== wheel.r;
    Object.assign(wheel, given, {ended, parameters: this.parameters()});
    const friction = HOLDING.some((name) => this.values[name] > 0) ||
        changes.some(({name, value}) => HOLDING.includes(name) && value > 0);
    this.page.exchange(0, table, friction);
    if (reshaped && wheel.colour) this.page.rebuild();
    this.compare();
  }

  /** Every parameter of the run by name. */
  parameters() {
    const kinds = Object.entries(this.fmu.variables).filter(([, {causality}]) => causality === 'parameter');
    return Object.fromEntries(kinds.map(([name]) => [name, Number(this.value(name))]));
  }

  /** Whether the story's text describes what is shown. */
  compare() { this.panel?.story.compare(!this.panel.story.open || this.link?.step(this.state()) !== null); }

  /** All that was chosen; `apply` takes it. */
  state() {
    const {switches, plots, choice, player} = this.page;
    const diagram = plots.portrait.kind?.name ?? EMPTY.diagram;
    return {plan: this.plan, kept: this.kept ?? null, show: {...switches.show}, diagram, view: choice, t: player.t};
  }

  /** names: what the wheel, and the one that is kept, are called. */
  apply(state, names = []) {
    const {page} = this;
    if (state.kept) this.load(state.kept, names[1]);
    this.keep(Boolean(state.kept), names[1]);
    this.load(state.plan, names[0]);
    for (const [name, on] of Object.entries(state.show)) page.switches.flip(name, on);
    page.plots.portrait.choose(state.diagram);
    page.choose(state.view);
    page.player.seek(state.t);
  }

  /** What the page begins with: its address, else the story. */
  begin() {
    this.link = new Link(this);
    this.link.follow();
  }

  /** Once a frame: at most one run, however fast a slider moves. */
  frame() {
    if (this.wanted) {
      try {
        this.compute();
      } catch (fault) {
        this.trouble = fault.message;  // the wheel's own sentence about a start that cannot be
      }
    }
    this.panel.show();
    this.link?.frame();
  }
}

/** Loads the wheel and puts it on the page. source: {wasm, guid, wheels}; variables: of the description. */
export async function startLive(page, {wasm, guid, wheels}, variables) {
  const fmu = await Fmu.load(wasm, {guid, variables});
  const parameters =
      Object.fromEntries(['m', 'g', 'r_0', 'r', 'J_x', 'J_z'].map((name) => [name, fmu.variable(name).start]));
  const {r_0, r} = parameters;
  const live = new LiveWheel(page, fmu);
  const {table} = fmu.run({values: {}, changes: [], stop: live.stop, step: STEP, record: live.record});
  page.wheels.unshift(
      {...moving(table, r_0, false), name: 'live', label: 'This wheel', r_0, r, parameters: live.parameters()});
  page.live = live;
  live.steps = chapters(parameters);
  live.panel = setUpPanel(live, scenes(parameters, live.steps), wheels);
}
