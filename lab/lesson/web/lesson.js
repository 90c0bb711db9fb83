// The lesson: one step after the other, each with its picture, its diagrams and its controls. The wheel computes its
// whole motion anew, within some milliseconds, whenever the reader changes a value. A push while it rolls leaves the
// past alone and makes a new future.
import {Link} from '#address';
import {makeControls, planOf, setUpHeld} from '#controls';
import {$, fixed, live, make, makeButton, makeChoice, say, variables} from '#dom';
import {STEP} from '#fmu';
import {phasesOf} from '#phases';
import {nutation, perRadian} from '#pictures';
import {FORK, FREE, stepsOf} from '#steps';
import {extent, POSE, Table} from '#table';

const SIGNALS = [
  'omega_z', 'omega_z_dot',   'lambda_1', 'lambda_2', 'lambda_3',  'lambda_x', 'lambda_y',
  'E',       'friction_mode', 'n_events', 'slip_x',   'slip_y',    'v_x',      'v_y',
  'tau',     'tau_brake',     's',        'M_brake',  'M_guide_1', 'M_guide_2'
];
const RECORD = [...POSE, ...POSE.map((name) => `${name}_dot`), ...SIGNALS];
const HOLDING = ['s', 'M_brake'];  // may hold the wheel at omega_z = 0
const FINEST = 12;                 // parts of STEP, at most

/** The part of STEP, s, that gives nutation and turn live.POINTS rows a period; a guided wheel has neither. */
function intervalOf({columns: {theta, psi_dot, omega_z}}, wheel) {
  if (wheel.guided) return STEP;
  const turn = psi_dot.map((rate, i) => rate * Math.sin(theta[i]));
  const [across, spin] = [turn, omega_z].map((rates) => Math.max(...extent(rates).map(Math.abs)));
  const parts = Math.ceil(STEP * live.POINTS * Math.max(across, nutation(wheel) * spin) / (2 * Math.PI));
  return STEP / Math.min(FINEST, Math.max(1, parts));
}

/**
 * steps; step: 0, 1 ... of them; chosen: values of its controls; plan: of the run, that of the values until the reader
 * pushes; guess: what the reader expects of a step that asks, or null: {asks: not played yet, picked: number of the
 * fate, told: whether the motion has shown it}. refusal, trouble: why an address or a start cannot be; wanted: whether
 * the motion is still to be computed.
 */
export class Lesson {
  constructor(page, fmu) {
    Object.assign(this, {page, fmu, step: 0, chosen: {}, guess: null, picture: 'precession'});
    this.steps = stepsOf();
    this.wheel = {name: 'wheel', label: 'The wheel'};
    page.wheels.push(this.wheel);
    this.compute(this.wheel, planOf(this.steps[0].start));
    document.body.classList.add('live');
    $('#live').hidden = false;
    this.setUp();
  }

  /** The elements that all steps share. */
  setUp() {
    const list = $('#steps');
    list.append(...this.steps.map(({title}, i) => make('option', {value: i}, `${i + 1} ${title}`)));
    list.onchange = () => this.turn(Number(list.value));
    [$('#live [name=back]').onclick, $('#live [name=next]').onclick] =
        [-1, 1].map((by) => () => this.turn(this.step + by));
    $('#again').onclick = () => this.turn(this.step);
    const kinds = Object.entries(FREE).map(([name, {label}]) => ({name, label, title: `Show the picture of ${label}`}));
    this.markPicture = makeChoice($('#pictures'), kinds, (name) => {
      this.picture = name;
      this.showPicture();
    });
    setUpHeld(this);
  }

  /** What the page begins with: its address, else the first step. */
  begin() { this.link = new Link(this); }

  /** The step that is open. */
  get current() { return this.steps[this.step]; }

  /** The diagrams that are shown, by name. */
  get diagrams() { return this.current.free ? this.free.diagrams : this.current.diagrams; }

  /** Of free play; a wheel in a fork shows its moment. */
  get free() { return this.wheel.parameters.guided && this.picture === 'precession' ? FORK : FREE[this.picture]; }

  /** Another step, played from its beginning. */
  turn(step) {
    if (!this.steps[step]) return;
    this.link.leave();
    this.open(step);
    this.link.arrive();
    if (!this.guess) this.page.player.play();
  }

  /** Shows a step and nothing of the one before; chosen: values other than its own. */
  open(step, chosen = {}) {
    const {page} = this;
    this.forget();
    const {start, beside, names = ['The wheel'], eye, speed = 1, at = 0, controls, ask, axes} = this.steps[step];
    const own = Object.fromEntries(controls.filter((name) => name !== 'push').map((name) => [name, start[name]]));
    Object.assign(this, {step, own, chosen: {...own, ...chosen}, refusal: null, pushed: false});
    Object.assign(page.plots, {axis: 'fitted'});
    page.player.set({playing: false, t: 0, speed});
    this.wheel.label = names[0];
    page.wheels = [this.wheel, ...(beside ? [{name: 'beside', label: names[1], hue: 2}] : [])];
    this.run();
    page.choice = 0;
    page.offer();
    page.switches.flip('axes', Boolean(axes));
    page.stage.stand(eye ?? 'beside');
    if (ask && !Object.keys(chosen).length) this.guess = {asks: true};
    page.player.end = this.plan.stop;
    page.dress();
    this.text = this.tell(this.current);
    this.showControls = makeControls($('#controls'), controls, this);
    this.showPicture();
    if (this.guess) page.plots.keepSecret(true, !ask.fates);
    page.player.set({t: this.guess ? 0 : at});
    this.write();
  }

  /** The arrows of the step, which a question hides. */
  showPicture() {
    const {page, current: {picture, free}, guess} = this;
    const name = free ? this.free.name ?? this.picture : picture;
    page.pictures = guess?.asks ? [] : name ? [name] : ['slip'];
    page.choose(page.choice);
  }

  /** Motions of the values chosen, which are not shown yet. */
  run() {
    const {current: {start, beside}, chosen, page} = this;
    this.plan = planOf({...start, ...chosen});
    this.compute(this.wheel, this.plan);
    if (beside) this.compute(page.wheels[1], planOf({...start, ...chosen, ...beside}));
  }

  /** The text of a step, whose figures are those of its own start, from rows of a millisecond. */
  tell({start, beside, text}) {
    const motions =
        [start, ...(beside ? [{...start, ...beside}] : [])].map((one) => this.motion(planOf(one), STEP / 10));
    return text(...motions.map((motion) => ({...motion, phases: phasesOf(motion.table, motion.friction)})));
  }

  /** A wheel's motion by a plan. */
  compute(wheel, plan) {
    const {table, ...more} = this.motion(plan);
    this.page.exchange(Object.assign(wheel, more), table);
  }

  /**
   * The motion of a plan: {table, ended, friction, parameters, perRadian}; interval: from row to row, if it is given.
   */
  motion(plan, given) {
    const {values, changes} = plan;
    const names = Object.keys(variables).filter((name) => variables[name].causality === 'parameter');
    const parameters =
        Object.fromEntries(names.map((name) => [name, Number(values[name] ?? variables[name].start ?? 0)]));
    const run = (interval) => this.fmu.run({...plan, record: RECORD, interval});
    let {table, ended} = run(given ?? STEP);
    const interval = given ?? intervalOf(table, parameters);
    if (!given && interval < STEP) ({table, ended} = run(interval));
    const set = [...Object.entries(values), ...changes.map(({name, value}) => [name, value])];
    const friction = set.some(([name, value]) => HOLDING.includes(name) && value > 0);
    const bars = parameters.guided || parameters.J_x !== parameters.J_y ? null : perRadian(this.fmu, values);
    return {table, ended, friction, parameters, perRadian: bars};
  }

  /** Another value of a control: a motion from the start, which nothing was asked about. */
  set(name, value) {
    if (this.chosen[name] === value) return;
    this.chosen = {...this.chosen, [name]: value};
    this.change('fitted');
    this.pushed = false;
  }

  /** The value of an input at the present. */
  present(name) {
    const now = this.now() + STEP / 2;
    return this.plan.changes.findLast((change) => change.name === name && change.t <= now)?.value ?? 0;
  }

  /** The present as a communication point. */
  now() { return Math.round(this.page.player.t / STEP) * STEP; }

  /** An input from now on; what had been planned for later is dropped. */
  setNow(name, value) {
    const [{plan}, t] = [this, this.now()];
    plan.changes = plan.changes.filter((change) => change.name !== name || change.t < t - STEP / 2);
    plan.changes.push({t, name, value});
    plan.changes.sort((a, b) => a.t - b.t);
    this.pushed = true;
  }

  /** While the reader pushes or drags, the diagrams' axes stay. */
  hold(on) { this.change(on ? 'held' : 'kept'); }

  /** Asks for a new motion; axis: how the diagrams take it. */
  change(axis) {
    this.page.plots.axis = axis;
    Object.assign(this, {wanted: true, refusal: null});
    this.forget();
  }

  /** The reader expects one of the fates of the step, and the motion plays. */
  pick(fate) {
    this.guess.picked = fate;
    this.page.player.play();
    $('#play').focus();  // the answers, of which one had the focus, are gone
  }

  /** The motion plays, and answers what the step asks; then it rests, so that the answer can be read. */
  answer() {
    const {guess, page: {player, plots}, current: {ask}} = this;
    if (!guess || guess.told) return;
    if (guess.asks && (player.playing || player.t > 0)) {
      guess.asks = false;
      plots.keepSecret(false);
      this.showPicture();
    }
    const guessed = guess.picked !== undefined || plots.tilt?.sketch?.length > 1;
    if (guess.asks || (guessed && player.t < ask.until)) return;
    guess.told = true;
    if (guessed) player.pause();
    this.write();
  }

  /** What the motion shows of the reader's guess. */
  verdict() {
    const {guess: {picked}, current: {ask: {fates, right}}, page: {wheels, plots: {tilt}}} = this;
    const fate = fates?.[right(...wheels)];
    if (picked !== undefined) return `${fates[picked] === fate ? 'As you guessed' : 'Not so'}: ${fate}`;
    if (!(tilt?.sketch?.length > 1)) return '';
    const [time, lean] = [0, 1].map((i) => tilt.sketch.map((point) => point[i]));
    const drawn = new Table({time, lean});
    const shown = tilt.lines[0].filter(([t]) => t <= drawn.end);
    const off = shown.reduce((sum, [t, moved]) => sum + Math.abs(drawn.value('lean', t) - moved), 0);
    return `Your line (dashed) is off by ${fixed(off / shown.length, 1)}° on average.`;
  }

  /** Nothing is asked any more. */
  forget() {
    const {guess, page: {plots}} = this;
    if (!guess) return;
    this.guess = null;
    plots.keepSecret(false);
    if (plots.tilt) plots.tilt.sketch = null;
    this.showPicture();
    this.write();
  }

  /** The words of the step: its question, or what there is to see; then what to try. */
  write() {
    const {guess, current: {title, ask, attempt, free}, step, steps} = this;
    const asked = guess && !guess.told;
    $('#story h2').textContent = title;
    $('#story .text').innerHTML = asked ? ask.text : this.text;
    $('#story .try').innerHTML = `<b>Try</b> ${attempt}`;
    $('#story .try').hidden = Boolean(asked);
    const fates = guess?.asks ? ask.fates ?? [] : [];
    const button = (textContent, k) =>
        makeButton({textContent, title: 'Your guess; then it plays'}, () => this.pick(k));
    $('#story .guess').replaceChildren(...fates.map(button));
    say($('#story .verdict'), guess?.told ? this.verdict() : '');
    $('#controls').hidden = Boolean(asked);
    $('#pictures').hidden = !free;
    this.markPicture(this.picture);
    document.body.classList.toggle('asks', Boolean(guess?.asks));
    document.body.classList.toggle('draws', Boolean(guess?.asks && !ask.fates));
    $('#steps').value = step;
    [$('#live [name=back]').disabled, $('#live [name=next]').disabled] = [step === 0, step === steps.length - 1];
  }

  /** Once a frame: at most one run, however fast a slider moves. */
  frame() {
    try {
      if (this.wanted) {
        Object.assign(this, {wanted: false, trouble: null});
        this.pushed ? this.compute(this.wheel, this.plan) : this.run();
        this.page.renew();
      }
    } catch (fault) {
      this.trouble = fault.message;  // the wheel's own sentence about a start that cannot be
    }
    this.answer();
    this.showControls(this.wheel.parameters);
    say($('#refusal'), this.refusal ?? this.trouble);
    $('#again').hidden = !this.pushed && JSON.stringify(this.chosen) === JSON.stringify(this.own);
    this.link?.frame();
  }
}
