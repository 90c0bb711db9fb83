// A diagram over time: every wheel a curve, stick phases shaded, transitions as ticks at the top, and a cursor at the
// present. What is still to come is drawn faintly. Angles in degrees, all else SI.
import {bounds, drawColumns, drawLevels, extent, fit, MARGIN, penOf, symbolOf, widened} from '#axes';
import {colour} from '#theme';

const DEGREES = 180 / Math.PI;
export const SIGNALS = [
  {column: 'theta', symbol: 'θ', unit: '°', scale: DEGREES, digits: 1, what: 'tilt: angle between axle and vertical'},
  {column: 'omega_z', symbol: 'ω_z', unit: 'rad/s', scale: 1, digits: 3, what: 'angular velocity about the axle'},
  {column: 'lambda_3', symbol: 'N', unit: 'N', scale: 1, digits: 0, what: 'normal force of the ground'},
  {column: 'E', symbol: 'E', unit: 'J', scale: 1, digits: 2, what: 'total energy'},
];

export class Curve {
  constructor(signal, host, player) {
    this.signal = signal;
    this.title = `${signal.symbol} [${signal.unit}]`;
    this.player = player;
    const figure = document.createElement('figure');
    figure.className = 'plot';
    figure.innerHTML = `<figcaption><b><i>${symbolOf(signal.symbol)}</i></b> <span class="unit">${signal.unit}</span>` +
        `<output></output></figcaption><canvas role="img" aria-label="${signal.what} over time" title="${
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

  /** Draws both layers anew. axis: 'fitted', 'kept' (only widened) or 'held' (widened only for what is past). */
  prepare(axis) {
    if (this.figure.hidden || !this.canvas.clientWidth) return;
    Object.assign(this, fit(this.canvas, [this.canvas, this.layers.faint, this.layers.strong]));
    this.ink = colour('--ink');
    this.range(axis);
    for (const [kind, canvas] of Object.entries(this.layers)) {
      const pen = penOf(canvas, this.ratio);
      this.bands(pen, kind === 'strong' ? 0.34 : 0.16);
      if (kind === 'faint') {
        drawLevels(pen, [this.low, this.high], (value) => this.y(value), this);
        drawColumns(pen, [this.player.start, this.player.end], (t) => this.x(t), this, 's');
      }
      this.curves(pen, kind === 'strong' ? 1 : 0.35);
    }
  }

  range(axis) {
    const {column, scale} = this.signal;
    const rows = ({table}) => (axis === 'held' ? table.row(this.player.t) + 1 : table.rows);
    const [low, high] =
        extent(this.wheels.flatMap((wheel) => extent(wheel.table.columns[column].subarray(0, rows(wheel)))))
            .map((value) => value * scale);
    const before = axis !== 'fitted' && this.high !== undefined;
    [this.low, this.high] = before ? widened([this.low, this.high], low, high) : bounds(low, high);
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
    pen.save();
    pen.beginPath();
    pen.rect(MARGIN.left, MARGIN.top - 2, this.width, this.height - MARGIN.top - MARGIN.bottom + 4);
    pen.clip();
    pen.globalAlpha = strength;
    pen.lineWidth = 1.6;
    pen.lineJoin = 'round';
    for (const {table, colour: paint, ended} of this.wheels) {
      const values = table.columns[column];
      pen.strokeStyle = paint;
      pen.beginPath();
      for (let i = 0; i < table.rows; ++i) pen.lineTo(this.x(table.time[i]), this.y(values[i] * scale));
      pen.stroke();
      if (ended) this.cross(pen, this.x(table.end), this.y(values[table.rows - 1] * scale));
    }
    pen.restore();
  }

  /** Marks the point at which the wheel's motion ended. */
  cross(pen, x, y) {
    pen.beginPath();
    for (const side of [-1, 1]) {
      pen.moveTo(x - 4, y - 4 * side);
      pen.lineTo(x + 4, y + 4 * side);
    }
    pen.stroke();
  }

  /** Whether what is shown at t has left the frame. */
  leaves(t) {
    return !this.figure.hidden && this.wheels.some(({table}) => {
      const value = table.value(this.signal.column, Math.min(t, table.end)) * this.signal.scale;
      return value < this.low || value > this.high;
    });
  }

  /** The picture at t. */
  draw(t) {
    if (this.figure.hidden || !this.width) return;
    const x = this.x(t);
    const pen = this.canvas.getContext('2d');
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.clearRect(0, 0, this.canvas.width, this.canvas.height);
    pen.drawImage(this.layers.faint, 0, 0);
    const done = Math.max(1, Math.round(x * this.ratio));
    pen.drawImage(this.layers.strong, 0, 0, done, this.canvas.height, 0, 0, done, this.canvas.height);
    pen.scale(this.ratio, this.ratio);
    pen.fillStyle = this.ink;
    pen.fillRect(x - 0.5, MARGIN.top - 4, 1, this.height - MARGIN.top - MARGIN.bottom + 4);
    this.show(this.wheels.map((wheel) => this.point(pen, wheel, t)));
  }

  /** Marks one wheel's present value; returns it. */
  point(pen, {table, colour: paint}, t) {
    const value = table.value(this.signal.column, Math.min(t, table.end)) * this.signal.scale;
    pen.fillStyle = paint;
    pen.beginPath();
    pen.arc(this.x(Math.min(t, table.end)), this.y(value), 3.6, 0, 7);
    pen.fill();
    return value;
  }

  /** The values as numbers in the caption; of more than three wheels shorter and smaller, to fit beside each other. */
  show(values) {
    const many = values.length > 3;
    const digits = Math.max(0, this.signal.digits - Number(many));
    this.values.classList.toggle('many', many);
    while (this.values.children.length > values.length) this.values.lastChild.remove();
    while (this.values.children.length < values.length) this.values.append(document.createElement('span'));
    values.forEach((value, i) => {
      const place = this.values.children[i];
      place.style.color = this.wheels[i].colour;
      place.textContent = value.toFixed(digits).replace('-', '−');
    });
  }
}
