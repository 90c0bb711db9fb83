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

  toggle() { this.playing ? this.pause() : this.play(); }

  setSpeed(speed) { this.set({speed}); }

  /** The next faster (+1) or slower (-1) speed. */
  shift(direction) { this.setSpeed(SPEEDS[SPEEDS.indexOf(this.speed) + direction] ?? this.speed); }

  /** A frame that lasted dt seconds of the reader's time. */
  advance(dt) {
    if (!this.playing) return;
    this.seek(this.t + Math.min(dt, 0.1) * this.speed);
    if (this.t >= this.end) this.pause();
  }
}

/** Shows the stick phases behind the slider. */
export function showBands(wheels, {start, end}) {
  const part = (t) => (100 * t) / (end - start || 1);
  const bands = wheels.flatMap(({phases}) => phases.sticks);
  $('#bands').replaceChildren(...bands.map(
      ([from, to]) => make('i', {style: `left:${part(from - start)}%; width:max(1px, ${part(to - from)}%)`})));
}

export function setUpTransport(player) {
  const [button, slider, clock, speed] = ['#play', '#time', '#clock', '#speed'].map((place) => $(place));
  speed.append(...SPEEDS.map((value) => make('option', {value}, `${value} ×`)));
  button.addEventListener('click', () => player.toggle());
  slider.addEventListener('input', () => player.seek(Number(slider.value)));
  speed.addEventListener('change', () => player.setSpeed(Number(speed.value)));
  const show = () => {
    const t = player.t.toFixed(2);
    [slider.min, slider.max, slider.value] = [player.start, player.end, player.t];
    slider.setAttribute('aria-valuetext', `${t} seconds`);
    clock.textContent = `${t} s`;
    button.dataset.playing = player.playing;
    button.setAttribute('aria-label', player.playing ? 'Pause' : 'Play');
    speed.value = player.speed;
  };
  player.addEventListener('change', show);
  show();
}

/** What the scene shows, from the boxes of page.html: {show: {name: on}, flip(name, on)}. */
export function setUpSwitches(page) {
  const boxes = [...document.querySelectorAll('#toggles input')];
  const show = Object.fromEntries(boxes.map(({name, checked}) => [name, checked]));
  const flip = (name, on = !show[name]) => {
    $(`#toggles [name=${name}]`).checked = show[name] = on;
    page.stage.dirty = true;
  };
  for (const box of boxes) box.addEventListener('change', () => flip(box.name, box.checked));
  return {show, flip};
}

const PRESSED = 'button, select, summary, input[type=checkbox]';  // by the space bar
const MOVED = 'input, select, summary, textarea, canvas';         // by arrow keys; of the canvas, the scene turns

/** The page's keys. Fields keep their own. */
export function setUpKeys(page) {
  const {player, switches, plots} = page;
  const seek = (by) => ({shiftKey}) => player.seek(player.t + (shiftKey ? 10 : 1) * by);
  const keys = {
    'ArrowLeft': seek(-0.05),
    'ArrowRight': seek(0.05),
    'Home': () => player.seek(player.start),
    'End': () => player.seek(player.end),
    ' ': () => player.toggle(),
    '+': () => player.shift(1),
    '-': () => player.shift(-1),
    'f': () => switches.flip('follow'),
    'p': () => switches.flip('path'),
    'a': () => switches.flip('axes'),
    'g': () => switches.flip('force'),
    'r': () => page.stage.home(),
    'd': () => plots.portrait.next(),
    'n': () => page.live?.panel.story.move(1),
    'b': () => page.live?.panel.story.move(-1),
  };
  for (let i = 0; i < 9; ++i) keys[i + 1] = () => i < page.choices.length && page.choose(i);
  addEventListener('keydown', (event) => {
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const kept = key === ' ' ? PRESSED : key.length > 1 ? MOVED : '_';
    if (event.ctrlKey || event.metaKey || event.altKey || !(key in keys) || event.target.matches?.(kept)) return;
    keys[key](event);
    event.preventDefault();
  });
  // A button that was clicked does not keep the focus: the space bar plays, and does not click it again.
  addEventListener(
      'click', ({detail}) => detail > 0 && document.activeElement?.matches(PRESSED) && document.activeElement.blur());
  addEventListener('change', ({target}) => target.matches('select') && target.blur());
}
