// All diagrams: the curves over time, and beside them one portrait, chosen by its buttons: the phase portrait, the
// angular velocity along e2 and e3, or the path of the contact point from above. They share the clock,
// and keep their axes while the reader pushes the wheel. The future is drawn faintly. Angles in degrees, all else SI.
import {CURVES, PORTRAITS} from '#curves';
import {clearCanvas, colour, fixed, make, makeChoice, subscripted, write} from '#dom';
import {before, extent} from '#table';

const [LEFT, RIGHT, TOP, BOTTOM] = [48, 8, 10, 20];  // margins, CSS pixels
const BAR = 4;                                       // CSS pixels, where held or sliding
const DASHES = [5, 4];
const KEYS = 40;  // strokes of an arrow key draw a guess from start to end
const DRAW = 'Draw how the tilt goes on: by mouse or finger, or by the arrow keys, of which the left one takes back';
const FONT = '11px system-ui, sans-serif';

/** Round numbers, at most about `count` of them, that span low to high. */
function ticksOf([low, high], count) {
  const raw = (high - low) / Math.max(1, count);
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = power * ([1, 2, 5].find((factor) => factor * power >= raw) ?? 10);
  const first = Math.ceil(low / step - 1e-9);
  const ticks = Array.from({length: Math.floor(high / step + 1e-9) - first + 1}, (_, i) => (first + i) * step);
  return {ticks, digits: Math.max(0, -Math.floor(Math.log10(step) + 1e-9))};
}

/** The bounds of an axis that shows low to high; a quantity that hardly changes is a line, not its last digit. */
function bounds(low, high) {
  if (!(low <= high)) return [0, 1];
  const least = 1e-3 * Math.max(1e-3, Math.abs(low), Math.abs(high));
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

class Diagram {
  /** kinds: what can be shown, of CURVES or PORTRAITS, by name. */
  constructor(host, player, kinds) {
    Object.assign(this, {player, kinds, name: Object.keys(kinds)[0], wheels: []});
    this.layers = {faint: make('canvas'), strong: make('canvas')};
    this.unit = make('span', {className: 'unit'});
    this.values = make('output');
    this.canvas = make('canvas', {role: 'img'});
    this.choice = make('span', {className: 'segments', role: 'radiogroup', ariaLabel: 'Diagram'});
    this.sketch = null;  // the reader's guess [[t, value], ...] in the units of the axes; `asks`: it can be drawn now
    const title = this.timed ? make('b', {}, make('i', {}, ...subscripted(this.kind.symbol))) : this.choice;
    const caption = make('figcaption', {}, title, this.unit, this.values);
    this.figure = make('figure', {className: this.timed ? 'plot' : 'plot portrait'}, caption, this.canvas);
    host.append(this.figure);
    if (!this.timed) return;
    this.canvas.onpointermove = ({buttons, offsetX, offsetY}) => {
      if (buttons) this.asks ? this.sketchTo(offsetX, offsetY) : player.seek(this.timeAt(offsetX));
    };
    this.canvas.onpointerdown = (event) => {
      this.canvas.setPointerCapture(event.pointerId);
      this.last = null;
      this.canvas.onpointermove(event);
    };
    this.canvas.onkeydown = ({key}) => !(this.asks && this.sketchBy(key));
  }

  get kind() { return this.kinds[this.name]; }

  /** Whether the horizontal axis is that of time. */
  get timed() { return this.kind.units[0] === 's'; }

  /** The name that a picture needs. */
  get title() {
    return this.timed || this.kind.even ? `${this.kind.symbol} [${this.kind.units[1]}]` : this.kind.symbol;
  }

  /**
   * Takes the wheels to show, and the kind of this name, or the first that their columns allow; without any it hides.
   */
  select(wheels, name = this.name) {
    const showing = (kind) =>
        (kind.fits?.(wheels) === false ? [] :
                                         wheels.filter(({table}) => kind.columns.every((column) => table.has(column))));
    this.possible = Object.keys(this.kinds).filter((other) => showing(this.kinds[other]).length);
    this.figure.hidden = !this.possible.length;
    this.name = this.possible.includes(name) ? name : this.possible[0] ?? this.name;
    Object.assign(this, {all: wheels, wheels: showing(this.kind)});
    const [across, up] = this.kind.units;
    this.unit.textContent = this.timed || across === up ? up : '';
    this.canvas.title = this.canvas.ariaLabel = this.kind.what;
    if (this.timed) return;
    const buttons = this.possible.map((other) => ({name: other, title: this.kinds[other].what}));
    makeChoice(this.choice, buttons, (other) => this.choose(other))(this.name);
    [...this.choice.children].forEach(
        (button, i) => button.append(...subscripted(this.kinds[this.possible[i]].symbol)));
  }

  choose(name) {
    this.select(this.all, name);
    this.prepare('fitted');
    this.draw(this.player.t);
  }

  /** The next kind that there is. */
  next() { this.choose(this.possible[(this.possible.indexOf(this.name) + 1) % this.possible.length]); }

  /** A wheel's point at t. */
  at(wheel, t) {
    const now = Math.min(t, wheel.table.end);
    return this.kind.point(this.kind.columns.map((name) => wheel.table.value(name, now)), wheel);
  }

  /** All points of a wheel with their instants {times, points}: its rows, or its path, which is denser. */
  line(wheel) {
    if (this.kind.even) return wheel.trace;
    const columns = this.kind.columns.map((name) => wheel.table.shown[name]);
    const point = (t, i) => this.kind.point(columns.map((column) => column[i]), wheel);
    return {times: wheel.table.time, points: Array.from(wheel.table.time, point)};
  }

  /** Draws both layers anew. axis: 'fitted', 'kept' (only widened) or 'held' (widened only for what is past). */
  prepare(axis) {
    const {clientWidth: width, clientHeight: height} = this.canvas;
    if (this.figure.hidden || !width) return;
    this.lines = this.wheels.map((wheel) => this.line(wheel));
    Object.assign(this, {width, height, pen: clearCanvas(this.canvas, width, height)});
    Object.assign(this, {ink: colour('--ink'), paper: colour('--paper')});
    this.sizes = [width - LEFT - RIGHT, height - TOP - BOTTOM];
    this.range(axis);
    for (const [name, canvas] of Object.entries(this.layers)) {
      const pen = clearCanvas(canvas, width, height);
      const faint = name === 'faint';
      if (faint) this.grid(pen);
      pen.rect(LEFT, 0, this.sizes[0] + RIGHT, height - BOTTOM + 2);
      pen.clip();
      if (faint && this.secret) continue;
      if (this.timed) this.bands(pen, faint ? 0.4 : 1);
      pen.globalAlpha = faint ? 0.35 : 1;
      if (faint || this.timed) this.lines.forEach(({points}, k) => this.stroke(pen, k, points.length - 1));
    }
  }

  range(axis) {
    const {start, end, t} = this.player;
    const seen = ({times, points}) => (axis === 'held' ? points.filter((_, i) => times[i] <= t) : points);
    const points = this.lines.flatMap(seen);
    const kept = axis !== 'fitted' && this.ranged === this.kind && this.ranges;
    this.ranged = this.kind;
    this.ranges = [0, 1].map((side) => {
      if (this.timed && side === 0) return [start, end > start ? end : start + 1];
      const sketch = side ? this.sketch ?? [] : [];
      const [low, high] = extent([...points, ...sketch].flatMap((point) => (side ? point.slice(1) : point[0])));
      if (side && this.asks) return [0, 100];  // deg
      if (kept) return widened(kept[side], low, high);
      const flat = Math.max(-low, high) < 1e-9 && !this.kind.even;  // zero throughout, but for rounding, has no scale
      return flat ? [-1, 1] : bounds(low, high);
    });
    if (!this.kind.even) return;
    const scale = Math.max(...this.ranges.map(([low, high], i) => (high - low) / this.sizes[i]));
    this.ranges = this.ranges.map(([low, high], i) => {
      const missing = scale * this.sizes[i] - (high - low);
      const narrow = missing > 1e-9 * (high - low);  // rounding alone is no reason to move a limit
      return narrow ? [low - missing / 2, high + missing / 2] : [low, high];
    });
  }

  /** The numbers along the upper axis, [value, text]. */
  get marks() {
    const {ticks, digits} = ticksOf(this.ranges[1], Math.min(5, this.height / 26));
    return ticks.map((tick) => [tick, fixed(tick, digits)]);
  }

  /** How far along the axis across (0) or up (1) a value lies, in CSS pixels. */
  along(side, value) {
    return (value - this.ranges[side][0]) * (this.sizes[side] / (this.ranges[side][1] - this.ranges[side][0]));
  }

  x(value) { return LEFT + this.along(0, value); }

  y(value) { return TOP + this.sizes[1] - this.along(1, value); }

  /** The reader's guess goes on to a place of the canvas; what stood there before goes. */
  sketchTo(x, y) {
    const t = Math.min(this.player.end, Math.max(this.player.start, this.timeAt(x)));
    const [[low, high], [, length]] = [this.ranges[1], this.sizes];
    const value = low + Math.min(1, Math.max(0, 1 - (y - TOP) / length)) * (high - low);
    const [from, to] = [Math.min(t, this.last ?? t), Math.max(t, this.last ?? t)];
    this.last = t;
    this.sketch =
        [...this.sketch.filter(([other]) => other < from || other > to), [t, value]].sort(([a], [b]) => a - b);
    this.draw(this.player.t);
  }

  /** The guess goes on by an arrow key: up, down, level, or back; false for other keys. */
  sketchBy(key) {
    const rise = {ArrowUp: 10, ArrowDown: -10, ArrowRight: 0}[key];
    const [t, value] = this.sketch.at(-1);
    if (key === 'ArrowLeft' && this.sketch.length > 1) this.sketch.pop();
    if (rise !== undefined) this.sketch.push([t + this.player.end / KEYS, Math.min(100, Math.max(0, value + rise))]);
    this.draw(this.player.t);
    return key.startsWith('Arrow');
  }

  timeAt(x) {
    const {start, end} = this.player;
    return start + ((x - LEFT) / this.sizes[0]) * (end - start);
  }

  /** Lines and numbers of both axes; over time the last number has the unit, and there are no lines across. */
  grid(pen) {
    const across = ticksOf(this.ranges[0], Math.min(6, this.width / 48));
    pen.fillStyle = colour('--rule');
    for (const [tick] of this.marks) pen.fillRect(LEFT, Math.round(this.y(tick)), this.sizes[0], 1);
    for (const tick of this.timed ? [] : across.ticks) pen.fillRect(Math.round(this.x(tick)), TOP, 1, this.sizes[1]);
    Object.assign(pen, {font: FONT, fillStyle: colour('--soft'), textAlign: 'right', textBaseline: 'middle'});
    for (const [tick, text] of this.marks) pen.fillText(text, LEFT - 6, Math.round(this.y(tick)) + 0.5, LEFT - 8);
    Object.assign(pen, {textAlign: 'center', textBaseline: 'top'});
    for (const tick of across.ticks) {
      const unit = this.timed && tick === across.ticks.at(-1) ? ' s' : '';
      pen.fillText(fixed(tick, across.digits) + unit, Math.min(this.x(tick), this.width - 14), this.height - 15);
    }
    this.drawLevels(pen);
  }

  /** A level of each wheel whose parameters are known, with both signs: dashed lines across, where they are seen. */
  drawLevels(pen) {
    const values = this.wheels.map(({parameters}) => this.kind.level?.(parameters)).filter(Number.isFinite);
    const levels = [...new Set(values)].flatMap((value) => [-value, value]);
    Object.assign(pen, {strokeStyle: colour('--soft'), lineWidth: 1, textAlign: 'left', textBaseline: 'bottom'});
    pen.setLineDash(DASHES);
    for (const value of levels.filter((level) => level > this.ranges[1][0] && level < this.ranges[1][1])) {
      const y = Math.round(this.y(value)) + 0.5;
      pen.beginPath();
      pen.moveTo(LEFT, y);
      pen.lineTo(LEFT + this.sizes[0], y);
      pen.stroke();
      write(pen, 'ω_crit', LEFT + this.sizes[0] - 26, y, 11);
    }
    pen.setLineDash([]);
  }

  /** Where the wheel is held, or slides: bars on the axis; transitions as ticks at the top. */
  bands(pen, strength) {
    pen.globalAlpha = strength;
    for (const {phases} of this.wheels) {
      for (const [name, spans] of [['--stick', phases.sticks], ['--slide', phases.slides]]) {
        pen.fillStyle = colour(name);
        for (const [begin, end] of spans)
          pen.fillRect(this.x(begin), TOP + this.sizes[1] - BAR, Math.max(1, this.x(end) - this.x(begin)), BAR);
      }
      pen.fillStyle = colour('--force');
      for (const t of phases.transitions) pen.fillRect(this.x(t) - 0.5, TOP - 7, 1, 7);
    }
  }

  /** The line of wheel k up to its point `last`; over time with a cross where its motion ended. */
  stroke(pen, k, last) {
    const points = this.lines[k].points.slice(0, last + 1);
    Object.assign(pen, {lineWidth: 1.6, lineJoin: 'round', strokeStyle: this.wheels[k].colour});
    for (let part = 1; part < points[0]?.length; ++part) {
      pen.setLineDash(part > 1 ? DASHES : []);
      pen.beginPath();
      for (const point of points) pen.lineTo(this.x(point[0]), this.y(point[part]));
      pen.stroke();
    }
    pen.setLineDash([]);
    if (!this.timed || !this.wheels[k].ended) return;
    const [x, y] = [this.x(points.at(-1)[0]), this.y(points.at(-1)[1])];
    pen.beginPath();
    for (const side of [-4, 4]) {
      pen.moveTo(x - 4, y - side);
      pen.lineTo(x + 4, y + side);
    }
    pen.stroke();
  }

  drawSketch(pen) {
    Object.assign(pen, {lineWidth: 2, strokeStyle: this.ink}).setLineDash(DASHES);
    pen.beginPath();
    for (const [t, value] of this.sketch) pen.lineTo(this.x(t), this.y(value));
    pen.stroke();
    pen.setLineDash([]);
  }

  /** The picture at t. */
  draw(t) {
    if (this.figure.hidden || !this.width) return;
    const {pen, width, height, layers: {faint, strong}} = this;
    pen.clearRect(0, 0, width, height);
    pen.drawImage(faint, 0, 0, width, height);
    const past = t < this.player.end ? this.x(t) / width : 1;
    if (this.timed) pen.drawImage(strong, 0, 0, past * strong.width, strong.height, 0, 0, past * width, height);
    if (!this.timed) this.lines.forEach(({times}, k) => this.stroke(pen, k, before(times, t)));
    pen.fillStyle = this.ink;
    if (this.timed) pen.fillRect(this.x(t) - 0.5, TOP - 4, 1, this.sizes[1] + 4);
    const present = this.wheels.map((wheel) => this.at(wheel, t));
    if (this.sketch) this.drawSketch(pen);
    present.forEach(([x, ...all], k) => all.forEach((y) => {
      Object.assign(pen, {lineWidth: 1, fillStyle: this.wheels[k].colour, strokeStyle: this.paper}).beginPath();
      pen.arc(this.x(x), this.y(y), 3.6, 0, 7);
      pen.fill();
      pen.stroke();
    }));
    if (this.timed) this.show(present.flatMap(([, ...all], k) => all.map((value) => [value, this.wheels[k].colour])));
  }

  /** The values [[number, colour], ...] in the caption. */
  show(values) {
    const size = Math.max(...this.ranges[1].map(Math.abs));  // what is small has more digits
    const digits = Math.max(this.kind.digits, size < 1 ? Math.min(8, Math.ceil(2 - Math.log10(size))) : 0);
    this.values.replaceChildren(...values.map(([value, own]) => {
      const style = `color: color-mix(in srgb, ${own} 70%, var(--ink))`;
      return make('span', {style}, isFinite(value) ? fixed(value, digits) : '–');
    }));
  }
}

export class Plots {
  constructor(host, player) {
    Object.assign(this, {player, axis: 'fitted'});
    this.curves = CURVES.map((kind) => new Diagram(host, player, {curve: kind}));
    this.portrait = new Diagram(host, player, PORTRAITS);
    this.all = [...this.curves, this.portrait];
    new ResizeObserver(() => this.prepare()).observe(host);
  }

  /**
   * Whether the future is a secret, until the reader has guessed; draws: it can be drawn into the diagram of the tilt,
   * whose axis then goes from flat to beyond upright.
   */
  keepSecret(secret, draws = false) {
    for (const diagram of this.all) diagram.secret = secret;
    const [tilt] = this.curves;
    tilt.asks = secret && draws;
    if (secret) tilt.sketch = draws ? [[this.player.start, tilt.at(tilt.wheels[0], this.player.start)[1]]] : null;
    tilt.canvas.classList.toggle('asks', tilt.asks);
    tilt.canvas.tabIndex = tilt.asks ? 0 : -1;
    tilt.canvas.title = tilt.canvas.ariaLabel = tilt.asks ? DRAW : tilt.kind.what;
    this.prepare();
  }

  /** wheels: [{table, phases, trace, colour}], those that are shown. */
  show(wheels) {
    for (const diagram of this.all) diagram.select(wheels);  // all of them first: they share the width
    this.prepare();
  }

  prepare() {
    for (const diagram of this.all) diagram.prepare(this.axis);
    this.draw(this.player.t);
  }

  draw(t) {
    for (const diagram of this.all) {
      if (this.axis === 'held') diagram.prepare('held');  // the present may have left the frame
      diagram.draw(t);
    }
  }
}
