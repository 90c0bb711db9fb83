// The controls of the live page: the story or the scenes to begin with, the start, and what the reader does to the
// wheel while it rolls.
import {HELD, NOW, START, torqueOf, WHEEL} from '#knobs';

const SHELL = `
  <div class="segments tabs" role="radiogroup" aria-label="Story or scenes">
    <button type="button" role="radio" name="story" title="What the wheel does and why, step by step">Story</button>
    <button type="button" role="radio" name="scenes" title="Scenes to begin with">Scenes</button></div>
  <p class="note trouble" id="refusal" role="alert" hidden></p>
  <div id="story"><p class="count"></p><h3></h3><p class="text"></p><p class="try"></p>
    <button type="button" name="again" title="What the text describes, from its start">Back to the story's wheel</button>
    <div class="row"><button type="button" name="back" title="The step before (key B)">◀ Back</button>
    <button type="button" name="next" title="The next step (key N)">Next ▶</button></div></div>
  <div id="scenes"><div id="presets"></div><p class="note" id="about"></p></div>
  <h2>Start</h2><div id="start"></div>
  <h2>While it rolls, from now on</h2><div id="now"></div>
  <details id="wheel"><summary title="Mass, radii and inertia; ready wheels">The wheel itself</summary>
    <select id="ready" aria-label="Ready wheel" title="Ready wheels, with their sources"></select></details>
  <label class="keep" title="Leaves this motion beside the next one"><input type="checkbox" id="keep"> Keep this motion
    to compare with</label>
  <p class="note" id="message"></p>`;

/** The card that tells the story beside the picture: text, something to try, one step on or back. */
class Story {
  constructor(host, live) {
    Object.assign(this, {host, live, step: 0, open: true});
    this.on('back', () => this.move(-1));
    this.on('next', () => this.move(1));
    this.on('again', () => this.move(0));
  }

  button(name) { return this.host.querySelector(`[name=${name}]`); }

  on(name, act) { this.button(name).addEventListener('click', act); }

  /** The story at step 1, 2 ..., or closed (null). */
  enter(step) {
    this.open = step !== null;
    if (this.open) this.step = step - 1;
  }

  /** One step on (1), back (-1), or the same again (0), shown from its beginning. */
  move(by) {
    const {live} = this;
    const next = this.open ? this.step + by : this.step;
    if (!live.steps[next]) return;
    this.enter(next + 1);
    const {state, names, speed} = live.steps[next];
    live.refusal = null;
    live.apply(state, names);
    live.page.player.setSpeed(speed ?? 1);
    live.page.player.play();
    this.tell();
  }

  /** Writes the step's text, with the figures of its motion. */
  tell() {
    const {live: {steps, page, panel}, host, step} = this;
    panel.turn(this.open);
    if (!this.open) return;
    const {title, text, attempt} = steps[step];
    const put = (place, html) => (host.querySelector(place).innerHTML = html);
    put('.count', `${step + 1} of ${steps.length}`);
    put('h3', title);
    put('.text', text(...page.wheels));
    put('.try', `<b>Try</b> ${attempt}`);
    this.button('back').disabled = step === 0;
    this.button('next').disabled = step === steps.length - 1;
  }

  /** The text describes the step's own motion: beside another one it is faint. */
  compare(same) {
    this.host.classList.toggle('apart', !same);
    this.button('again').hidden = same;
  }
}

/** One slider; take(value in SI) when it moves, hold(on) while it is dragged. Returns a function that shows a value. */
function makeKnob(host, [name, symbol, unit, low, high, step, what], take, hold = () => {}) {
  const ratios = step === 'log';
  const scale = unit === '°' ? 180 / Math.PI : 1;
  const digits = Math.ceil(-Math.log10(step) - 1e-9);
  const toSlider = (value) => (ratios ? Math.log10(value) : value * scale);
  const fromSlider = (place) => (ratios ? Number((10 ** place).toPrecision(3)) : place / scale);
  const ends = ratios ? [Math.log10(low), Math.log10(high), 0.01] : [low, high, step];
  const label = document.createElement('label');
  label.className = 'knob';
  label.title = `${what.replace(/<.?sub>/g, '')}: ${low} to ${high} ${unit}`;
  label.innerHTML = `<span><b><i>${symbol}</i></b> <small>${what}</small></span>` +
      `<input type="range" name="${name}" min="${ends[0]}" max="${ends[1]}" step="${ends[2]}"><output></output>`;
  host.append(label);
  const [output, input] = [label.querySelector('output'), label.querySelector('input')];
  input.addEventListener('input', () => take(fromSlider(Number(input.value))));
  // A finger that scrolls the page has first moved the slider that it began on.
  let before = 0;
  input.addEventListener('pointerdown', () => {
    before = Number(input.value);
    hold(true);
  });
  input.addEventListener('pointerup', () => hold(false));
  input.addEventListener('pointercancel', () => {
    take(fromSlider(before));
    hold(false);
  });
  let shown = null;
  return (value) => {
    if (value === shown) return;
    shown = value;
    input.value = toSlider(value);
    const text = ratios ? String(Number(value.toPrecision(3))) : (value * scale).toFixed(digits);
    output.textContent = `${text.replaceAll('-', '−')} ${unit}`;
  };
}

/** A button that sets a variable as long as it is held, by pointer or by key. */
function makeHeld(host, [text, name, value, what], live, touched) {
  const button = document.createElement('button');
  Object.assign(button, {
    type: 'button',
    className: 'push',
    textContent: text,
    title: `${what}, as long as you hold it (6 N m for the paper's wheel)`
  });
  host.append(button);
  let before = null;  // the value to return to; null while the button is not held
  const press = () => {
    if (before !== null) return;
    touched();
    before = live.present(name);
    live.hold(true);
    live.setNow(name, value(live.spin(), torqueOf(...['m', 'g', 'r_0', 'r'].map((part) => live.value(part)))));
    live.page.player.play();
  };
  const release = () => {
    if (before === null) return;
    live.setNow(name, before);
    live.hold(false);
    before = null;
  };
  button.addEventListener('pointerdown', (event) => {
    button.setPointerCapture(event.pointerId);
    press();
  });
  for (const kind of ['pointerup', 'pointercancel', 'blur']) button.addEventListener(kind, release);
  const isKey = (event) => event.key === ' ' || event.key === 'Enter';
  button.addEventListener('keydown', (event) => isKey(event) && press());
  button.addEventListener('keyup', (event) => isKey(event) && release());
}

/** A button for each scene, into #presets; returns a function that marks one of them, or none. */
function makeScenes($, scenes, live) {
  const buttons = scenes.map(({label, plan, about}) => {
    const button = document.createElement('button');
    Object.assign(button, {type: 'button', textContent: label, title: about ?? 'A scene of the paper'});
    button.addEventListener('click', () => {
      $('about').textContent = about ?? '';
      mark(button);
      live.refusal = null;
      live.page.player.seek(0);
      live.load(plan);
      live.page.player.play();
    });
    $('presets').append(button);
    return button;
  });
  const mark = (chosen) => buttons.forEach((button) => button.setAttribute('aria-pressed', button === chosen));
  mark(null);
  return mark;
}

/** The list of ready wheels {name: {title, source, parameters}}. */
function makeReady(select, wheels, live, touched) {
  select.hidden = !Object.keys(wheels).length;
  select.append(new Option('Ready wheels …', ''));
  for (const [name, {title, source}] of Object.entries(wheels)) {
    const option = new Option(title, name);
    option.title = source;
    select.append(option);
  }
  select.addEventListener('change', () => {
    const {parameters, title, source} = wheels[select.value] ?? {};
    select.title = source ?? '';
    if (!parameters) return;
    touched();
    live.setWheel(parameters);
    select.setAttribute('aria-label', `Ready wheel: ${title}`);
  });
}

/** Builds the panel; returns {story, show(): once a frame, turn(story?): to the story or to the scenes}. */
export function setUpPanel(live, scenes, wheels) {
  const host = document.querySelector('#live');
  host.hidden = false;
  document.body.classList.add('live');
  host.innerHTML = SHELL;
  const $ = (id) => host.querySelector(`#${id}`);
  const mark = makeScenes($, scenes, live);
  const story = new Story($('story'), live);
  const touched = () => {
    mark(null);
    live.refusal = null;
  };
  const knobs = (place, list, change, hold) => list.filter(([name]) => name in live.fmu.variables).map((knob) => {
    const take = (value) => {
      touched();
      change(knob[0], value);
    };
    return [knob[0], makeKnob($(place), knob, take, hold)];
  });
  const start = (name, value) => live.setStart(name, value);
  const starts = [...knobs('start', START, start), ...knobs('wheel', WHEEL, start)];
  const nows = knobs('now', NOW, (name, value) => live.setNow(name, value), (on) => live.hold(on));
  makeReady($('ready'), wheels, live, touched);
  for (const held of HELD) makeHeld(document.querySelector('#push'), held, live, touched);
  $('keep').addEventListener('change', () => live.keep($('keep').checked));
  const turn = (told) => {
    $('story').hidden = !told;
    $('scenes').hidden = told;
    for (const tab of host.querySelectorAll('.tabs button'))
      tab.setAttribute('aria-checked', (tab.name === 'story') === told);
  };
  host.querySelector('[name=story]').addEventListener('click', () => story.open || story.move(0));
  host.querySelector('[name=scenes]').addEventListener('click', () => {
    story.enter(null);
    turn(false);
  });
  const show = () => {
    for (const [name, set] of starts) set(live.value(name));
    for (const [name, set] of nows) set(live.present(name));
    const seconds = Number(live.page.wheels[0].table.end.toPrecision(4));
    const steps = `${seconds} s computed in ${live.took?.toFixed(0) ?? '…'} ms, here in the page.`;
    const message = live.trouble ?? steps;
    if ($('message').textContent !== message) $('message').textContent = message;
    $('message').classList.toggle('trouble', Boolean(live.trouble));
    $('keep').checked = Boolean(live.kept);
    $('refusal').hidden = !live.refusal;
    if (live.refusal) $('refusal').textContent = live.refusal;
  };
  return {story, turn, show};
}
