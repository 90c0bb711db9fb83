// The diagrams over time: one canvas each, every wheel a curve, stick phases shaded, transitions as ticks at the top,
// and a cursor at the present. What is still to come is drawn faintly. Angles in degrees, all else SI.
import {colour} from '#theme';

const DEGREES = 180 / Math.PI;
export const SIGNALS = [
  {column: 'theta', symbol: 'θ', unit: '°', scale: DEGREES, digits: 1, what: 'tilt: angle between axle and vertical'},
  {column: 'omega_z', symbol: 'ω_z', unit: 'rad/s', scale: 1, digits: 3, what: 'angular velocity about the axle'},
  {column: 'lambda_3', symbol: 'N', unit: 'N', scale: 1, digits: 0, what: 'normal force of the ground'},
  {column: 'E', symbol: 'E', unit: 'J', scale: 1, digits: 2, what: 'total energy'},
];
const MARGIN = {
  left: 46,
  right: 8,
  top: 10,
  bottom: 20
};

/** Round numbers, at most about `count` of them, that span low to high. */
export function ticksOf(low, high, count) {
  const raw = (high - low) / Math.max(1, count);
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((size) => size >= raw) ?? 10 * power;
  const ticks = [];
  for (let tick = Math.ceil(low / step - 1e-9) * step; tick <= high + 1e-9 * step; tick += step) ticks.push(tick);
  return {ticks, digits: Math.max(0, -Math.floor(Math.log10(step) + 1e-9))};
}

class Plot {
  constructor(signal, host, player) {
    this.signal = signal;
    this.player = player;
    const figure = document.createElement('figure');
    figure.className = 'plot';
    const name = signal.symbol.replace(/_(.)/, '<sub>$1</sub>');
    figure.innerHTML =
        `<figcaption><b><i>${name}</i></b> <span class="unit">${signal.unit}</span><output></output></figcaption>` +
        `<canvas role="img" aria-label="${signal.what} over time" title="${
            signal.what}. Click or drag to go there"></canvas>`;
    host.append(figure);
    this.figure = figure;
    this.canvas = figure.querySelector('canvas');
    this.values = figure.querySelector('output');
    this.layers = {faint: document.createElement('canvas'), strong: document.createElement('canvas')};
    const seek = (event) => event.buttons && player.seek(this.timeAt(event.offsetX));
    this.canvas.addEventListener('pointerdown', (event) => {
      this.canvas.setPointerCapture(event.pointerId);
      seek(event);
    });
    this.canvas.addEventListener('pointermove', seek);
  }

  timeAt(x) {
    const {start, end} = this.player;
    const share = (x - MARGIN.left) / (this.canvas.clientWidth - MARGIN.left - MARGIN.right);
    return start + share * (end - start);
  }

  x(t) {
    const {start, end} = this.player;
    return MARGIN.left + ((t - start) / (end - start || 1)) * (this.width - MARGIN.left - MARGIN.right);
  }

  y(value) {
    return MARGIN.top + ((this.high - value) / (this.high - this.low)) * (this.height - MARGIN.top - MARGIN.bottom);
  }

  /** Takes the wheels that have this signal; without any it hides. */
  take(wheels) {
    this.wheels = wheels.filter(({table}) => table.has(this.signal.column));
    this.figure.hidden = this.wheels.length === 0;
  }

  /** Draws both layers anew. */
  prepare() {
    const {clientWidth, clientHeight} = this.canvas;
    if (this.figure.hidden || !clientWidth) return;
    [this.width, this.height, this.ratio] = [clientWidth, clientHeight, Math.min(2, devicePixelRatio)];
    this.range();
    for (const canvas of [this.canvas, this.layers.faint, this.layers.strong]) {
      [canvas.width, canvas.height] = [this.width * this.ratio, this.height * this.ratio];
    }
    for (const [kind, canvas] of Object.entries(this.layers)) {
      const pen = canvas.getContext('2d');
      pen.scale(this.ratio, this.ratio);
      this.bands(pen, kind === 'strong' ? 0.34 : 0.16);
      if (kind === 'faint') this.frame(pen);
      this.curves(pen, kind === 'strong' ? 1 : 0.35);
    }
  }

  range() {
    let [low, high] = [Infinity, -Infinity];
    for (const {table} of this.wheels) {
      for (const value of table.columns[this.signal.column]) {
        if (value < low) low = value;
        if (value > high) high = value;
      }
    }
    [low, high] = [low * this.signal.scale, high * this.signal.scale];
    const least =
        1e-3 * Math.max(1, Math.abs(low), Math.abs(high));  // an energy that is kept is a line, not its last digit
    const pad = 0.06 * Math.max(high - low, least) + 0.5 * Math.max(0, least - (high - low));
    [this.low, this.high] = [low - pad, high + pad];
  }

  frame(pen) {
    const {ticks, digits} = ticksOf(this.low, this.high, Math.min(5, this.height / 26));
    pen.font = '11px system-ui, sans-serif';
    pen.lineWidth = 1;
    pen.strokeStyle = colour('--rule');
    pen.fillStyle = colour('--soft');
    pen.textAlign = 'right';
    pen.textBaseline = 'middle';
    for (const tick of ticks) {
      const y = Math.round(this.y(tick)) + 0.5;
      pen.beginPath();
      pen.moveTo(MARGIN.left, y);
      pen.lineTo(this.width - MARGIN.right, y);
      pen.stroke();
      pen.fillText(tick.toFixed(digits), MARGIN.left - 6, y);
    }
    pen.textAlign = 'center';
    pen.textBaseline = 'top';
    const seconds = ticksOf(this.player.start, this.player.end, Math.min(6, this.width / 48));
    for (const tick of seconds.ticks) {
      const text = tick.toFixed(seconds.digits);
      pen.fillText(
          tick === seconds.ticks.at(-1) ? `${text} s` : text, Math.min(this.x(tick), this.width - 14),
          this.height - 15);
    }
  }

  /** Stick phases as bands, transitions as ticks at the top. */
  bands(pen, strength) {
    const bottom = this.height - MARGIN.bottom;
    for (const {phases} of this.wheels) {
      pen.globalAlpha = strength;
      pen.fillStyle = colour('--stick');
      for (const [a, b] of phases.sticks)
        pen.fillRect(this.x(a), MARGIN.top, this.x(b) - this.x(a), bottom - MARGIN.top);
      pen.globalAlpha = Math.min(1, 2.4 * strength);
      pen.fillStyle = colour('--force');
      for (const t of phases.transitions) pen.fillRect(this.x(t) - 0.5, MARGIN.top - 7, 1, 7);
    }
    pen.globalAlpha = 1;
  }

  curves(pen, strength) {
    const {column, scale} = this.signal;
    pen.globalAlpha = strength;
    pen.lineWidth = 1.6;
    pen.lineJoin = 'round';
    for (const {table, colour: paint} of this.wheels) {
      const values = table.columns[column];
      pen.strokeStyle = paint;
      pen.beginPath();
      for (let i = 0; i < table.rows; ++i) pen.lineTo(this.x(table.time[i]), this.y(values[i] * scale));
      pen.stroke();
    }
    pen.globalAlpha = 1;
  }

  /** The picture at t. */
  draw(t) {
    if (this.figure.hidden || !this.width) return;
    const pen = this.canvas.getContext('2d');
    const x = this.x(t);
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.clearRect(0, 0, this.canvas.width, this.canvas.height);
    pen.drawImage(this.layers.faint, 0, 0);
    const done = Math.max(1, Math.round(x * this.ratio));
    pen.drawImage(this.layers.strong, 0, 0, done, this.canvas.height, 0, 0, done, this.canvas.height);
    pen.scale(this.ratio, this.ratio);
    pen.fillStyle = colour('--ink');
    pen.fillRect(x - 0.5, MARGIN.top - 4, 1, this.height - MARGIN.top - MARGIN.bottom + 4);
    const many = this.wheels.length > 3;  // then their values are shorter and smaller, to fit beside each other
    const digits = Math.max(0, this.signal.digits - Number(many));
    this.values.classList.toggle('many', many);
    const texts = this.wheels.map(({table, colour: paint}) => {
      const value = table.value(this.signal.column, Math.min(t, table.end)) * this.signal.scale;
      pen.fillStyle = paint;
      pen.beginPath();
      pen.arc(this.x(Math.min(t, table.end)), this.y(value), 3.6, 0, 7);
      pen.fill();
      return `<span style="color:${paint}">${value.toFixed(digits).replace('-', '−')}</span>`;
    });
    this.values.innerHTML = texts.join('');
  }
}

export class Plots {
  constructor(host, player) {
    this.plots = SIGNALS.map((signal) => new Plot(signal, host, player));
    new ResizeObserver(() => this.prepare()).observe(host);
    this.wheels = [];
    this.player = player;
  }

  /** wheels: [{table, phases, colour}], those that are shown. */
  show(wheels) {
    this.wheels = wheels;
    this.prepare();
  }

  prepare() {
    for (const plot of this.plots) plot.take(this.wheels);  // all of them first: they share the width
    for (const plot of this.plots) plot.prepare();
    this.draw(this.player.t);
  }

  draw(t) {
    for (const plot of this.plots) plot.draw(t);
  }
}
