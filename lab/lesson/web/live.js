// The live page: the wheel itself computes the whole motion anew, within some milliseconds, whenever the reader changes
// its start, or s or M_3 while it rolls. A change while it rolls leaves the past alone and makes a new future.
import {derive, EMPTY, Link, sameMotions} from '#address';
import {variables} from '#dom';
import {STEP} from '#fmu';
import {STEERING} from '#knobs';
import {MOMENTS, nutation, POINTS} from '#mechanics';
import {setUpPanel} from '#panel';
import {chapters} from '#scenes';
import {extent, POSE} from '#table';

const SIGNALS = [
  'omega_z', 'theta_ddot', 'lambda_1', 'lambda_2', 'lambda_3', 'E', 'friction_mode', 'n_events', 'slip_x', 'slip_y',
  'M_guide_1', 'M_guide_2'
];
const RECORD = [...POSE, ...POSE.map((name) => `${name}_dot`), ...SIGNALS];
const HOLDING = ['s', 'M_brake'];  // may hold the wheel at omega_z = 0
const FINEST = 12;                 // parts of STEP, at most
const NAMES = ['This wheel', 'Kept'];

/** The part of STEP, s, that gives nutation and turn POINTS rows a period; a guided wheel has neither. */
function intervalOf({columns: {theta, psi_dot, omega_z}}, wheel) {
  if (wheel.guided) return STEP;
  const turn = psi_dot.map((rate, i) => rate * Math.sin(theta[i]));
  const [across, spin] = [turn, omega_z].map((rates) => Math.max(...extent(rates).map(Math.abs)));
  const parts = Math.ceil(STEP * POINTS * Math.max(across, nutation(wheel) * spin) / (2 * Math.PI));
  return STEP / Math.min(FINEST, Math.max(1, parts));
}

/**
 * What the reader has chosen: plan, what is done to the wheel; kept: the plan of the motion beside, or null; step 0, 1
 * ... of the story, if it is open; guess: what the reader expects of a step that asks, or null: {asks: not played yet,
 * picked: number of the fate, told: whether the motion has shown it}; scene: the number of the one that was loaded.
 * refusal, trouble: why an address or a start cannot be; wanted: whether the motion is still to be computed.
 */
export class LiveWheel {
  /** wheels: the presets. */
  constructor(page, fmu, wheels) {
    Object.assign(this, {page, fmu}, {plan: EMPTY.plan, kept: null, step: 0, open: true, guess: null});
    this.steps = chapters(this.parameters());
    this.wheel = {name: 'live', label: NAMES[0]};
    page.bodies.push(this.wheel);
    this.compute();
    this.show = setUpPanel(this, wheels);
  }

  /** The start value that a run takes. */
  value(name) { return this.plan.values[name] ?? variables[name]?.start ?? 0; }

  /** Every parameter of the run by name. */
  parameters() {
    const names = Object.keys(variables).filter((name) => variables[name].causality === 'parameter');
    return Object.fromEntries(names.map((name) => [name, Number(this.value(name))]));
  }

  /** The value at the present, with the changes so far. */
  present(name) {
    const now = this.now() + STEP / 2;
    return this.plan.changes.findLast((change) => change.name === name && change.t <= now)?.value ?? this.value(name);
  }

  /** The present as a communication point. */
  now() { return Math.round(this.page.player.t / STEP) * STEP; }

  /** The present of the motion, which may have ended. */
  instant() { return Math.min(this.page.player.t, this.wheel.table.end); }

  /** Whether the wheel slides at the present. */
  get slides() {
    return this.wheel.phases.slides.some(([begin, end]) => begin <= this.instant() && this.instant() < end);
  }

  /** Whether the step of the story that is open shows the moments about e1, for a wheel of which they are all. */
  get drawsBalance() {
    const {J_x, J_y, guided} = this.wheel.parameters;
    return this.open && Boolean(this.steps[this.step].balance) && J_x === J_y && !guided;
  }

  /** The sign of the present spin omega_z: negative rolls towards +e1, 0 does not roll. */
  spin() { return Math.sign(this.wheel.table.value('omega_z', this.page.player.t)); }

  /** Takes a plan, of no scene unless the caller names one; label: what its wheel is called. */
  load(plan, label = NAMES[0]) {
    this.tell();
    [this.scene, this.refusal] = [null, null];
    this.wheel.label = label;
    this.page.offer(this.page.bodies.length);
    this.page.plots.axis = 'fitted';
    this.plan = structuredClone({...EMPTY.plan, ...plan});
    this.compute();
  }

  /** Keeps the present motion beside those to come, or lets it go. */
  keep(on, label = NAMES[1]) {
    const {page, wheel} = this;
    this.kept = on ? structuredClone(this.plan) : null;
    page.bodies = [wheel, ...(on ? [{...wheel, name: 'kept', label}] : [])];
    page.choice = 0;
    page.offer(page.bodies.length);
    page.dress();
  }

  /** Asks for a new motion, which is no longer the one that had a name; axis: how the diagrams take it. */
  change(axis) {
    const {page, wheel} = this;
    if (wheel.label !== NAMES[0]) {
      wheel.label = NAMES[0];
      page.offer(page.bodies.length);
    }
    page.plots.axis = axis;
    Object.assign(this, {wanted: true, scene: null, refusal: null});
    this.tell();
  }

  /** A start value or parameter; a body's moments follow its mass and radii until one of them is set. */
  setStart(name, value) {
    const {plan} = this;
    plan.values[name] = value;
    if (name === 'J_x') plan.values.J_y = value;
    if (name === 'guided') {  // the axle rests, and a free wheel is not steered
      Object.assign(plan.values, {psi_dot_start: 0, theta_dot_start: 0});
      for (const rate of STEERING) delete plan.values[rate];
      plan.changes = plan.changes.filter((change) => !STEERING.includes(change.name));
    }
    if (MOMENTS.includes(name)) plan.body = null;
    derive(plan);
    this.change('fitted');
  }

  /** Other start values, played from the start. */
  start(values) {
    this.plan.changes = [];
    for (const [name, value] of Object.entries(values)) this.setStart(name, value);
    this.page.player.set({t: 0, playing: true});
  }

  /** The moments of a body of this mass and size. */
  setBody(body) {
    derive(Object.assign(this.plan, {body}));
    this.change('fitted');
  }

  /** A preset wheel from its own start; without friction where there is none now, unless it is thrown. */
  setWheel({plan, thrown}) {
    const {s, ...values} = plan.values;
    this.load({...plan, values: thrown || this.value('s') > 0 ? plan.values : values});
    this.page.player.seek(0);
  }

  /** s or M_3 from now on; what had been planned for later is dropped. */
  setNow(name, value) {
    const {plan, page: {plots}} = this;
    const t = this.now();
    plan.changes = plan.changes.filter((change) => change.name !== name || change.t < t - STEP / 2);
    t <= 0 ? plan.values[name] = value : plan.changes.push({t, name, value});
    plan.changes.sort((a, b) => a.t - b.t);
    this.change(plots.axis === 'fitted' ? 'kept' : plots.axis);
  }

  /** While the reader pushes or drags, the diagrams' axes stay. */
  hold(on) { this.change(on ? 'held' : 'kept'); }

  /** The motion of the present plan, on the page. */
  compute() {
    [this.wanted, this.trouble] = [false, null];
    const {wheel, plan: {values, changes}} = this;
    const begin = performance.now();
    const run = (interval) => this.fmu.run({...this.plan, record: RECORD, interval});
    let {table, ended} = run(STEP);
    this.interval = intervalOf(table, this.parameters());
    if (this.interval < STEP) ({table, ended} = run(this.interval));
    this.took = performance.now() - begin;
    const set = [...Object.entries(values), ...changes.map(({name, value}) => [name, value])];
    const friction = set.some(([name, value]) => HOLDING.includes(name) && value > 0);
    this.page.exchange(Object.assign(wheel, {ended, friction, parameters: this.parameters()}), table);
  }

  /** All that was chosen; `apply` takes it. */
  state() {
    const {plan, kept, page: {switches: {show}, plots: {portrait}, choice, player: {t}}} = this;
    return {plan, kept, show, diagram: portrait.name, view: choice, t};
  }

  /** Whether the story is open and its text describes what is shown. */
  get narrated() { return this.open && sameMotions(this.state(), this.steps[this.step].state); }

  /** Shows a state: of a step of the story 0, 1 ..., or (null) of none. */
  apply({plan, kept, show, diagram, view, t}, step) {
    const {page, steps: {[step]: {names, text, question} = {}}} = this;
    if (kept) this.load(kept);
    this.keep(Boolean(kept), names?.[1]);
    this.load(plan, names?.[0]);
    for (const [name, on] of Object.entries(show)) page.switches.flip(name, on);
    page.plots.portrait.choose(diagram);
    page.choose(view);
    const {speed = 1, balance} = this.steps[step] ?? {};
    if (question && t === 0) {
      page.player.pause();
      this.guess = {asks: true};
      page.plots.keepSecret(true, !question.fates);
    }
    page.stage.stand(balance ? 'behind' : 'beside');
    page.player.set({t, speed});
    [this.step, this.open, this.text] = [step ?? this.step, step !== null, text?.(...page.wheels)];
    this.show();
  }

  /** The story one step on (1), back (-1), or at the same again (0), played from its beginning. */
  turn(by) {
    const step = this.open ? this.step + by : this.step;
    if (!this.steps[step]) return;
    this.link?.leave();
    this.apply(this.steps[step].state, step);
    if (!this.guess) this.page.player.play();
  }

  /** The reader expects one of the fates of the step, and the motion plays. */
  pick(fate) {
    this.guess.picked = fate;
    this.page.player.play();
  }

  /** The motion plays, and answers what the step asks. */
  answer() {
    const {guess, page: {player, plots}, steps, step} = this;
    if (guess?.asks && (player.playing || player.t > 0)) {
      guess.asks = false;
      plots.keepSecret(false);
    }
    const guessed = guess?.picked !== undefined || plots.curves[0].sketch?.length > 1;
    if (guess && !guess.asks) guess.told ||= !guessed || player.t >= steps[step].question.until;
  }

  /** Nothing is asked any more. */
  tell() {
    if (!this.guess) return;
    this.guess = null;
    this.page.plots.keepSecret(false);
    this.page.plots.curves[0].sketch = null;
  }

  /** What the page begins with: its address, else the story. */
  begin() { this.link = new Link(this); }

  /** Once a frame: at most one run, however fast a slider moves. */
  frame() {
    try {
      if (this.wanted) this.compute();
    } catch (fault) {
      this.trouble = fault.message;  // the wheel's own sentence about a start that cannot be
    }
    this.answer();
    this.show();
    this.link?.frame();
  }
}
