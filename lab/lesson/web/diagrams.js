// All diagrams. Over time: the past is a thick line, the future a thin one, and held or sliding is marked on the axis.
// They share the clock, and keep their axes while the reader pushes the wheel. Angles in degrees, all else SI.
import {fits, KINDS, RECORDED} from '#curves';
import {clearCanvas, colour, fixed, make, subscripted, write} from '#dom';
import {contact} from '#pictures';
import {before, extent, roundUp} from '#table';

const [LEFT, RIGHT, TOP, BOTTOM] = [48, 8, 10, 20];  // margins, CSS pixels
const LANE = 4;                                      // CSS pixels, of held or sliding
const DASHES = [5, 4];
const [PAST, FUTURE] = [2.6, 1];  // CSS pixels, widths of lines
const KEYS = 40;                  // strokes of an arrow key draw a guess from start to end
const DRAW = 'Draw how the lean goes on: by mouse or finger, or by the arrow keys, of which the left one takes back';
const FONT = '11px system-ui, sans-serif';

/** Round numbers, at most about `count` of them, that span low to high. */
function ticksOf([low, high], count) {
  const step = roundUp((high - low) / Math.max(1, count));
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

/** Bounds that hold low to high: those before, where they are wide enough, else widened by a quarter of their span. */
function widened([before, after], low, high) {
  const reserve = 0.25 * (Math.max(high, after) - Math.min(low, before));
  return [low < before ? low - reserve : before, high > after ? high + reserve : after];
}

/** A figure with its caption and a canvas. */
class Diagram {
  constructor(host, player, kind) {
    Object.assign(this, {player, kind, wheels: []});
    this.values = make('span', {className: 'values'});
    this.canvas = make('canvas', {role: 'img', ariaLabel: kind.what, title: kind.what});
    this.name = make('span', {className: 'name'}, ...subscripted(kind.title));
    const unit = make('span', {className: 'unit'}, kind.unit);
    this.figure = make(
        'figure', {className: `plot ${kind.form}`}, make('figcaption', {}, this.name, unit, this.values), this.canvas);
    host.append(this.figure);
  }

  /** Takes the canvas's size and clears it; false while there is none. */
  measure() {
    const {clientWidth: width, clientHeight: height} = this.canvas;
    if (!width) return false;
    Object.assign(this, {width, height, pen: clearCanvas(this.canvas, width, height)});
    this.sizes = [width - LEFT - RIGHT, height - TOP - BOTTOM];
    return true;
  }

  /** A wheel's column at t, while its motion lasts. */
  at({table}, t) {
    const now = Math.min(t, table.end);
    return (name) => table.value(name, now);
  }

  /** How far along the axis across (0) or up (1) a value lies, in CSS pixels. */
  along(side, value) {
    return (value - this.ranges[side][0]) * (this.sizes[side] / (this.ranges[side][1] - this.ranges[side][0]));
  }

  x(value) { return LEFT + this.along(0, value); }

  y(value) { return TOP + this.sizes[1] - this.along(1, value); }

  /** Lines and numbers of both axes; the last number across has the unit. Bars have no axis upward. */
  grid(pen, unit) {
    const up = this.kind.form === 'bars' ? {ticks: []} : ticksOf(this.ranges[1], Math.min(5, this.height / 26));
    const across = ticksOf(this.ranges[0], Math.min(6, this.width / 48));
    pen.fillStyle = colour('--rule');
    for (const tick of up.ticks) pen.fillRect(LEFT, Math.round(this.y(tick)), this.sizes[0], 1);
    for (const tick of this.kind.form === 'time' ? [] : across.ticks)
      pen.fillRect(Math.round(this.x(tick)), TOP, 1, this.sizes[1]);
    Object.assign(pen, {font: FONT, fillStyle: colour('--soft'), textAlign: 'right', textBaseline: 'middle'});
    for (const tick of up.ticks)
      pen.fillText(fixed(tick, up.digits), LEFT - 6, Math.round(this.y(tick)) + 0.5, LEFT - 8);
    Object.assign(pen, {textAlign: 'center', textBaseline: 'top'});
    for (const tick of across.ticks) {
      const text = fixed(tick, across.digits) + (unit && tick === across.ticks.at(-1) ? ` ${unit}` : '');
      pen.fillText(text, Math.min(this.x(tick), this.width - pen.measureText(text).width / 2), this.height - 15);
    }
  }

  line(pen, points, width, strokeStyle, dashes = []) {
    Object.assign(pen, {lineWidth: width, lineJoin: 'round', strokeStyle}).setLineDash(dashes);
    pen.beginPath();
    for (const [x, y] of points) pen.lineTo(this.x(x), this.y(y));
    pen.stroke();
    pen.setLineDash([]);
  }

  dot(pen, x, y, fillStyle) {
    Object.assign(pen, {lineWidth: 1, fillStyle, strokeStyle: colour('--paper')}).beginPath();
    pen.arc(this.x(x), this.y(y), 3.6, 0, 7);
    pen.fill();
    pen.stroke();
  }
}

/** Curves over time. */
class Curve extends Diagram {
  constructor(host, player, kind) {
    super(host, player, kind);
    this.layers = [FUTURE, PAST].map((width) => ({width, canvas: make('canvas')}));
    this.sketch = null;  // the reader's guess [[t, value], ...]; `asks`: it can be drawn now
    const {canvas} = this;
    canvas.onpointermove = ({buttons, offsetX, offsetY}) => {
      if (buttons) this.asks ? this.sketchTo(offsetX, offsetY) : player.seek(this.timeAt(offsetX));
    };
    canvas.onpointerdown = (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.last = null;
      canvas.onpointermove(event);
    };
    canvas.onkeydown = ({key}) => !(this.asks && this.sketchBy(key));
  }

  /** Whether the reader draws the curve now. */
  ask(asks) {
    const {canvas, wheels: [wheel], player} = this;
    this.asks = asks;
    if (asks) this.sketch = [[player.start, this.valuesAt(wheel, player.start)[0]]];
    canvas.classList.toggle('asks', asks);
    canvas.tabIndex = asks ? 0 : -1;
    canvas.title = canvas.ariaLabel = asks ? DRAW : this.kind.what;
  }

  valuesAt(wheel, t) { return this.kind.values(this.kind.columns.map(this.at(wheel, t)), wheel); }

  /** Draws past and future anew. axis: 'fitted', 'kept' (only widened) or 'held' (widened only for what is past). */
  prepare(axis) {
    if (!this.measure()) return;
    const {kind, wheels} = this;
    this.lines = wheels.map((wheel) => {
      const columns = kind.columns.map((name) => wheel.table.shown[name]);
      return Array.from(wheel.table.time, (t, i) => [t, ...kind.values(columns.map((column) => column[i]), wheel)]);
    });
    this.range(axis);
    for (const {width, canvas} of this.layers) {
      const pen = clearCanvas(canvas, this.width, this.height);
      if (width === FUTURE) this.grid(pen, 's');
      this.drawLevels(pen);
      pen.rect(LEFT, 0, this.sizes[0] + RIGHT, this.height - BOTTOM + 2);
      pen.clip();
      if (width === FUTURE && this.secret) continue;
      this.lines.forEach((points, k) => this.stroke(pen, k, points, width));
      this.drawMarks(pen);
    }
  }

  /** The bounds of both axes; while the future is a secret they tell nothing of it. */
  range(axis) {
    const {kind, player: {start, end, t}, lines} = this;
    const seen = lines.flat().filter(([time]) => axis !== 'held' || time <= t);
    const spread = ([, value, most]) => (kind.band ? [value, most, -most] : [value, most ?? value]);
    const [low, high] = extent([...seen.flatMap(spread), ...(this.sketch ?? []).map(([, value]) => value)]);
    const begun = Math.max(...lines.flatMap(([first]) => first.slice(1).map(Math.abs)));
    const before = axis === 'fitted' ? null : this.ranges?.[1];
    const flat = Math.max(-low, high) < 1e-9;  // zero throughout, but for rounding, has no scale
    const open = before ? widened(before, low, high) : flat ? [-1, 1] : bounds(low, high);
    this.ranges = [
      [start, end > start ? end : start + 1],
      this.secret ? kind.whole ?? bounds(-begun, begun) : open,
    ];
  }

  /** The colour of the first (0) or second (1) curve of wheel k. */
  hue(k, i) {
    const {kind: {second}, wheels} = this;
    return i && second && wheels.length === 1 ? colour(second) : wheels[k].colour;
  }

  /** The line of wheel k, with a cross where its motion ended; of a band, its limits. */
  stroke(pen, k, points, width) {
    const {wheels: {[k]: {colour: own, ended, phases, table}}, kind} = this;
    const part = (i) => points.map((point) => [point[0], i < 0 ? -point[-i] : point[i]]);
    if (kind.band) {
      const held = colour('--stick');
      Object.assign(pen, {fillStyle: held, globalAlpha: width === PAST ? 0.3 : 0.12}).beginPath();
      for (const [t, value] of [...part(2), ...part(-2).reverse()]) pen.lineTo(this.x(t), this.y(value));
      pen.fill();
      pen.globalAlpha = 1;
      for (const side of [2, -2]) this.line(pen, part(side), 1, held);
      const sticks = width === PAST ? phases.sticks : [];
      for (const [begin, end] of sticks) this.line(pen, part(1).filter(([t]) => t >= begin && t <= end), 7, held);
    }
    this.line(pen, part(1), width, own);
    if (!kind.band && points[0].length > 2) this.line(pen, part(2), width, this.hue(k, 1), DASHES);
    if (!ended) return;
    const [x, y] = [this.x(table.end), this.y(points.at(-1)[1])];
    Object.assign(pen, {lineWidth: 1.6, strokeStyle: own}).beginPath();
    for (const side of [-4, 4]) {
      pen.moveTo(x - 4, y - side);
      pen.lineTo(x + 4, y + side);
    }
    pen.stroke();
  }

  /** A level of each wheel that has one, with both signs, where they are seen: dashed, its name above the line. */
  drawLevels(pen) {
    const values = this.wheels.map((wheel) => this.kind.level?.(wheel)).filter(Number.isFinite);
    const seen = [...new Set(values)]
                     .flatMap((value) => [-value, value])
                     .filter((level) => level > this.ranges[1][0] && level < this.ranges[1][1]);
    for (const value of this.secret ? [] : seen) {
      this.line(pen, [[this.ranges[0][0], value], [this.ranges[0][1], value]], 1, colour('--soft'), DASHES);
      Object.assign(pen, {fillStyle: colour('--soft'), textAlign: 'left', textBaseline: 'bottom'});
      write(pen, 'ω_crit', LEFT + this.sizes[0] - 30, this.y(value) - 4, 11);
    }
  }

  /** Held and sliding in two lanes on the axis, so that neither hides the other; transitions as ticks at the top. */
  drawMarks(pen) {
    for (const {phases} of this.wheels) {
      for (const [lane, name, spans] of [[1, '--stick', phases.sticks], [2, '--slide', phases.slides]]) {
        pen.fillStyle = colour(name);
        for (const [begin, end] of spans) {
          const y = TOP + this.sizes[1] - lane * LANE;
          pen.fillRect(this.x(begin), y, Math.max(1, this.x(end) - this.x(begin)), LANE);
        }
      }
      pen.fillStyle = colour('--force');
      for (const t of phases.transitions) pen.fillRect(this.x(t) - 0.5, TOP - 7, 1, 7);
    }
  }

  /** The reader's guess goes on to a place of the canvas; what stood there before goes. */
  sketchTo(x, y) {
    const t = Math.min(this.player.end, Math.max(this.player.start, this.timeAt(x)));
    const [[low, high], [, length]] = [this.ranges[1], this.sizes];
    const value = low + Math.min(1, Math.max(0, 1 - (y - TOP) / length)) * (high - low);
    const last = this.last ?? t;
    const passed = (other) => other === t || (other - last) * (other - t) < 0;
    this.last = t;
    this.sketch = [...this.sketch.filter(([other]) => !passed(other)), [t, value]].sort(([a], [b]) => a - b);
    this.draw(this.player.t);
  }

  /** The guess goes on by an arrow key: up, down, level, or back; false for other keys. */
  sketchBy(key) {
    const rise = {ArrowUp: 10, ArrowDown: -10, ArrowRight: 0}[key];
    const [t, value] = this.sketch.at(-1);
    if (key === 'ArrowLeft' && this.sketch.length > 1) this.sketch.pop();
    if (rise !== undefined) this.sketch.push([t + this.player.end / KEYS, Math.min(90, Math.max(0, value + rise))]);
    this.draw(this.player.t);
    return key.startsWith('Arrow');
  }

  timeAt(x) {
    const {start, end} = this.player;
    return start + ((x - LEFT) / this.sizes[0]) * (end - start);
  }

  draw(t) {
    if (!this.width) return;
    const {pen, width, height, layers: [future, past], kind, wheels} = this;
    pen.clearRect(0, 0, width, height);
    pen.drawImage(future.canvas, 0, 0, width, height);
    const part = t < this.player.end ? this.x(t) / width : 1;
    const {canvas} = past;
    if (part > 0) pen.drawImage(canvas, 0, 0, part * canvas.width, canvas.height, 0, 0, part * width, height);
    pen.fillStyle = colour('--ink');
    pen.fillRect(this.x(t) - 0.5, TOP - 4, 1, this.sizes[1] + 4);
    if (this.sketch) this.line(pen, this.sketch, 2, colour('--ink'), DASHES);
    const present = wheels.map((wheel) => this.valuesAt(wheel, t).slice(0, kind.band ? 1 : 2));
    present.forEach((all, k) => all.forEach((value, i) => this.dot(pen, t, value, this.hue(k, i))));
    this.show(present.flatMap((all, k) => all.map((value, i) => [value, this.hue(k, i)])));
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

/** One quantity over another, or the path. */
class Plane extends Diagram {
  lineOf(wheel) {
    if (this.kind.even) return wheel.trace;
    const columns = this.kind.columns.map((name) => wheel.table.columns[name]);
    const point = (_, i) => this.kind.point(columns.map((column) => column[i]), wheel);
    return {times: wheel.table.time, points: Array.from(wheel.table.time, point)};
  }

  prepare(axis) {
    if (!this.measure()) return;
    this.lines = this.wheels.map((wheel) => this.lineOf(wheel));
    const {t} = this.player;
    const seen = ({times, points}) => (axis === 'held' ? points.filter((_, i) => times[i] <= t) : points);
    const points = this.lines.flatMap(seen);
    const before = axis === 'fitted' ? null : this.ranges;
    this.ranges = [0, 1].map((side) => {
      const [low, high] = extent(points.map((point) => point[side]));
      return before ? widened(before[side], low, high) : bounds(low, high);
    });
    if (this.kind.even) this.level();
  }

  /** Widens one axis until both have one scale. */
  level() {
    const scale = Math.max(...this.ranges.map(([low, high], i) => (high - low) / this.sizes[i]));
    this.ranges = this.ranges.map(([low, high], i) => {
      const missing = scale * this.sizes[i] - (high - low);
      const narrow = missing > 1e-9 * (high - low);  // rounding alone is no reason to move a limit
      return narrow ? [low - missing / 2, high + missing / 2] : [low, high];
    });
  }

  draw(t) {
    if (!this.width) return;
    const {pen, wheels, kind} = this;
    pen.clearRect(0, 0, this.width, this.height);
    this.grid(pen, kind.units[0]);
    this.lines.forEach(({times, points}, k) => {
      if (!this.secret) this.line(pen, points, FUTURE, wheels[k].colour);
      this.line(pen, points.slice(0, before(times, t) + 1), PAST, wheels[k].colour);
      this.dot(pen, ...kind.point(kind.columns.map(this.at(wheels[k], t)), wheels[k]), wheels[k].colour);
    });
  }
}

/** An arrow on a canvas from [x, y] by [dx, dy], with a name beyond its tip. */
function arrow(pen, [x, y], [dx, dy], strokeStyle, name) {
  const length = Math.hypot(dx, dy);
  if (length < 1) return;
  const [ux, uy] = [dx / length, dy / length];
  const head = Math.min(9, length);
  Object.assign(pen, {strokeStyle, fillStyle: strokeStyle, lineWidth: 2.6}).beginPath();
  pen.moveTo(x, y);
  pen.lineTo(x + dx - 0.8 * head * ux, y + dy - 0.8 * head * uy);
  pen.stroke();
  pen.beginPath();
  pen.moveTo(x + dx, y + dy);
  for (const side of [-0.5, 0.5]) pen.lineTo(x + dx - head * (ux - side * uy), y + dy - head * (uy + side * ux));
  pen.fill();
  Object.assign(pen, {textAlign: 'left', textBaseline: 'middle'});
  const within = Math.min(Math.max(y + dy + 10 * uy, 7), pen.canvas.clientHeight - 7);  // of the diagram
  pen.font = '12px system-ui, sans-serif';
  const aside = ux < -0.3 ? -7 - pen.measureText(name).width : 7 + 3 * ux;
  write(pen, name, x + dx + aside, within, 12);
}

/** A force in newtons, of any wheel. */
const newtons = (force) => fixed(force, force < 0.1 ? 4 : force < 10 ? 2 : 0);

/** The friction circle: the road's force, forward up and left to the left, and the direction of the slip. */
class Circle extends Diagram {
  prepare() {
    if (!this.measure()) return;
    const {width, height, wheels: [{parameters: {mu_max, mu_slide}, table}]} = this;
    this.outer = Math.max(mu_max, mu_slide);
    const {lambda_x, lambda_y, lambda_3} = table.shown;
    const force = extent(Array.from(lambda_x, (x, i) => Math.hypot(x, lambda_y[i])))[1];
    const radius = this.outer > 0 ? this.outer * extent(lambda_3)[1] : roundUp(Math.max(force, 1e-9));
    this.scale = (0.5 * height - 6) / radius;  // CSS pixels to a newton
    this.middle = [width / 2 - 40, height / 2];
  }

  /** A circle, with its name beside it at `side` of the outer one: -1 above, 1 below. */
  ring(radius, name, side, rim, dashes = []) {
    const {pen, scale, middle: [x, y]} = this;
    const strokeStyle = colour('--soft');
    Object.assign(pen, {strokeStyle, lineWidth: 1.6}).setLineDash(dashes);
    pen.beginPath();
    pen.arc(x, y, scale * radius, 0, 7);
    pen.stroke();
    pen.setLineDash([]);
    Object.assign(pen, {fillStyle: strokeStyle, textAlign: 'left', textBaseline: 'middle'});
    write(pen, `${name} = ${newtons(radius)} N`, x + rim + 8, y + side * rim, 12);
  }

  draw(t) {
    if (!this.width) return;
    const {pen, middle, scale, outer, wheels: [wheel], width, height} = this;
    const at = this.at(wheel, t);
    const {mu_max, mu_slide} = wheel.parameters;
    const place = (along, left) => [middle[0] - scale * left, middle[1] - scale * along];
    pen.clearRect(0, 0, width, height);
    pen.fillStyle = colour('--rule');
    pen.fillRect(middle[0] - height / 2, middle[1], height, 1);
    pen.fillRect(middle[0], 0, 1, height);
    if (outer > 0) {
      const rim = scale * outer * at('lambda_3') * Math.SQRT1_2;
      this.ring(mu_max * at('lambda_3'), 'μ_max N', -1, rim);
      this.ring(mu_slide * at('lambda_3'), 'μ_slide N', 1, rim, DASHES);
    }
    const {time} = wheel.table;
    const {lambda_x, lambda_y} = wheel.table.shown;
    Object.assign(pen, {strokeStyle: wheel.colour, lineWidth: 1}).beginPath();
    for (let i = 0; i <= before(time, t); ++i) pen.lineTo(...place(lambda_x[i], lambda_y[i]));
    pen.stroke();
    const {slip} = contact(wheel.parameters, at);
    const speed = Math.hypot(...slip);
    const [tip, origin] = [place(at('lambda_x'), at('lambda_y')), place(0, 0)];
    if (speed > 0) {
      const way = place(...slip.map((part) => part / speed * 0.62 * (height / 2) / scale));
      arrow(pen, origin, [way[0] - origin[0], way[1] - origin[1]], colour('--slide'), 'slip');
    }
    arrow(pen, origin, [tip[0] - origin[0], tip[1] - origin[1]], colour('--force'), 'road');
    const force = Math.hypot(at('lambda_x'), at('lambda_y'));
    this.values.textContent = newtons(force);
  }
}

const TERMS = [['tips', 'm g r_0', '--tips'], ['rights', '(J_z + m R²)(J_z/J_x) ω²', '--rights']];

/** The two moments per radian of lean of each wheel, as bars of one scale. */
class Bars extends Diagram {
  prepare() { this.measure(); }

  draw() {
    if (!this.width) return;
    const {pen, width, height, wheels} = this;
    const most = Math.max(...wheels.flatMap(({perRadian: {tips, rights}}) => [tips, rights]));
    const high = roundUp(1.02 * most);
    this.ranges = [[0, high], [0, 1]];
    pen.clearRect(0, 0, width, height);
    this.grid(pen, '');
    const rows = wheels.flatMap((wheel) => TERMS.map((term) => [wheel, ...term]));
    const pitch = this.sizes[1] / rows.length;
    rows.forEach(([{label, perRadian}, name, formula, own], i) => {
      const y = TOP + i * pitch;
      const text = rows.length > 2 ? `${label}: ${name}` : `${name}  ${formula}`;
      pen.fillStyle = colour(own);
      pen.fillRect(LEFT, y + 0.45 * pitch, this.along(0, perRadian[name]), 0.42 * pitch);
      Object.assign(pen, {fillStyle: colour('--ink'), textAlign: 'left', textBaseline: 'middle'});
      const end = write(pen, text, LEFT + 3, y + 0.24 * pitch, 12);
      write(pen, `${this.number(perRadian[name])} N m`, end + 10, y + 0.24 * pitch, 12);
    });
    this.values.replaceChildren(
        ...wheels.map(({perRadian: {tips, rights}}) => make('span', {}, this.verdict(tips, rights))));
  }

  number(value) { return Number(value.toPrecision(3)).toString(); }

  verdict(tips, rights) {
    if (Math.abs(rights / tips - 1) < 5e-3) return 'equal: the critical spin';
    return rights > tips ? 'righted' : 'tipped';
  }
}

const FORMS = {
  time: Curve,
  plane: Plane,
  circle: Circle,
  bars: Bars
};

export class Plots {
  constructor(host, player) {
    Object.assign(this, {host, player, axis: 'fitted', all: [], wheels: []});
    new ResizeObserver(() => this.prepare()).observe(host);
  }

  /** Shows wheels [{table, phases, trace, colour}] in diagrams by name; without names in those that they fit. */
  show(wheels, names = RECORDED.filter((name) => wheels.some((wheel) => fits(KINDS[name], wheel)))) {
    const key = names.join();
    this.wheels = wheels;
    if (key !== this.key) {
      this.key = key;
      this.host.replaceChildren();
      this.all = names.map((name) => new FORMS[KINDS[name].form](this.host, this.player, KINDS[name]));
    }
    for (const one of this.all)
      one.wheels = wheels.filter((wheel) => one.kind.columns.every((name) => wheel.table.has(name)));
    this.prepare();
  }

  /** Whether the future is a secret, until the reader has guessed; draws: into the diagram of the lean. */
  keepSecret(secret, draws = false) {
    for (const diagram of this.all) {
      Object.assign(diagram, {secret, sketch: secret ? null : diagram.sketch});
      diagram.figure.hidden = secret && (draws ? diagram !== this.tilt : diagram.kind.form === 'bars');
    }
    if (this.tilt) this.tilt.ask(secret && draws);
    this.prepare();
  }

  /** The diagram into which a guess is drawn. */
  get tilt() { return this.all.find(({kind}) => kind === KINDS.lean); }

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
