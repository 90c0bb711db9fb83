// The controls of the live page: the story or the scenes to begin with, the start, and what the reader does to the
// wheel while it rolls.
import {HELD, NOW, START} from '#knobs';
import {Story} from '#story';

const SHELL = `
  <div class="segments tabs" role="radiogroup" aria-label="Story or scenes">
    <button type="button" role="radio" name="story" title="What the wheel does and why, step by step">Story</button>
    <button type="button" role="radio" name="scenes" title="Scenes to begin with">Scenes</button></div>
  <p class="note trouble" id="refusal" role="alert" hidden></p>
  <div id="story"></div>
  <div id="scenes"><div id="presets"></div><p class="note" id="about"></p></div>
  <h2>Start</h2><div id="start"></div>
  <h2>While it rolls, from now on</h2><div id="now"></div>
  <div class="row" id="push"></div>
  <label class="keep" title="Leaves this motion beside the next one"><input type="checkbox" id="keep"> Keep this motion
    to compare with</label>
  <p class="note" id="message"></p>`;

/** One slider; take(value in SI) when it moves, hold(on) while it is dragged. Returns a function that shows a value. */
function makeKnob(host, [name, symbol, unit, low, high, step, what], take, hold = () => {}) {
  const scale = unit === '°' ? 180 / Math.PI : 1;
  const digits = Math.ceil(-Math.log10(step) - 1e-9);
  const label = document.createElement('label');
  label.className = 'knob';
  label.title = `${what}: ${low} to ${high} ${unit}`;
  label.innerHTML = `<span><b><i>${symbol}</i></b> <small>${what}</small></span>` +
      `<input type="range" name="${name}" min="${low}" max="${high}" step="${step}"><output></output>`;
  host.append(label);
  const [output, input] = [label.querySelector('output'), label.querySelector('input')];
  input.addEventListener('input', () => take(Number(input.value) / scale));
  // A finger that scrolls the page has first moved the slider that it began on.
  let before = 0;
  input.addEventListener('pointerdown', () => {
    before = Number(input.value);
    hold(true);
  });
  input.addEventListener('pointerup', () => hold(false));
  input.addEventListener('pointercancel', () => {
    take(before / scale);
    hold(false);
  });
  let shown = null;
  return (value) => {
    if (value === shown) return;
    shown = value;
    input.value = value * scale;
    output.textContent = `${(value * scale).toFixed(digits).replace('-', '−')} ${unit}`;
  };
}

/** A button that sets a variable as long as it is held, by pointer or by key. */
function makeHeld(host, [text, name, value, what], live, touched) {
  const button = document.createElement('button');
  Object.assign(
      button, {type: 'button', className: 'push', textContent: text, title: `${what}, as long as you hold it`});
  host.append(button);
  let before = null;  // the value to return to; null while the button is not held
  const press = () => {
    if (before !== null) return;
    touched();
    before = live.present(name);
    live.hold(true);
    live.setNow(name, value(live.spin()));
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

/** A button for each preset, into #presets; returns a function that marks one of them, or none. */
function makePresets($, presets, live) {
  const buttons = presets.map((preset) => {
    const button = document.createElement('button');
    Object.assign(button, {type: 'button', textContent: preset.label, title: preset.about ?? 'A scene of the paper'});
    button.addEventListener('click', () => {
      $('about').textContent = preset.about ?? '';
      mark(button);
      live.refusal = null;
      live.page.player.seek(0);
      live.load(preset);
      live.page.player.play();
    });
    $('presets').append(button);
    return button;
  });
  const mark = (chosen) => buttons.forEach((button) => button.setAttribute('aria-pressed', button === chosen));
  mark(null);
  return mark;
}

/** Builds the panel; returns {story, show(): once a frame, turn(story?): to the story or to the scenes}. */
export function setUpPanel(live, presets) {
  const host = document.querySelector('#live');
  host.hidden = false;
  document.body.classList.add('live');
  host.innerHTML = SHELL;
  const $ = (id) => host.querySelector(`#${id}`);
  const mark = makePresets($, presets, live);
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
  const starts = knobs('start', START, (name, value) => live.setStart(name, value));
  const nows = knobs('now', NOW, (name, value) => live.setNow(name, value), (on) => live.hold(on));
  for (const held of HELD) makeHeld($('push'), held, live, touched);
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
    const steps = `${live.stop} s computed in ${live.took?.toFixed(0) ?? '…'} ms, here in the page.`;
    const message = live.trouble ?? steps;
    if ($('message').textContent !== message) $('message').textContent = message;
    $('message').classList.toggle('trouble', Boolean(live.trouble));
    $('keep').checked = Boolean(live.kept);
    $('refusal').hidden = !live.refusal;
    if (live.refusal) $('refusal').textContent = live.refusal;
  };
  return {story, turn, show};
}
