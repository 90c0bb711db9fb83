// All diagrams: the curves over time, and beside them one portrait, chosen by its buttons: the phase portrait, the
// angular velocity along the carrier axes e2 and e3, or the path of the contact point from above. They share the clock,
// and keep their axes while the reader pushes the wheel. The future is drawn faintly. Angles in degrees, all else SI.
import {before, contactOf} from '#table';
import {colour} from '#theme';

const DEGREES = 180 / Math.PI;
const MARGIN = {
  left: 46,
  right: 8,
  top: 10,
  bottom: 20
};

/** A kind of diagram over time. */
const curve = (column, symbol, unit, digits, what, scale = 1) => ({
  name: column,
  symbol,
  units: ['s', unit],
  digits,
  columns: [column],
  what: `${what} over time. Click or drag to go there`,
  point: (value) => [value('time'), scale * value(column)],
});
const CURVES = [
  curve('theta', 'θ', '°', 1, 'Tilt: angle between axle and vertical', DEGREES),
  curve('omega_z', 'ω_z', 'rad/s', 3, 'Angular velocity about the axle'),
  curve('lambda_3', 'N', 'N', 0, 'Normal force of the ground'),
  curve('E', 'E', 'J', 2, 'Total energy'),
];
/** point: from value(name) and the wheel to [x, y]; even: both axes have one scale. */
export const PORTRAITS = [
  {
    name: 'phase',
    symbol: 'θ̇ (θ)',
    units: ['°', '°/s'],
    columns: ['theta', 'theta_dot'],
    what: 'Phase portrait: the rate of the tilt over the tilt. Without friction one closed curve',
    point: (value) => [value('theta') * DEGREES, value('theta_dot') * DEGREES],
  },
  {
    name: 'spin',
    symbol: 'ω_3 (ω_2)',
    units: ['rad/s', 'rad/s'],
    columns: ['theta', 'psi_dot', 'omega_z'],
    what: 'Angular velocity about the axle over that about e2, which points up in the plane of the wheel. ' +
        'Without friction one curve, run to and fro',
    point: (value) => [value('psi_dot') * Math.sin(value('theta')), value('omega_z')],
  },
  {
    name: 'path',
    symbol: 'path',
    units: ['m', 'm'],
    columns: ['X_O', 'Y_O', 'psi', 'theta'],
    even: true,
    what: 'Path of the contact point on the ground, from above',
    point: (value, {r_0}) => contactOf(r_0, ...['X_O', 'Y_O', 'psi', 'theta'].map(value)),
  },
];

/** Round numbers, at most about `count` of them, that span low to high. */
function ticksOf([low, high], count) {
  const raw = (high - low) / Math.max(1, count);
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((size) => size >= raw) ?? 10 * power;
  const first = Math.ceil(low / step - 1e-9);
  const ticks = Array.from({length: Math.floor(high / step + 1e-9) - first + 1}, (_, i) => (first + i) * step);
  return {ticks, digits: Math.max(0, -Math.floor(Math.log10(step) + 1e-9))};
}

/** The smallest and the largest of some values, or [Infinity, -Infinity]. */
export function extent(values) {
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) {
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return [low, high];
}

/** The bounds of an axis that shows low to high; a quantity that hardly changes is a line, not its last digit. */
function bounds(low, high) {
  if (!(low <= high)) return [0, 1];
  const least = 1e-3 * Math.max(1, Math.abs(low), Math.abs(high));
  const pad = 0.06 * Math.max(high - low, least) + 0.5 * Math.max(0, least - (high - low));
  return [low - pad, high + pad];
}

/**
 * Bounds that hold low to high and change as seldom as possible: those before, where they are wide enough, else widened
 * by a quarter of their span beyond what is asked for.
 */
function widened([before, after], low, high) {
  const reserve = 0.25 * (Math.max(high, after) - Math.min(low, before));
  return [low < before ? low - reserve : before, high > after ? high + reserve : after];
}

/** A symbol such as ω_z in HTML. */
const symbolOf = (text) => text.replace(/_(.)/g, '<sub>$1</sub>');

class Diagram {
  /** kinds: what can be shown, of CURVES or PORTRAITS. */
  constructor(host, player, kinds) {
    Object.assign(this, {player, kinds, kind: kinds[0], wheels: [], faint: document.createElement('canvas')});
    this.strong = document.createElement('canvas');
    this.figure = document.createElement('figure');
    this.figure.className = kinds.length > 1 ? 'plot portrait' : 'plot';
    this.figure.innerHTML =
        '<figcaption><span class="unit"></span><output></output></figcaption><canvas role="img"></canvas>';
    host.append(this.figure);
    this.canvas = this.figure.querySelector('canvas');
    this.values = this.figure.querySelector('output');
    this.figure.firstChild.prepend(kinds.length > 1 ? this.buttons() : this.name());
    if (!this.timed) return;
    const seek = ({buttons, offsetX}) => buttons && player.seek(this.timeAt(offsetX));
    this.canvas.addEventListener('pointermove', seek);
    this.canvas.addEventListener('pointerdown', (event) => {
      this.canvas.setPointerCapture(event.pointerId);
      seek(event);
    });
  }

  /** Whether the horizontal axis is that of time. */
  get timed() { return this.kind.units[0] === 's'; }

  get title() {
    return this.kind.even ? 'path [m]' : this.timed ? `${this.kind.symbol} [${this.kind.units[1]}]` : this.kind.symbol;
  }

  name() {
    const name = document.createElement('b');
    name.innerHTML = `<i>${symbolOf(this.kind.symbol)}</i>`;
    return name;
  }

  buttons() {
    const row = document.createElement('span');
    row.className = 'segments';
    row.setAttribute('role', 'radiogroup');
    row.setAttribute('aria-label', 'Diagram');
    for (const {name, symbol, what} of this.kinds) {
      const button = document.createElement('button');
      Object.assign(button, {type: 'button', innerHTML: symbolOf(symbol), title: what});
      button.setAttribute('role', 'radio');
      button.dataset.name = name;
      button.addEventListener('click', () => this.choose(name));
      row.append(button);
    }
    return row;
  }

  /** Takes the wheels to show. */
  take(wheels) {
    this.all = wheels;
    this.select(this.kind?.name);
  }

  /** The kind of this name, or the first that the wheels' columns allow; without any the diagram hides. */
  select(name) {
    const shows = ({columns}, {table}) => columns.every((column) => table.has(column));
    const possible = this.kinds.filter((kind) => this.all.some((wheel) => shows(kind, wheel)));
    this.figure.hidden = !possible.length;
    this.kind = possible.find((kind) => kind.name === name) ?? possible[0] ?? this.kinds[0];
    this.wheels = this.all.filter((wheel) => shows(this.kind, wheel));
    for (const button of this.figure.querySelectorAll('button')) {
      button.hidden = !possible.some((kind) => kind.name === button.dataset.name);
      button.setAttribute('aria-checked', button.dataset.name === this.kind.name);
    }
    const [across, up] = this.kind.units;
    this.figure.querySelector('.unit').textContent = this.timed || across === up ? up : '';
    this.canvas.title = this.kind.what;
    this.canvas.setAttribute('aria-label', this.kind.what);
  }

  choose(name) {
    this.select(name);
    this.prepare('fitted');
    this.draw(this.player.t);
  }

  /** The next kind that there is. */
  next() {
    const names = [...this.figure.querySelectorAll('button:not([hidden])')].map((button) => button.dataset.name);
    this.choose(names[(names.indexOf(this.kind.name) + 1) % names.length]);
  }

  /** A wheel's point at t. */
  at(wheel, t) { return this.kind.point((name) => wheel.table.value(name, t), wheel); }

  /** All points of a wheel with their instants {times, points}: its rows, or its path, which is denser. */
  line(wheel) {
    if (this.kind.even) return wheel.trace;
    const {columns, time, rows} = wheel.table;
    const row = (i) => this.kind.point((name) => columns[name][i], wheel);
    return {times: time, points: Array.from({length: rows}, (_, i) => row(i))};
  }

  /** Draws the faint layer anew. axis: 'fitted', 'kept' (only widened) or 'held' (widened only for what is past). */
  prepare(axis) {
    const {clientWidth: width, clientHeight: height} = this.canvas;
    if (this.figure.hidden || !width) return;
    const ratio = Math.min(2, devicePixelRatio);
    Object.assign(this, {width, height, ratio, ink: colour('--ink'), paper: colour('--paper')});
    for (const canvas of [this.canvas, this.faint, this.strong])
      [canvas.width, canvas.height] = [width * ratio, height * ratio];
    this.lines = this.wheels.map((wheel) => this.line(wheel));
    this.range(axis);
    const pen = this.pen(this.faint);
    this.grid(pen);
    this.clip(pen);
    this.bands(pen, 0.16, -Infinity, Infinity);
    pen.globalAlpha = 0.35;
    this.lines.forEach(({points}, k) => this.stroke(pen, k, 0, points.length - 1));
    this.drawn = this.wheels.map(() => 0);
    this.until = -Infinity;
  }

  /** A pen in CSS pixels. */
  pen(canvas) {
    const pen = canvas.getContext('2d');
    pen.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    return pen;
  }

  range(axis) {
    const {start, end, t} = this.player;
    const seen = ({times, points}) => (axis === 'held' ? points.filter((_, i) => times[i] <= t) : points);
    const points = this.lines.flatMap(seen);
    const kept = axis !== 'fitted' && this.ranged === this.kind && this.ranges;
    this.ranged = this.kind;
    this.ranges = [0, 1].map((side) => {
      if (this.timed && side === 0) return [start, end > start ? end : start + 1];
      const [low, high] = extent(points.map((point) => point[side]));
      return kept ? widened(kept[side], low, high) : bounds(low, high);
    });
    if (!this.kind.even) return;
    const scale = Math.max(...this.ranges.map(([low, high], i) => (high - low) / this.sizes[i]));
    this.ranges = this.ranges.map(([low, high], i) => {
      const missing = scale * this.sizes[i] - (high - low);
      const narrow = missing > 1e-9 * (high - low);  // rounding alone is no reason to move a limit
      return narrow ? [low - missing / 2, high + missing / 2] : [low, high];
    });
  }

  /** Width and height within the margins. */
  get sizes() { return [this.width - MARGIN.left - MARGIN.right, this.height - MARGIN.top - MARGIN.bottom]; }

  x(value) {
    const [low, high] = this.ranges[0];
    return MARGIN.left + ((value - low) / (high - low)) * this.sizes[0];
  }

  y(value) {
    const [low, high] = this.ranges[1];
    return MARGIN.top + ((high - value) / (high - low)) * this.sizes[1];
  }

  timeAt(x) {
    const {start, end} = this.player;
    return start + ((x - MARGIN.left) / (this.canvas.clientWidth - MARGIN.left - MARGIN.right)) * (end - start);
  }

  /** Lines and numbers of both axes; over time the last number has the unit, and there are no lines across. */
  grid(pen) {
    Object.assign(
        pen,
        {font: '11px system-ui, sans-serif', lineWidth: 1, strokeStyle: colour('--rule'), fillStyle: colour('--soft')});
    const [across, up] =
        [ticksOf(this.ranges[0], Math.min(6, this.width / 48)), ticksOf(this.ranges[1], Math.min(5, this.height / 26))];
    pen.beginPath();
    Object.assign(pen, {textAlign: 'right', textBaseline: 'middle'});
    for (const tick of up.ticks) {
      const level = Math.round(this.y(tick)) + 0.5;
      pen.moveTo(MARGIN.left, level);
      pen.lineTo(this.width - MARGIN.right, level);
      pen.fillText(tick.toFixed(up.digits), MARGIN.left - 6, level);
    }
    Object.assign(pen, {textAlign: 'center', textBaseline: 'top'});
    for (const tick of across.ticks) {
      const unit = this.timed && tick === across.ticks.at(-1) ? ' s' : '';
      const line = Math.round(this.x(tick)) + 0.5;
      pen.fillText(tick.toFixed(across.digits) + unit, Math.min(this.x(tick), this.width - 14), this.height - 15);
      if (this.timed) continue;
      pen.moveTo(line, MARGIN.top);
      pen.lineTo(line, this.height - MARGIN.bottom);
    }
    pen.stroke();
  }

  clip(pen) {
    pen.beginPath();
    pen.rect(MARGIN.left, 0, this.sizes[0] + MARGIN.right, this.height - MARGIN.bottom + 2);
    pen.clip();
  }

  /** Over time: stick phases as bands, transitions as ticks at the top, of the instants from..to. */
  bands(pen, strength, from, to) {
    if (!this.timed) return;
    for (const {phases} of this.wheels) {
      pen.globalAlpha = strength;
      pen.fillStyle = colour('--stick');
      for (const [begin, end] of phases.sticks) {
        const [a, b] =
            [Math.max(begin, from), Math.min(end, to)].map((t) => Math.round(this.x(t) * this.ratio) / this.ratio);
        if (b > a) pen.fillRect(a, MARGIN.top, b - a, this.sizes[1]);
      }
      pen.globalAlpha = Math.min(1, 2.4 * strength);
      pen.fillStyle = colour('--force');
      for (const t of phases.transitions)
        if (from < t && t <= to) pen.fillRect(this.x(t) - 0.5, MARGIN.top - 7, 1, 7);
    }
    pen.globalAlpha = 1;
  }

  /** The line of wheel k through its points from..to, with a cross where its motion ended. */
  stroke(pen, k, from, to) {
    const {points} = this.lines[k];
    Object.assign(pen, {lineWidth: 1.6, lineJoin: 'round', strokeStyle: this.wheels[k].colour});
    pen.beginPath();
    for (let i = from; i <= to; ++i) pen.lineTo(this.x(points[i][0]), this.y(points[i][1]));
    if (this.timed && this.wheels[k].ended && to === points.length - 1) {
      const [x, y] = [this.x(points[to][0]), this.y(points[to][1])];
      for (const side of [-1, 1]) {
        pen.moveTo(x - 4, y - 4 * side);
        pen.lineTo(x + 4, y + 4 * side);
      }
    }
    pen.stroke();
  }

  /** Whether what is shown at t has left the frame. */
  leaves(t) {
    const [low, high] = this.ranges?.[1] ?? [];
    return !this.figure.hidden && this.wheels.some((wheel) => {
      const [, value] = this.at(wheel, Math.min(t, wheel.table.end));
      return value < low || value > high;
    });
  }

  /** Carries the strong lines on to t, or begins them anew where the reader has gone back. */
  follow(t) {
    const pen = this.pen(this.strong);
    if (t < this.until) {
      pen.clearRect(0, 0, this.width, this.height);
      this.drawn.fill(0);
      this.until = -Infinity;
    }
    pen.save();
    this.clip(pen);
    this.bands(pen, 0.34, this.until, t);
    this.lines.forEach(({times}, k) => {
      const last = before(times, t);
      if (last > this.drawn[k]) this.stroke(pen, k, this.drawn[k], last);
      this.drawn[k] = Math.max(0, last);
    });
    pen.restore();
    this.until = t;
  }

  /** The picture at t. */
  draw(t) {
    if (this.figure.hidden || !this.width) return;
    this.follow(t);
    const pen = this.pen(this.canvas);
    pen.clearRect(0, 0, this.width, this.height);
    for (const layer of [this.faint, this.strong]) pen.drawImage(layer, 0, 0, this.width, this.height);
    pen.fillStyle = this.ink;
    if (this.timed) pen.fillRect(this.x(t) - 0.5, MARGIN.top - 4, 1, this.sizes[1] + 4);
    const present = this.wheels.map((wheel) => this.at(wheel, Math.min(t, wheel.table.end)));
    present.forEach(([x, y], k) => {
      Object.assign(pen, {fillStyle: this.wheels[k].colour, strokeStyle: this.paper});
      pen.beginPath();
      pen.arc(this.x(x), this.y(y), 3.6, 0, 7);
      pen.fill();
      pen.stroke();
    });
    if (this.timed) this.show(present.map(([, value]) => value));
  }

  /** The values as numbers in the caption; of more than three wheels shorter and smaller, to fit beside each other. */
  show(values) {
    const many = values.length > 3;
    const size = Math.max(...this.ranges[1].map(Math.abs));  // what is small has more digits
    const digits =
        Math.max(0, this.kind.digits - Number(many), size < 1 ? Math.min(8, Math.ceil(2 - Math.log10(size))) : 0);
    this.values.classList.toggle('many', many);
    while (this.values.children.length > values.length) this.values.lastChild.remove();
    while (this.values.children.length < values.length) this.values.append(document.createElement('span'));
    values.forEach((value, i) => {
      const place = this.values.children[i];
      place.style.color = this.wheels[i].colour;
      place.textContent = value.toFixed(digits).replace(/^-([0.]+)$/, '$1').replace('-', '−');
    });
  }
}

export class Plots {
  constructor(host, player) {
    Object.assign(this, {player, wheels: [], axis: 'fitted'});
    this.curves = CURVES.map((kind) => new Diagram(host, player, [kind]));
    this.portrait = new Diagram(host, player, PORTRAITS);
    this.all = [...this.curves, this.portrait];
    new ResizeObserver(() => this.prepare(this.axis)).observe(host);
  }

  /** wheels: [{table, phases, trace, colour}], those that are shown. */
  show(wheels) {
    for (const diagram of this.all) diagram.take(wheels);  // all of them first: they share the width
    this.prepare(this.axis);
  }

  prepare(axis) {
    for (const diagram of this.all) diagram.prepare(axis);
    this.draw(this.player.t);
  }

  draw(t) {
    if (this.axis === 'held' && this.all.some((diagram) => diagram.leaves(t)))
      for (const diagram of this.all) diagram.prepare('held');
    for (const diagram of this.all) diagram.draw(t);
  }
}
