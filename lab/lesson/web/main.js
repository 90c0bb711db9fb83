// The page: recorded wheels, or the wheel itself (the lesson), shown on one stage with one clock.
import {lookOf, WheelModel} from '#bodies';
import {Player, setUpKeys, setUpSwitches, setUpTransport, showBands} from '#clock';
import {Plots} from '#diagrams';
import {$, bodies, colour, live, makeChoice, sources} from '#dom';
import {Fmu} from '#fmu';
import {endingOf, layOutLabels, showLegend, showStates} from '#labels';
import {Lesson} from '#lesson';
import {phasesOf} from '#phases';
import {unitsOf} from '#pictures';
import {Stage} from '#stage';
import {Table, traceOf} from '#table';
import {setUpTaking} from '#take';
import {THREE} from 'three';

$('#blocked').remove();  // its sentence is for a browser that does not come so far

const CALM = matchMedia('(prefers-reduced-motion: reduce)').matches;

/**
 * What one can look at, [{label, views: lists of wheels}]: all together, those of several files rather side by side,
 * and each alone; wheels of the lesson stand side by side.
 */
function choicesOf(wheels) {
  const beside = {label: 'Side by side', views: wheels.map((wheel) => [wheel])};
  if (live || wheels.length === 1) return [beside];
  const alone = wheels.map((wheel) => ({label: wheel.label, views: [[wheel]]}));
  const together = {label: 'Together', views: [wheels]};
  if (wheels.length > 3) return [together, ...(wheels.length <= 8 ? alone : [])];
  return [...(sources === 1 ? [together, beside] : [beside, together]), ...alone];
}

class Page {
  constructor() {
    this.player = new Player();
    this.choice = 0;
    this.plots = new Plots($('#plots'), this.player);
    this.pictures = ['slip'];  // names of pictures.js that are drawn as arrows
    this.wheels = bodies.map((wheel) => ({...wheel, table: Table.decode(wheel.columns)}));
    const latest = Math.max(...this.wheels.map(({table}) => table.end));
    for (const wheel of this.wheels) {
      this.exchange(wheel, wheel.table);
      wheel.ended = endingOf(wheel.table, latest);
    }
  }

  /** The wheels that are shown. */
  get shown() { return this.wheels.filter((wheel) => this.views.flat().includes(wheel)); }

  /** The largest outer radius of the wheels, in m. */
  get radius() { return Math.max(...this.wheels.map(({parameters: {r_0, r}}) => r_0 + r), 0) || 0.35; }

  get size() { return 2 * this.radius; }

  async start() {
    if (live) this.lesson = new Lesson(this, await Fmu.load(live));
    this.stage = new Stage($('#stage'), this.size);
    this.switches = setUpSwitches(this.stage, () => this.choose(this.choice));
    setUpTransport(this.player);
    setUpKeys(this);
    setUpTaking(this);
    this.offer();
    this.dress();
    // The colours are the system's, and on paper the light ones.
    for (const query of ['(prefers-color-scheme: dark)', 'print'])
      matchMedia(query).addEventListener('change', () => this.dress() ?? this.draw());
    this.player.addEventListener('change', () => (this.stage.dirty = true));
    new ResizeObserver(() => this.layOut()).observe($('#stage'));
    this.lesson?.begin();
    if (!CALM && this.player.t === this.player.start && !this.lesson?.guess?.asks) this.player.play();
    // The clock stands while the page is out of sight.
    document.addEventListener('visibilitychange', () => (this.ticked = undefined));
    requestAnimationFrame((now) => this.frame(now));
  }

  /** The buttons for what one can look at. */
  offer() {
    this.choices = choicesOf(this.wheels);
    const options =
        this.choices.map(({label}, name) => ({name, label, title: `Show: ${label} (key ${name + 1})`, key: name + 1}));
    $('#choice').hidden = options.length < 2;
    this.markChoice = makeChoice($('#choice'), options, (i) => this.choose(i));
  }

  /** Takes the theme's colours: every wheel is made anew. */
  dress() {
    this.stage.dress();
    this.stage.zoom(this.size);
    this.wheels.forEach((wheel, i) => (wheel.colour = colour(`--wheel-${wheel.hue ?? i % 6}`)));
    this.stage.put(this.wheels.map((wheel) => new WheelModel(wheel, this.size)));
    this.choose(this.choice);
  }

  /** Gives a wheel a motion, which is not shown yet. */
  exchange(wheel, table) {
    const {friction, parameters} = wheel;
    Object.assign(wheel, {table, phases: phasesOf(table, friction), trace: traceOf(table, parameters.r_0)});
  }

  /** Shows the motions that the wheels have now; a look may have changed with them. */
  renew() {
    const looks = (all) => JSON.stringify(all.map(({wheel: {name}, look}) => [name, look]));
    const wanted = this.wheels.map((wheel) => ({wheel, look: lookOf(wheel.parameters)}));
    if (looks(this.stage.models) !== looks(wanted)) return this.dress();
    this.stage.models.forEach((model) => model.drawPath());
    this.choose(this.choice);
  }

  /** Shows choice i: a list of views, each a list of wheels. */
  choose(i) {
    this.choice = Math.min(i, this.choices.length - 1);
    this.markChoice(this.choice);
    this.views = this.choices[this.choice].views;
    const tables = this.views.flat().map(({table}) => table);
    const end = Math.max(...tables.map(({end}) => end));
    const kept = this.plots.axis === 'fitted' ? end : Math.max(end, this.player.end);
    this.player.set({start: Math.min(...tables.map(({start}) => start)), end: kept});
    this.units = unitsOf(this.shown, this.drawn);
    this.plots.show(this.shown, this.lesson?.diagrams);
    this.layOut();
  }

  /** One label for each wheel shown, over its view. */
  layOut() {
    if (!this.views) return;
    showBands(this.shown, this.player);
    showLegend($('#legend'), this.shown, this.units);
    layOutLabels($('#labels'), this.views);
    showStates(this.shown, this.player.t);
    this.stage.resize([...$('#labels').children]);
  }

  /** What a view looks at: between its wheels if it follows, else the middle of their paths; and from how far. */
  aim(view, t) {
    const box = new THREE.Box3();
    const {slope = 0, slope_direction = 0} = view.find(({parameters}) => parameters?.slope)?.parameters ?? {};
    for (const {table} of view) {
      const path = Array.from({length: 60}, (_, k) => table.start + (k * (table.end - table.start)) / 59);
      for (const instant of this.switches.show.follow ? [t] : path)
        box.expandByPoint(new THREE.Vector3(table.value('X_O', instant), table.value('Y_O', instant), 0));
    }
    return {
      models: this.stage.models.filter((model) => view.includes(model.wheel)),
      away: Math.max(1, 0.5 + (0.5 * box.getSize(new THREE.Vector3()).length()) / this.size),
      anchor: box.getCenter(new THREE.Vector3()).setZ(0.8 * this.radius),
      heading: this.stage.place !== 'beside' && this.switches.show.follow ? view[0].table.value('psi', t) : 0,
      up: new THREE.Vector3(0, 0, 1).applyEuler(new THREE.Euler(0, slope, slope_direction, 'ZYX')),
    };
  }

  /** The clock goes on to an instant, ms from the opening of the page, however long the last picture took. */
  tick(now) {
    const before = this.ticked ?? now;
    this.ticked = Math.max(now, before);
    this.player.advance((this.ticked - before) / 1000);
  }

  frame(now) {
    this.tick(now);
    this.lesson?.frame();
    this.stage.controls.update();
    if (this.stage.dirty) this.draw();
    requestAnimationFrame((next) => this.frame(next));
  }

  /** The pictures whose arrows are drawn. */
  get drawn() { return [...this.pictures, ...(this.switches.show.force ? ['force', 'carrier'] : [])]; }

  /** The wheels where they are at the present instant; nothing is drawn. */
  pose() {
    const more = {future: !this.lesson?.guess?.asks, pictures: this.drawn, units: this.units};
    for (const model of this.stage.models)
      model.update(Math.min(this.player.t, model.wheel.table.end), {...this.switches.show, ...more});
  }

  /** Everything at the present instant. */
  draw() {
    const {t} = this.player;
    this.pose();
    const views = this.views.map((view) => this.aim(view, t));
    this.stage.render(views, Math.max(...views.map(({away}) => away)));
    this.plots.draw(t);
    showStates(this.shown, t);
    this.first ??= performance.now();  // ms from the opening of the page to its first picture
  }
}

try {
  window.page = new Page();  // for the console and the tests
  await window.page.start();
} catch (fault) {
  $('#trouble').hidden = false;
  $('#trouble').textContent = `The page could not start: ${fault.message.replace(/\.+$/, '')}.`;
  console.error(fault);
}
