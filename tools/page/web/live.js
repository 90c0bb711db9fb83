// The live page: the wheel itself computes the whole motion anew, within some milliseconds, whenever the reader changes
// its start, or s or M_3 while it rolls. A change while it rolls leaves the past alone and makes a new future.
import {EMPTY} from '#address';
import {chapters} from '#chapters';
import {Fmu} from '#fmu';
import {NOW} from '#knobs';
import {Link} from '#link';
import {setUpPanel} from '#panel';
import {presets} from '#presets';

export const STEP = 0.01;  // s, between two rows
const RECORD =
    ['X_O', 'Y_O', 'Z_O', 'psi', 'theta', 'phi', 'X_O_dot', 'Y_O_dot', 'Z_O_dot', 'psi_dot', 'theta_dot', 'phi_dot'];
const SIGNALS = ['omega_z', 'lambda_1', 'lambda_2', 'lambda_3', 'E', 'friction_mode', 'n_events'];

/** What holds the wheel at omega_z = 0, and what may change while it rolls. */
const HOLDING = ['s', 'M_brake'];
const RUNNING = NOW.map(([name]) => name);

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
  }

  setStart(name, value) {
    this.values[name] = value;
    this.page.plots.axis = 'fitted';
    this.wanted = true;
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
    wheel.ended = ended;
    for (const name of ['slope', 'slope_direction']) wheel[name] = this.value(name);
    const [r_0, r] = [this.value('r_0'), this.value('r')];
    const reshaped = r_0 !== wheel.r_0 || r !== wheel.r;
    Object.assign(wheel, {r_0, r});
    const friction = HOLDING.some((name) => this.values[name] > 0) ||
        changes.some(({name, value}) => HOLDING.includes(name) && value > 0);
    this.page.exchange(0, table, friction);
    if (reshaped && wheel.colour) this.page.rebuild();
  }

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

/** Loads the wheel and puts it on the page. source: {wasm, description}. */
export async function startLive(page, source) {
  const fmu = await Fmu.load(source.wasm, source.description);
  const start = (name) => fmu.variable(name).start;
  const wheel = {name: 'live', label: 'This wheel', r_0: start('r_0'), r: start('r')};
  const live = new LiveWheel(page, fmu);
  const first = fmu.run({values: {}, changes: [], stop: live.stop, step: STEP, record: live.record});
  page.wheels.unshift({...wheel, table: first.table, phases: {sticks: [], transitions: []}});
  page.live = live;
  const parameters = Object.fromEntries(['m', 'g', 'r_0', 'r', 'J_x', 'J_z'].map((name) => [name, start(name)]));
  live.steps = chapters(parameters);
  live.panel = setUpPanel(live, presets(parameters));
}
