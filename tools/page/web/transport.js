// Play, pause, speed and the time slider with the stick phases behind it; the keys of the whole page. Time in s.
import {SPEEDS} from '#player';
import {colour} from '#theme';

const $ = (selector) => document.querySelector(selector);

/** Draws stick phases and transitions behind the slider. */
export function drawBands(wheels, player) {
  const canvas = $('#bands');
  const ratio = Math.min(2, devicePixelRatio);
  const {clientWidth: width, clientHeight: height} = canvas;
  [canvas.width, canvas.height] = [width * ratio, height * ratio];
  const pen = canvas.getContext('2d');
  pen.scale(ratio, ratio);
  const x = (t) =>
      8 + ((t - player.start) / (player.end - player.start || 1)) * (width - 16);  // the thumb's half width: 8
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
export function setUpKeys(player, actions) {
  const step = (event) => (event.shiftKey ? 0.5 : 0.05) * (event.key === 'ArrowLeft' ? -1 : 1);
  addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const target = event.target;
    const field = target.matches?.('input, select, summary, textarea, canvas');
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (key === ' ' && !target.matches?.('button, select, summary, input[type=checkbox]'))
      player.toggle();
    else if (!field && (key === 'ArrowLeft' || key === 'ArrowRight'))
      player.seek(player.t + step(event));
    else if (!field && key === 'Home')
      player.seek(player.start);
    else if (!field && key === 'End')
      player.seek(player.end);
    else if (key === '+' || key === '-')
      player.shift(key === '+' ? 1 : -1);
    else if (key in actions)
      actions[key]();
    else
      return;
    event.preventDefault();
  });
}
