// The clock of the page: play, pause, speed, seek; its bar with the stick phases behind the slider; the keys and
// switches. Time in s.
import {colour} from '#theme';

const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4];
const $ = (selector) => document.querySelector(selector);

export class Player extends EventTarget {
  constructor() {
    super();
    Object.assign(this, {t: 0, start: 0, end: 1, speed: 1, playing: false});
  }

  /** The span of time that can be shown; t stays inside. */
  span(start, end) {
    [this.start, this.end] = [start, end];
    this.seek(this.t);
  }

  seek(t) {
    this.t = Math.min(this.end, Math.max(this.start, t));
    this.tell('time');
  }

  play(on = true) {
    if (on && this.t >= this.end) this.t = this.start;
    this.playing = on;
    this.tell('state');
  }

  pause() { this.play(false); }

  toggle() { this.play(!this.playing); }

  setSpeed(speed) {
    this.speed = speed;
    this.tell('state');
  }

  /** The next faster (+1) or slower (-1) speed. */
  shift(direction) {
    const speed = SPEEDS[SPEEDS.indexOf(this.speed) + direction];
    if (speed) this.setSpeed(speed);
  }

  /** A frame that lasted dt seconds of the reader's time. */
  advance(dt) {
    if (!this.playing) return;
    this.seek(this.t + Math.min(dt, 0.1) * this.speed);
    if (this.t >= this.end) this.pause();
  }

  tell(what) { this.dispatchEvent(new Event(what)); }
}

/** Draws the stick phases behind the slider. */
export function drawBands(wheels, player) {
  const canvas = $('#bands');
  const ratio = Math.min(2, devicePixelRatio);
  const {clientWidth: width, clientHeight: height} = canvas;
  [canvas.width, canvas.height] = [width * ratio, height * ratio];
  const pen = canvas.getContext('2d');
  pen.scale(ratio, ratio);
  const thumb = 8;  // CSS pixels, half its width
  const x = (t) => thumb + ((t - player.start) / (player.end - player.start || 1)) * (width - 2 * thumb);
  pen.fillStyle = colour('--stick');
  for (const {phases} of wheels)
    for (const [a, b] of phases.sticks) pen.fillRect(x(a), 0, Math.max(1, x(b) - x(a)), height);
}

export function setUpTransport(player) {
  const [button, slider, clock, speed] = ['#play', '#time', '#clock', '#speed'].map($);
  speed.innerHTML = SPEEDS.map((value) => `<option value="${value}">${value} ×</option>`).join('');
  button.addEventListener('click', () => player.toggle());
  slider.addEventListener('input', () => player.seek(Number(slider.value)));
  speed.addEventListener('change', () => player.setSpeed(Number(speed.value)));
  const time = () => {
    [slider.min, slider.max, slider.value] = [player.start, player.end, player.t];
    slider.setAttribute('aria-valuetext', `${player.t.toFixed(2)} seconds`);
    clock.textContent = `${player.t.toFixed(2)} s`;
  };
  const state = () => {
    button.dataset.playing = player.playing;
    button.setAttribute('aria-label', player.playing ? 'Pause' : 'Play');
    speed.value = player.speed;
  };
  player.addEventListener('time', time);
  player.addEventListener('state', state);
  time();
  state();
}

/**
 * The page's keys; `actions` adds {key: function}. Fields keep their own, and arrow keys turn the scene if it has the
 * focus.
 */
function setUpKeys(player, actions) {
  const step = (event) => (event.shiftKey ? 0.5 : 0.05) * (event.key === 'ArrowLeft' ? -1 : 1);
  // A button that was clicked does not keep the focus: the space bar plays, and does not click it again.
  addEventListener('click', ({detail, target}) => {
    if (detail > 0) target.closest?.('button, summary, label')?.blur();
    if (detail > 0 && document.activeElement?.matches('input[type=checkbox]')) document.activeElement.blur();
  });
  addEventListener('change', ({target}) => target.matches('select') && target.blur());
  addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const target = event.target;
    const field = target.matches?.('input, select, summary, textarea, canvas');
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (key === ' ' && !target.matches?.('button, select, summary, input[type=checkbox]'))
      player.toggle();
    else if (!field && (key === 'ArrowLeft' || key === 'ArrowRight'))
      player.seek(player.t + step(event));
    else if (!field && (key === 'Home' || key === 'End'))
      player.seek(key === 'Home' ? player.start : player.end);
    else if (key === '+' || key === '-')
      player.shift(key === '+' ? 1 : -1);
    else if (key in actions)
      actions[key]();
    else
      return;
    event.preventDefault();
  });
}

/**
 * What is shown in the scene, from the boxes of page.html, and the keys; returns {show: {name: on}, flip(name, on)}.
 */
export function setUpSwitches(page) {
  const boxes = Object.fromEntries([...document.querySelectorAll('#toggles input')].map((box) => [box.name, box]));
  const show = Object.fromEntries(Object.entries(boxes).map(([name, box]) => [name, box.checked]));
  const flip = (name, on) => {
    boxes[name].checked = show[name] = on;
    page.stage.dirty = true;
  };
  for (const [name, box] of Object.entries(boxes)) box.addEventListener('change', () => flip(name, box.checked));
  const toggle = (name) => () => flip(name, !show[name]);
  const actions = {f: toggle('follow'), p: toggle('path'), a: toggle('axes'), g: toggle('force')};
  actions.r = () => page.stage.home();
  actions.d = () => page.plots.portrait.next();
  actions.n = () => page.live?.panel.story.move(1);
  actions.b = () => page.live?.panel.story.move(-1);
  for (let i = 0; i < 9; ++i) actions[i + 1] = () => i < page.choices.length && page.choose(i);
  setUpKeys(page.player, actions);
  return {show, flip};
}
