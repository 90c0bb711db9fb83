// The controls of the live page: the story or the scenes to begin with, the start, and what the reader does to the
// wheel while it rolls.
import {$, make, makeButton, makeChoice, subscripted} from '#dom';
import {HELD, NOW, START, torqueOf, WHEEL} from '#knobs';

/** The card with the story beside the picture: text, something to try, one step on or back. */
class Story {
  constructor(live) {
    Object.assign(this, {host: $('#story'), live, step: 0, open: true});
    for (const [name, by] of [['back', -1], ['next', 1], ['again', 0]]) this.button(name).onclick = () => this.move(by);
  }

  button(name) { return $(`[name=${name}]`, this.host); }

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
    const {state, names, speed = 1} = live.steps[next];
    live.refusal = null;
    live.apply(state, names);
    live.page.player.setSpeed(speed);
    live.page.player.play();
    this.tell();
  }

  /** Writes the step's text, with the figures of its motion. */
  tell() {
    const {live: {steps, page, panel}, host, step} = this;
    panel.turn(this.open ? 'story' : 'scenes');
    if (!this.open) return;
    const {title, text, attempt} = steps[step];
    const html = {'.count': `${step + 1} of ${steps.length}`, 'h3': title, '.text': text(...page.wheels)};
    html['.try'] = `<b>Try</b> ${attempt}`;
    for (const [place, words] of Object.entries(html)) $(place, host).innerHTML = words;
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
  const [min, max] = ratios ? [Math.log10(low), Math.log10(high)] : [low, high];
  const input = make('input', {type: 'range', name, min, max, step: ratios ? 0.01 : step});
  const output = make('output');
  const title = `${what.replace('_', '')}: ${low} to ${high} ${unit}`;
  const label = make('b', {}, make('i', {}, ...subscripted(symbol)));
  const words = make('span', {}, label, ' ', make('small', {}, ...subscripted(what)));
  host.append(make('label', {className: 'knob', title}, words, input, output));
  let before = 0;  // a finger that scrolls the page has first moved the slider that it began on
  input.oninput = () => take(fromSlider(Number(input.value)));
  input.onpointerdown = () => {
    before = Number(input.value);
    hold(true);
  };
  input.onpointerup = () => hold(false);
  input.onpointercancel = () => {
    take(fromSlider(before));
    hold(false);
  };
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
function makeHeld([text, name, part, what], live, touched) {
  let before = null;  // the value to return to; null while the button is not held
  const press = () => {
    if (before !== null) return;
    touched();
    before = live.present(name);
    live.hold(true);
    live.setNow(name, part(live.spin()) * torqueOf(live.parameters()));
    live.page.player.play();
  };
  const release = () => {
    if (before === null) return;
    live.setNow(name, before);
    live.hold(false);
    before = null;
  };
  const button = makeButton({
    className: 'push',
    textContent: text,
    title: `${what}, as long as you hold it (6 N m for the paper's wheel)`,
    onpointerdown: ({pointerId}) => {
      button.setPointerCapture(pointerId);
      press();
    },
    onpointerup: release,
    onpointercancel: release,
    onblur: release,
    onkeydown: ({key}) => [' ', 'Enter'].includes(key) && press(),
    onkeyup: ({key}) => [' ', 'Enter'].includes(key) && release(),
  });
  return button;
}

/** A button for each scene, into #presets; returns a function that marks one of them by name, or none. */
function makeScenes(scenes, live) {
  const options =
      scenes.map(({label, about = 'A scene of the paper'}, name) => ({name, textContent: label, title: about}));
  const mark = makeChoice($('#presets'), options, (i) => {
    $('#about').textContent = scenes[i].about ?? '';
    mark(i);
    live.refusal = null;
    live.page.player.seek(0);
    live.load(scenes[i].plan);
    live.page.player.play();
  });
  return mark;
}

/** The list of ready wheels {name: {title, source, parameters}}. */
function setUpReady(wheels, live, touched) {
  const select = $('#ready');
  const options =
      Object.entries(wheels).map(([value, {title, source}]) => make('option', {value, title: source}, title));
  select.append(make('option', {value: ''}, 'Ready wheels …'), ...options);
  select.addEventListener('change', () => {
    if (!select.value) return;
    const {parameters, title, source} = wheels[select.value];
    touched();
    live.setWheel(parameters);
    Object.assign(select, {title: source, ariaLabel: `Ready wheel: ${title}`});
  });
}

/** Builds the panel; returns {story, show(): once a frame, turn(name): to the story or to the scenes}. */
export function setUpPanel(live, scenes, wheels) {
  $('#live').hidden = false;
  document.body.classList.add('live');
  const story = new Story(live);
  const mark = makeScenes(scenes, live);
  const touched = () => {
    mark(null);
    live.refusal = null;
  };
  const knobs = (place, list, change, present, hold) => list.map((knob) => {
    const take = (value) => {
      touched();
      change(knob[0], value);
    };
    const show = makeKnob($(place), knob, take, hold);
    return () => show(present(knob[0]));
  });
  const start = [(name, value) => live.setStart(name, value), (name) => live.value(name)];
  const now = [(name, value) => live.setNow(name, value), (name) => live.present(name), (on) => live.hold(on)];
  const all = [...knobs('#start', START, ...start), ...knobs('#wheel', WHEEL, ...start), ...knobs('#now', NOW, ...now)];
  setUpReady(wheels, live, touched);
  $('#push').append(...HELD.map((held) => makeHeld(held, live, touched)));
  $('#keep').addEventListener('change', ({target}) => live.keep(target.checked));
  const tabs = [
    {name: 'story', textContent: 'Story', title: 'What the wheel does and why, step by step'},
    {name: 'scenes', textContent: 'Scenes', title: 'Scenes to begin with'},
  ];
  const markTab = makeChoice($('#live .tabs'), tabs, (name) => {
    if (name === 'story') return story.open || story.move(0);
    story.enter(null);
    return turn('scenes');
  });
  const turn = (chosen) => {
    markTab(chosen);
    for (const {name} of tabs) $(`#${name}`).hidden = name !== chosen;
  };
  const show = () => {
    for (const update of all) update();
    const seconds = Number(live.page.wheels[0].table.end.toPrecision(4));
    const message = live.trouble ?? `${seconds} s computed in ${live.took.toFixed(0)} ms, here in the page.`;
    if ($('#message').textContent !== message) $('#message').textContent = message;
    $('#message').classList.toggle('trouble', Boolean(live.trouble));
    $('#keep').checked = Boolean(live.kept);
    $('#refusal').hidden = !live.refusal;
    if (live.refusal) $('#refusal').textContent = live.refusal;
  };
  return {story, turn, show};
}
