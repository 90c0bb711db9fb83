// The clock of the page: play, pause, speed, seek; its bar with the stick phases behind the slider; the keys and
// switches. Time in s.
import {$, make} from '#dom';

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4];

/** Where the motion is shown; after every change an event `change`. */
export class Player extends EventTarget {
  constructor() {
    super();
    Object.assign(this, {t: 0, start: 0, end: 1, speed: 1, playing: false});
  }

  /** Takes some of t, start, end, speed and playing; t stays inside. */
  set(values) {
    Object.assign(this, values);
    this.t = Math.min(this.end, Math.max(this.start, this.t));
    this.dispatchEvent(new Event('change'));
  }

  seek(t) { this.set({t}); }

  play() { this.set({playing: true, t: this.t >= this.end ? this.start : this.t}); }

  pause() { this.set({playing: false}); }

  /** The next faster (+1) or slower (-1) speed. */
  shift(direction) { this.set({speed: SPEEDS[SPEEDS.indexOf(this.speed) + direction] ?? this.speed}); }

  /** A frame that lasted dt seconds of the reader's time. */
  advance(dt) {
    if (!this.playing) return;
    this.seek(this.t + dt * this.speed);
    if (this.t >= this.end) this.pause();
  }
}

/** Shows slides in the upper half of the track behind the slider, stick phases in the lower. */
export function showBands(wheels, {start, end}) {
  const part = (t) => (100 * t) / (end - start || 1);
  const band = (className) => ([from, to]) =>
      make('i', {className, style: `left:${part(from - start)}%; width:max(1px, ${part(to - from)}%)`});
  const bands =
      wheels.flatMap(({phases: {slides, sticks}}) => [...slides.map(band('slide')), ...sticks.map(band('stick'))]);
  $('#bands').replaceChildren(...bands);
}

export function setUpTransport(player) {
  const [button, slider, clock, speed] = ['#play', '#time', '#clock', '#speed'].map((place) => $(place));
  speed.append(...SPEEDS.map((value) => make('option', {value}, `${value} ×`)));
  button.onclick = () => (player.playing ? player.pause() : player.play());
  slider.oninput = () => player.seek(Number(slider.value));
  speed.onchange = () => player.set({speed: Number(speed.value)});
  const show = () => {
    const t = player.t.toFixed(2);
    [slider.min, slider.max, slider.value] = [player.start, player.end, player.t];
    slider.ariaValueText = `${t} seconds`;
    clock.textContent = `${t} s`;
    button.dataset.playing = player.playing;
    button.ariaLabel = player.playing ? 'Pause' : 'Play';
    speed.value = player.speed;
  };
  player.addEventListener('change', show);
  show();
}

/** What the scene shows, from the boxes of page.html: {show: {name: on}, flip(name, on)}. */
export function setUpSwitches(stage, changed) {
  const boxes = [...document.querySelectorAll('#toggles input')];
  const show = Object.fromEntries(boxes.map(({name, checked}) => [name, checked]));
  const flip = (name, on = !show[name]) => {
    boxes.find((box) => box.name === name).checked = show[name] = on;
    stage.dirty = true;
  };
  $('#toggles').onchange = ({target: {name, checked}}) => {
    flip(name, checked);
    changed();  // other arrows may have another scale
  };
  return {show, flip};
}

const PRESSED = 'button, select, input[type=checkbox], input[type=radio]';  // by the space bar
const MOVED = 'input, select, canvas';  // by arrow keys; of the canvas, the scene turns

/** The page's keys: those here, else the button in sight that has the key as its shortcut. Fields keep their own. */
export function setUpKeys({player, stage}) {
  const seek = (by) => ({shiftKey}) => player.seek(player.t + (shiftKey ? 10 : 1) * by);
  const keys = {
    'arrowleft': seek(-0.05),
    'arrowright': seek(0.05),
    'home': () => player.seek(player.start),
    'end': () => player.seek(player.end),
    '+': () => player.shift(1),
    '-': () => player.shift(-1),
    'r': () => stage.controls.reset(),
  };
  addEventListener('keydown', (event) => {
    const key = event.key === ' ' ? 'space' : event.key.toLowerCase();
    const kept = key === 'space' ? PRESSED : key.length > 1 ? MOVED : '_';
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.matches?.(`${kept}, .number`)) return;
    const button = $(`[aria-keyshortcuts="${CSS.escape(key)}" i]`);
    const act = button?.checkVisibility() ? () => button.click() : keys[key];
    if (!act) return;
    act(event);
    event.preventDefault();
  });
  // A button that was clicked does not keep the focus: the space bar plays, and does not click it again.
  addEventListener(
      'click', ({detail}) => detail > 0 && document.activeElement?.matches(PRESSED) && document.activeElement.blur());
  addEventListener('change', ({target}) => target.matches('select') && target.blur());
}
