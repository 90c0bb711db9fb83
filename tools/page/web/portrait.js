// A diagram of one quantity over another, one of several, chosen by a button: the phase portrait, the angular velocity
// along the carrier axes e2 and e3, the path of the contact point from above. Angles in degrees, all else SI.
import {bounds, drawColumns, drawLevels, extent, fit, MARGIN, penOf, symbolOf, widened} from '#axes';
import {contactOf} from '#table';
import {colour} from '#theme';

const DEGREES = 180 / Math.PI;
/** point: from a row {name: value} and the wheel to [x, y]; even: both axes have one scale. */
export const PORTRAITS = [
  {
    name: 'phase',
    x: 'θ',
    y: 'θ̇',
    units: ['°', '°/s'],
    what: 'Phase portrait: the rate of the tilt over the tilt. Without friction one closed curve',
    columns: ['theta', 'theta_dot'],
    point: ({theta, theta_dot}) => [theta * DEGREES, theta_dot * DEGREES],
  },
  {
    name: 'spin',
    x: 'ω_2',
    y: 'ω_3',
    units: ['rad/s', 'rad/s'],
    what: 'Angular velocity about the axle over that about e2, which points up in the plane of the wheel. ' +
        'Without friction one curve, run to and fro',
    columns: ['theta', 'psi_dot', 'omega_z'],
    point: ({theta, psi_dot, omega_z}) => [psi_dot * Math.sin(theta), omega_z],
  },
  {
    name: 'path',
    x: 'X',
    y: 'Y',
    units: ['m', 'm'],
    even: true,
    what: 'Path of the contact point on the ground, from above',
    columns: ['X_O', 'Y_O', 'psi', 'theta'],
    point: ({X_O, Y_O, psi, theta}, {r_0}) => contactOf(r_0, X_O, Y_O, psi, theta),
  },
];

export class Portrait {
  constructor(host, player) {
    Object.assign(this, {player, kind: PORTRAITS[0], wheels: [], layer: document.createElement('canvas')});
    this.past = document.createElement('canvas');
    this.figure = document.createElement('figure');
    this.figure.className = 'plot portrait';
    this.figure.innerHTML = '<figcaption><span class="segments" role="radiogroup" aria-label="Diagram"></span>' +
        '<span class="unit"></span></figcaption><canvas role="img"></canvas>';
    host.append(this.figure);
    this.canvas = this.figure.querySelector('canvas');
    for (const kind of PORTRAITS) {
      const button = document.createElement('button');
      Object.assign(button, {type: 'button', innerHTML: symbolOf(`${kind.y} (${kind.x})`), title: kind.what});
      if (kind.even) button.textContent = 'path';
      button.setAttribute('role', 'radio');
      button.dataset.name = kind.name;
      button.addEventListener('click', () => this.choose(kind.name));
      this.figure.querySelector('.segments').append(button);
    }
  }

  /** Shows the portrait of this name, or the first that the wheels' columns allow. */
  choose(name, axis = 'fitted') {
    const possible = PORTRAITS.filter((kind) => this.all.some(({table}) => kind.columns.every((c) => table.has(c))));
    this.kind = possible.find((kind) => kind.name === name) ?? possible[0];
    this.figure.hidden = !this.kind;
    if (!this.kind) return;
    this.title = this.kind.even ? 'path [m]' : `${this.kind.y} (${this.kind.x})`;
    for (const button of this.figure.querySelectorAll('button')) {
      button.hidden = !possible.some((kind) => kind.name === button.dataset.name);
      button.setAttribute('aria-checked', button.dataset.name === this.kind.name);
    }
    this.figure.querySelector('.unit').textContent =
        this.kind.units[0] === this.kind.units[1] ? this.kind.units[0] : '';
    this.canvas.title = this.kind.what;
    this.canvas.setAttribute('aria-label', this.kind.what);
    this.wheels = this.all.filter(({table}) => this.kind.columns.every((column) => table.has(column)));
    this.prepare(axis);
    this.draw(this.player.t);
  }

  /** The next portrait that there is. */
  next() {
    const names = [...this.figure.querySelectorAll('button:not([hidden])')].map((button) => button.dataset.name);
    this.choose(names[(names.indexOf(this.kind?.name) + 1) % names.length]);
  }

  take(wheels, axis) {
    this.all = wheels;
    this.choose(this.kind?.name, axis);
  }

  /** One wheel's point of row i. */
  at(wheel, i) {
    const row = Object.fromEntries(this.kind.columns.map((name) => [name, wheel.table.columns[name][i]]));
    return this.kind.point(row, wheel);
  }

  prepare(axis) {
    if (this.figure.hidden || !this.canvas.clientWidth) return;
    Object.assign(this, fit(this.canvas, [this.canvas, this.layer, this.past]));
    this.paper = colour('--paper');
    this.points = this.wheels.map((wheel) => Array.from({length: wheel.table.rows}, (_, i) => this.at(wheel, i)));
    this.range(axis);
    const pen = penOf(this.layer, this.ratio);
    drawLevels(pen, this.ranges[1], (value) => this.y(value), this);
    drawColumns(pen, this.ranges[0], (value) => this.x(value), this, '', true);
    this.clip(pen);
    pen.globalAlpha = 0.35;
    this.wheels.forEach((_, k) => this.line(pen, k, 0, this.points[k].length - 1));
    this.drawn = this.wheels.map(() => 0);
  }

  range(axis) {
    const until = (k) => (axis === 'held' ? this.wheels[k].table.row(this.player.t) + 1 : Infinity);
    const points = this.points.flatMap((list, k) => list.slice(0, until(k)));
    const before = axis !== 'fitted' && this.ranges;
    this.ranges = [0, 1].map((axis) => {
      const [low, high] = extent(points.map((point) => point[axis]));
      return before ? widened(before[axis], low, high) : bounds(low, high);
    });
    if (!this.kind.even) return;
    const sizes = [this.width - MARGIN.left - MARGIN.right, this.height - MARGIN.top - MARGIN.bottom];
    const scale = Math.max(...this.ranges.map(([low, high], i) => (high - low) / sizes[i]));
    this.ranges = this.ranges.map(([low, high], i) => {
      const missing = scale * sizes[i] - (high - low);
      const narrow = missing > 1e-9 * (high - low);  // what only rounding takes away is no reason to move a limit
      return narrow ? [low - missing / 2, high + missing / 2] : [low, high];
    });
  }

  x(value) {
    const [low, high] = this.ranges[0];
    return MARGIN.left + ((value - low) / (high - low)) * (this.width - MARGIN.left - MARGIN.right);
  }

  y(value) {
    const [low, high] = this.ranges[1];
    return MARGIN.top + ((high - value) / (high - low)) * (this.height - MARGIN.top - MARGIN.bottom);
  }

  clip(pen) {
    const [width, height] = [this.width - MARGIN.left - MARGIN.right, this.height - MARGIN.top - MARGIN.bottom];
    pen.beginPath();
    pen.rect(MARGIN.left, MARGIN.top - 2, width + MARGIN.right, height + 4);
    pen.clip();
  }

  /** The line of wheel k through its rows from..to. */
  line(pen, k, from, to) {
    pen.lineWidth = 1.6;
    pen.lineJoin = 'round';
    pen.strokeStyle = this.wheels[k].colour;
    pen.beginPath();
    for (let i = from; i <= to; ++i) pen.lineTo(this.x(this.points[k][i][0]), this.y(this.points[k][i][1]));
    pen.stroke();
  }

  /** Carries the strong lines on to t, or begins them anew where the reader has gone back. */
  follow(t) {
    const rows = this.wheels.map(({table}) => table.row(Math.min(t, table.end)) + Number(t >= table.end));
    const pen = penOf(this.past, this.ratio);
    if (rows.some((row, k) => row < this.drawn[k])) {
      pen.clearRect(0, 0, this.width, this.height);
      this.drawn.fill(0);
    }
    pen.save();
    this.clip(pen);
    rows.forEach((row, k) => row > this.drawn[k] && this.line(pen, k, this.drawn[k], row));
    pen.restore();
    this.drawn = rows;
  }

  draw(t) {
    if (this.figure.hidden || !this.points || !this.width) return;
    this.follow(t);
    const pen = this.canvas.getContext('2d');
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.clearRect(0, 0, this.canvas.width, this.canvas.height);
    pen.drawImage(this.layer, 0, 0);
    pen.drawImage(this.past, 0, 0);
    pen.scale(this.ratio, this.ratio);
    for (const wheel of this.wheels) {
      const now = Math.min(t, wheel.table.end);
      const row = Object.fromEntries(this.kind.columns.map((name) => [name, wheel.table.value(name, now)]));
      const [x, y] = this.kind.point(row, wheel);
      pen.fillStyle = wheel.colour;
      pen.beginPath();
      pen.arc(this.x(x), this.y(y), 3.6, 0, 7);
      pen.fill();
      pen.strokeStyle = this.paper;
      pen.stroke();
    }
  }
}
