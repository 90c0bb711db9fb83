// The page: recorded wheels, a car's body, or the wheel itself (live), shown on one stage with one clock.
import {setUpCards, setUpValues} from '#cards';
import {ChassisModel} from '#chassis';
import {drawBands, Player, setUpSwitches, setUpTransport} from '#clock';
import {Plots} from '#diagrams';
import {endingOf, Labels} from '#labels';
import {startLive} from '#live';
import {moving} from '#phases';
import {Stage} from '#stage';
import {Table} from '#table';
import {setUpTaking} from '#take';
import {colour, watchTheme, wheelColour} from '#theme';
import {WheelModel} from '#wheel';
import {THREE} from 'three';

const $ = (selector) => document.querySelector(selector);
const data = JSON.parse($('#data').textContent);
const CALM = matchMedia('(prefers-reduced-motion: reduce)').matches;

/** A recorded body: {name, label, r_0, r | size, columns} -> with table, and a wheel with phases and trace. */
function decode(body) {
  const table = Table.decode(body.columns);
  return {...body, ...('r_0' in body ? moving(table, body.r_0) : {table})};
}

/** The vertical in the road's axes of a body with a slope {slope, slope_direction} in rad, or of none. */
function verticalOf({slope = 0, slope_direction: uphill = 0} = {}) {
  const along = Math.sin(slope);
  return new THREE.Vector3(along * Math.cos(uphill), along * Math.sin(uphill), Math.cos(slope));
}

class Page {
  constructor() {
    this.wheels = data.wheels.map(decode);
    this.bodies = data.bodies.map(decode);
    this.player = new Player();
    this.stage = new Stage($('#stage'), this.size());
    this.plots = new Plots($('#plots'), this.player);
    this.labels = new Labels($('#labels'));
    this.choice = 0;
    this.last = 0;
    const ends = this.wheels.map(({table}) => table.end);
    for (const wheel of this.wheels) wheel.ended = endingOf(wheel.table, Math.max(...ends));
  }

  /** The largest outer radius of the wheels, and how large the thing is that one looks at, in m. */
  radius() { return this.wheels.reduce((most, {r_0, r}) => Math.max(most, r_0 + r), 0) || 0.35; }

  size() { return Math.max(2 * this.radius(), ...this.bodies.map(({size: [x, y]}) => 0.9 * Math.hypot(x, y))); }

  start() {
    setUpTransport(this.player);
    this.switches = setUpSwitches(this);
    this.show = this.switches.show;
    this.offer(data.choices);
    setUpTaking(this);
    setUpCards();
    $('#values').hidden = this.wheels.every(({parameters}) => !parameters);
    setUpValues(data.variables, () => this.shown);
    watchTheme($('#theme'), () => this.dress());
    this.player.addEventListener('time', () => (this.stage.dirty = true));
    new ResizeObserver(() => this.layOut()).observe($('#stage'));
    this.live?.begin();
    if (!CALM && this.player.t === this.player.start) this.player.play();
    requestAnimationFrame((now) => this.frame(now));
  }

  /** What one can look at: [{label, views: lists of names}]. */
  offer(choices) {
    this.choices = choices;
    const host = $('#choice');
    host.hidden = choices.length < 2;
    host.replaceChildren();
    choices.forEach((choice, i) => {
      const button = document.createElement('button');
      Object.assign(button, {type: 'button', textContent: choice.label, title: `Show: ${choice.label} (key ${i + 1})`});
      button.setAttribute('role', 'radio');
      button.addEventListener('click', () => this.choose(i));
      host.append(button);
    });
  }

  /** Takes the theme's colours: every body is made anew. */
  dress() {
    this.stage.dress();
    this.wheels.forEach((wheel, i) => (wheel.colour = wheelColour(wheel.paint ?? i)));
    this.rebuild();
  }

  /** Bodies, plots and clock after a change of data or colours. */
  rebuild() {
    const look = {force: colour('--force'), stick: colour('--stick'), body: colour('--body'), line: colour('--line')};
    look.size = this.size();
    this.stage.zoom(look.size);
    look.axes = ['--e1', '--e2', '--e3'].map(colour);
    const wheels = this.wheels.map((wheel) => new WheelModel(wheel, {...look, accent: wheel.colour}));
    this.stage.put([...wheels, ...this.bodies.map((body) => new ChassisModel(body, look))]);
    this.choose(this.choice);
  }

  /** New motion of one wheel, same colours: path and plots only. */
  exchange(i, table, friction) {
    Object.assign(this.wheels[i], moving(table, this.wheels[i].r_0, friction));
    this.stage.models[i]?.drawPath();
    this.choose(this.choice);
  }

  /** Shows choice i: a list of views, each a list of names. */
  choose(i) {
    this.choice = Math.min(i, this.choices.length - 1);
    [...$('#choice').children].forEach((button, k) => button.setAttribute('aria-checked', k === this.choice));
    const names = this.choices[this.choice].views;
    const known = [...this.wheels, ...this.bodies];
    this.views = names.map((view) => known.filter(({name}) => view.includes(name)));
    this.shown = this.wheels.filter(({name}) => names.flat().includes(name));
    const tables = this.views.flat().map(({table}) => table);
    const end = Math.max(...tables.map(({end}) => end));
    const kept = this.plots.axis === 'fitted' ? end : Math.max(end, this.player.end);
    this.player.span(Math.min(...tables.map(({start}) => start)), kept);
    this.plots.show(this.shown);
    this.layOut();
  }

  /** One label for each wheel shown, over its view. */
  layOut() {
    this.stage.resize();
    if (!this.views) return;
    drawBands(this.shown, this.player);
    const wheels = this.views.map((view) => view.filter((body) => this.wheels.includes(body)));
    this.labels.layOut(this.stage.rectangles(this.views.length), wheels);
    this.stage.dirty = true;
  }

  /** What a view looks at: between its bodies if it follows, else the middle of their paths; and from how far. */
  aim(view, t) {
    const {follow} = this.show;
    const low = new THREE.Vector3(Infinity, Infinity, 0);
    const high = new THREE.Vector3(-Infinity, -Infinity, 0);
    for (const {table} of view) {
      const [x, y] = table.has('X_O') ? ['X_O', 'Y_O'] : ['X', 'Y'];
      const rows = follow ? [0] : Array.from({length: 60}, (_, k) => Math.round((k * (table.rows - 1)) / 59));
      for (const row of rows) {
        const point = follow ? [table.value(x, t), table.value(y, t)] : [table.columns[x][row], table.columns[y][row]];
        low.min(new THREE.Vector3(...point, 0));
        high.max(new THREE.Vector3(...point, 0));
      }
    }
    const away = Math.max(1, 0.5 + (0.5 * low.distanceTo(high)) / this.size());
    return {
      models: this.stage.models.filter((model) => view.includes(model.wheel)),
      away,
      anchor: low.add(high).multiplyScalar(0.5).setZ(0.8 * this.radius()),
      up: verticalOf(view.find(({slope}) => slope))
    };
  }

  frame(now) {
    this.player.advance((now - this.last) / 1000);
    this.last = now;
    this.live?.frame();
    this.stage.controls.update();
    if (this.stage.dirty) this.draw();
    requestAnimationFrame((next) => this.frame(next));
  }

  /** The bodies where they are at the present instant; nothing is drawn. */
  pose() {
    const {t} = this.player;
    for (const model of this.stage.models) model.update(Math.min(t, model.wheel.table.end), this.show);
  }

  /** Everything at the present instant. */
  draw() {
    const {t} = this.player;
    this.pose();
    const views = this.views.map((view) => this.aim(view, t));
    this.stage.render(views, Math.max(...views.map(({away}) => away)));
    this.plots.draw(t);
    this.labels.tell(this.shown, t);
    this.first ??= performance.now();  // ms from the opening of the page to its first picture
  }
}

try {
  const page = new Page();
  window.page = page;  // for the console and the tests
  if (data.live) await startLive(page, data.live, data.variables);
  page.start();
} catch (fault) {
  const trouble = $('#trouble');
  trouble.hidden = false;
  trouble.textContent = `The page could not start: ${fault.message.replace(/\.+$/, '')}.`;
  console.error(fault);
}
