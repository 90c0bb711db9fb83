// The live page: the wheel itself computes the whole motion anew, within some milliseconds, whenever the reader changes
// its start, or s or M_3 while it rolls. A change while it rolls leaves the past alone and makes a new future.
import {EMPTY} from '#address';
import {Fmu, STEP} from '#fmu';
import {Link} from '#link';
import {setUpPanel} from '#panel';
import {chapters, scenes} from '#scenes';

const POSE = ['X_O', 'Y_O', 'Z_O', 'psi', 'theta', 'phi'];
const SIGNALS = ['omega_z', 'lambda_1', 'lambda_2', 'lambda_3', 'E', 'friction_mode', 'n_events'];
const RECORD = [...POSE, ...POSE.map((name) => `${name}_dot`), ...SIGNALS];
const SHAPE = ['r_0', 'r', 'slope', 'slope_direction'];
const HOLDING = ['s', 'M_brake'];  // may hold the wheel at omega_z = 0
const PAPER_RADIUS = 0.35;         // m, r_0 + r

export class LiveWheel {
  constructor(page, fmu) {
    Object.assign(this, {page, fmu, took: 0}, structuredClone(EMPTY.plan));
    this.wheel = {name: 'live', label: 'This wheel'};
    page.bodies.push(this.wheel);
  }

  /** What is done to the wheel: start values that are not the default's, changes while it rolls, end in s. */
  get plan() { return structuredClone({values: this.values, changes: this.changes, stop: this.stop}); }

  /** The start value that a run takes. */
  value(name) { return this.values[name] ?? this.fmu.variables[name]?.start ?? 0; }

  /** Every parameter of the run by name. */
  parameters() {
    const names = Object.keys(this.fmu.variables).filter((name) => this.fmu.variables[name].causality === 'parameter');
    return Object.fromEntries(names.map((name) => [name, Number(this.value(name))]));
  }

  /** The value at the present, with the changes so far. */
  present(name) {
    const now = this.now() + STEP / 2;
    return this.changes.findLast((change) => change.name === name && change.t <= now)?.value ?? this.value(name);
  }

  /** The present as a communication point. */
  now() { return Math.round(this.page.player.t / STEP) * STEP; }

  /** The sign of the present spin omega_z: negative rolls towards +e1, 0 does not roll. */
  spin() { return Math.sign(this.wheel.table.value('omega_z', this.page.player.t)); }

  /** Takes a plan; label: what its wheel is called. */
  load(plan, label = 'This wheel') {
    this.wheel.label = label;
    this.page.offer(this.page.bodies.length);
    this.page.plots.axis = 'fitted';
    Object.assign(this, structuredClone({values: {}, changes: [], ...plan}));
    this.compute();
  }

  /** Keeps the present motion beside those to come, or lets it go. */
  keep(on, label = 'Kept') {
    const {page, wheel} = this;
    this.kept = on ? this.plan : null;
    page.bodies = [wheel, ...(on ? [{...wheel, name: 'kept', label}] : [])];
    page.choice = 0;
    page.offer(page.bodies.length);
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
    const size = (parameters.r_0 + parameters.r) / PAPER_RADIUS;
    Object.assign(this.values, parameters);
    this.setStart('phi_dot_start', Number((-2 / Math.sqrt(size)).toPrecision(3)));
    if (this.value('s')) this.values.s = Number((0.03 * size).toPrecision(3));
    this.page.player.seek(0);
  }

  /** s or M_3 from now on; what had been planned for later is dropped. */
  setNow(name, value) {
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
    const {page, wheel, values, changes, stop} = this;
    const begin = performance.now();
    const {table, ended} = this.fmu.run({values, changes, stop, record: RECORD});
    this.took = performance.now() - begin;
    const given = Object.fromEntries(SHAPE.map((name) => [name, this.value(name)]));
    const reshaped = given.r_0 !== wheel.r_0 || given.r !== wheel.r;
    const set = [...Object.entries(values), ...changes.map(({name, value}) => [name, value])];
    const friction = set.some(([name, value]) => HOLDING.includes(name) && value > 0);
    Object.assign(wheel, given, {ended, parameters: this.parameters()});
    page.exchange(wheel, table, friction, reshaped);
    this.compare();
  }

  /** Whether the story's text describes what is shown. */
  compare() { this.panel?.story.compare(!this.panel.story.open || this.link?.step(this.state()) !== null); }

  /** All that was chosen; `apply` takes it. */
  state() {
    const {switches: {show}, plots: {portrait}, choice, player} = this.page;
    return {
      plan: this.plan,
      kept: this.kept ?? null,
      show: {...show},
      diagram: portrait.name,
      view: choice,
      t: player.t
    };
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
    try {
      if (this.wanted) this.compute();
    } catch (fault) {
      this.trouble = fault.message;  // the wheel's own sentence about a start that cannot be
    }
    this.panel.show();
    this.link?.frame();
  }
}

/** Loads the wheel and puts it on the page. source: {wasm, guid, wheels}; variables: of the description. */
export async function startLive(page, {wasm, guid, wheels}, variables) {
  const fmu = await Fmu.load(wasm, {guid, variables});
  const live = page.live = new LiveWheel(page, fmu);
  live.compute();
  live.steps = chapters(live.parameters());
  live.panel = setUpPanel(live, scenes(live.parameters(), live.steps), wheels);
}
