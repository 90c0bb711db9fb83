// The page: recorded wheels, a car's body, or the wheel itself (live), shown on one stage with one clock.
import {ChassisModel} from '#chassis';
import {startLive} from '#live';
import {phasesOf, sticksAt} from '#phases';
import {Player} from '#player';
import {Plots} from '#plots';
import {Stage} from '#stage';
import {Table} from '#table';
import {colour, watchTheme, wheelColour} from '#theme';
import {drawBands, setUpKeys, setUpTransport} from '#transport';
import {WheelModel} from '#wheel';
import {THREE} from 'three';

const $ = (selector) => document.querySelector(selector);
const data = JSON.parse($('#data').textContent);

/** What the reader has switched on. */
const show = {
  follow: true,
  path: true,
  axes: false,
  force: false
};

/** A recorded body: {name, label, r_0, r | size, columns} -> with table and phases. */
function decode(body) {
  const table = Table.decode(body.columns);
  return {...body, table, phases: phasesOf(table)};
}

class Page {
  constructor() {
    this.wheels = data.wheels.map(decode);
    this.bodies = data.bodies.map(decode);
    this.player = new Player();
    this.stage = new Stage($('#stage'), data.size);
    this.plots = new Plots($('#plots'), this.player);
    this.choice = 0;
    this.last = 0;
  }

  start() {
    setUpTransport(this.player);
    this.setUpSwitches();
    watchTheme($('#theme'), () => this.dress());
    this.player.addEventListener('time', () => (this.stage.dirty = true));
    new ResizeObserver(() => this.layOut()).observe($('#stage'));
    if (!data.live && !matchMedia('(prefers-reduced-motion: reduce)').matches) this.player.play();
    requestAnimationFrame((now) => this.frame(now));
  }

  setUpSwitches() {
    const boxes = Object.fromEntries(Object.keys(show).map((name) => [name, $(`#toggles [name=${name}]`)]));
    const flip = (name, on) => {
      boxes[name].checked = show[name] = on;
      this.stage.dirty = true;
    };
    for (const [name, box] of Object.entries(boxes)) box.addEventListener('change', () => flip(name, box.checked));
    const toggle = (name) => () => flip(name, !show[name]);
    const actions = {f: toggle('follow'), p: toggle('path'), a: toggle('axes'), g: toggle('force')};
    actions.r = () => this.stage.home();
    for (let i = 0; i < 9; ++i) actions[i + 1] = () => i < this.choices.length && this.choose(i);
    setUpKeys(this.player, actions);
    this.offer(data.choices);
  }

  /** What one can look at: [{label, views: lists of names}]. */
  offer(choices) {
    this.choices = choices;
    const host = $('#choice');
    host.hidden = choices.length < 2;
    host.replaceChildren();
    choices.forEach((choice, i) => {
      const button = document.createElement('button');
      button.type = 'button';
      button.setAttribute('role', 'radio');
      button.textContent = choice.label;
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
    look.size = data.size;
    look.axes = ['--e1', '--e2', '--e3'].map(colour);
    const wheels = this.wheels.map((wheel) => new WheelModel(wheel, {...look, accent: wheel.colour}));
    this.stage.put([...wheels, ...this.bodies.map((body) => new ChassisModel(body, look))]);
    this.choose(this.choice);
  }

  /** New motion of one wheel, same colours: path and plots only. */
  exchange(i, table, friction) {
    Object.assign(this.wheels[i], {table, phases: phasesOf(table, friction)});
    this.stage.models[i]?.drawPath();
    this.choose(this.choice);
  }

  /** Shows choice i: a list of views, each a list of names. */
  choose(i) {
    this.choice = i;
    [...$('#choice').children].forEach((button, k) => button.setAttribute('aria-checked', k === i));
    const names = this.choices[i].views;
    const known = [...this.wheels, ...this.bodies];
    this.views = names.map((view) => known.filter(({name}) => view.includes(name)));
    const shown = this.wheels.filter(({name}) => names.flat().includes(name));
    const tables = this.views.flat().map(({table}) => table);
    this.player.span(Math.min(...tables.map(({start}) => start)), Math.max(...tables.map(({end}) => end)));
    this.plots.show(shown);
    this.shown = shown;
    this.layOut();
  }

  /** One label for each wheel shown, over its view. */
  layOut() {
    this.stage.resize();
    if (!this.views) return;
    drawBands(this.shown, this.player);
    const host = $('#labels');
    host.replaceChildren();
    this.stage.rectangles(this.views.length).forEach(({x, y, w, h}, v) => {
      const edge = document.createElement('div');
      edge.className = 'edge';
      Object.assign(edge.style, {left: `${x}px`, top: `${y}px`, width: `${w}px`, height: `${h}px`});
      host.append(edge);
      const wheels = this.views[v].filter((body) => this.wheels.includes(body));
      wheels.forEach((wheel, i) => {
        const label = document.createElement('div');
        label.className = 'label card';
        label.style.left = `${x}px`;
        label.style.top = `${y + 40 * i}px`;
        label.innerHTML = `<i style="background:${wheel.colour}"></i><b></b><span></span>`;
        label.querySelector('b').textContent = wheel.label;
        wheel.tag = label;
        host.append(label);
      });
    });
    this.stage.dirty = true;
  }

  /** What the wheel does at t, in a few words. */
  label(wheel, t) {
    const over = wheel.ended && t >= wheel.table.end;
    const sticks = sticksAt(wheel.phases, t);
    wheel.tag.dataset.state = over ? 'ended' : sticks ? 'sticks' : 'rolls';
    if (over)
      wheel.tag.lastChild.textContent = wheel.ended;
    else
      wheel.tag.lastChild.innerHTML = sticks ? 'held: ω<sub>z</sub> = 0' : '';
  }

  /** What a view looks at: between its bodies if it follows, else the middle of their paths; and from how far. */
  aim(view, t) {
    const low = new THREE.Vector3(Infinity, Infinity, 0);
    const high = new THREE.Vector3(-Infinity, -Infinity, 0);
    for (const body of view) {
      const {table} = body;
      const [x, y] = table.has('X_O') ? ['X_O', 'Y_O'] : ['X', 'Y'];
      const rows = show.follow ? [0] : Array.from({length: 60}, (_, k) => (k * (table.rows - 1)) / 59);
      for (const row of rows) {
        const k = Math.round(row);
        const point = show.follow ? [table.value(x, t), table.value(y, t)] : [table.columns[x][k], table.columns[y][k]];
        low.min(new THREE.Vector3(...point, 0));
        high.max(new THREE.Vector3(...point, 0));
      }
    }
    const away = Math.max(1, 0.5 + (0.5 * low.distanceTo(high)) / data.size);
    return {
      models: this.stage.models.filter((model) => view.includes(model.wheel)),
      away,
      anchor: low.add(high).multiplyScalar(0.5).setZ(data.height)
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

  /** Everything at the present instant. */
  draw() {
    const {t} = this.player;
    for (const model of this.stage.models) model.update(Math.min(t, model.wheel.table.end), show);
    const views = this.views.map((view) => this.aim(view, t));
    this.stage.render(views, Math.max(...views.map(({away}) => away)));
    this.plots.draw(t);
    for (const wheel of this.shown) this.label(wheel, t);
  }
}

try {
  const page = new Page();
  window.page = page;  // for the console and the tests
  if (data.live) await startLive(page, data.live);
  page.start();
} catch (fault) {
  const trouble = $('#trouble');
  trouble.hidden = false;
  trouble.textContent = `The page could not start: ${fault.message.replace(/\.+$/, '')}.`;
  console.error(fault);
}
