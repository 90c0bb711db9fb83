// What the reader sets: sliders with a number beside them, the chooser of bodies, and buttons that act while they are
// held. A run follows from the values chosen; ranges follow the wheel.
import {$, DEGREES, live, make, makeButton, subscripted, variables} from '#dom';
import {STEP} from '#fmu';
import {criticalSpin} from '#pictures';
import {roundUp} from '#table';

const KINETIC = 0.85;  // kinetic over static friction coefficient
const RAMP = 0.5;      // s, in which a brake's moment rises from step to step
const UPRIGHT = Math.PI / 2;

/** m g (r_0 + r) of a wheel over that of the paper's. */
const weight = (value) => value('m') * value('g') * (value('r_0') + value('r'));
const strength = (wheel) => weight((name) => wheel[name]) / weight((name) => variables[name].start);

/** A quantity: symbol, unit, meaning, and range(wheel): lowest, highest; step: of the slider. */
const control = (symbol, unit, what, range, limits) => ({symbol, unit, what, range, limits});

export const CONTROLS = {
  body: {what: 'body'},
  lean: control('90° − θ', '°', 'lean', () => [0.5, 75, 0.5], [0, 85]),
  spin: control(
      '−ω_z', 'rad/s', 'spin',
      (wheel) => {
        const high = roundUp(4.5 * criticalSpin(wheel));
        return [-high, high, high / 400];
      },
      [-1000, 1000]),
  s: control(
      's', 'm', 'resistance',
      ({r_0, r}) => {
        const high = roundUp(0.2 * (r_0 + r));
        return [0, high, high / 200];
      },
      [0, 100]),
  mu: control('μ_max', '', 'grip', () => [0, 1, 0.01], [0, 10]),
  brake: control('M_b', 'N m', 'brake', () => [0, 200, 1], [0, 1e4]),
  steer: control('', 'rad/s', 'steer', () => [-1, 1, 0.02], [-10, 10]),
};

/** [lowest, highest] that can be typed or stand in an address. */
export const limitsOf = (name) => CONTROLS[name].limits;

/**
 * The plan {values, changes, stop} of a run from what was chosen: lean in degrees, spin in rad/s, positive forward, s,
 * mu (static; 0: not limited), brake (N m, on a wheel in a fork, rising from 0.5 s on), steer (rad/s, in a fork, from
 * 1 s on), body; and of a step: speed, m/s, of a thrown wheel, changes, stop, fork.
 */
export function planOf(
    {lean, spin, s = 0, mu = 0, brake, steer = 0, body = 'tyre', speed, fork, changes = [], stop = 10}) {
  const {parameters} = live.bodies[body];
  const radius = parameters.r_0 + parameters.r;
  const theta = UPRIGHT - lean / DEGREES;
  const values = {...parameters, theta_start: theta, phi_dot_start: -spin, s};
  if (body !== 'tyre') values.X_O_start = -parameters.r_0 * Math.cos(theta);
  if (mu > 0) Object.assign(values, {mu_max: mu, mu_slide: KINETIC * mu});
  if (speed !== undefined) values.slip_x_start = speed - radius * spin;
  const later = [...changes];
  const parts = Math.round(RAMP / STEP);
  for (let i = 1; brake > 0 && i <= parts; ++i)
    later.push({t: 0.5 + STEP * (i - 1), name: 'M_brake', value: brake * i / parts});
  if (steer) later.push({t: 1, name: 'psi_dot_guide', value: steer});
  if (fork || steer) values.guided = 1;
  return {values, changes: later, stop};
}

/** One quantity's slider, and its number to be typed. */
function makeKnob(host, name, lesson) {
  const {symbol, unit, what, range, limits: [min, max]} = CONTROLS[name];
  const slider = make('input', {type: 'range', name, id: `slider_${name}`});
  const title = `${what}: type a number from ${min} to ${max} ${unit}`;
  const looks = {type: 'number', className: 'number', autocomplete: 'off', step: 'any', required: true, min, max};
  const number = make('input', {...looks, name: `${name}_number`, title, ariaLabel: title});
  const words = make('label', {htmlFor: slider.id}, make('b', {}, what), ' ', make('i', {}, ...subscripted(symbol)));
  host.append(make('div', {className: 'knob'}, words, slider, number, make('span', {}, unit)));
  const write = () => (number.value = Number(lesson.chosen[name].toPrecision(6)));
  let before = 0;  // a finger that scrolls the page has first moved the slider that it began on
  slider.oninput = () => lesson.set(name, Number(slider.value));
  slider.onpointerdown = () => (before = lesson.chosen[name]);
  slider.onpointercancel = () => lesson.set(name, before);
  number.onchange = () => number.reportValidity() && lesson.set(name, Number(number.value));
  number.onblur = () => number.validity.valid && write();  // else the text stays, to be mended
  number.onkeydown = ({key}) => {
    if (key === 'Escape') write();
    if (['Enter', 'Escape'].includes(key)) number.blur();
  };
  return (wheel) => {
    const [low, high, step] = range(wheel);
    Object.assign(slider, {min: low, max: high, step, title: `${what}: ${low} to ${high} ${unit}`});
    slider.value = lesson.chosen[name];
    if (document.activeElement !== number) write();
  };
}

/** The chooser of bodies. */
function makeBodies(host, lesson) {
  const options = Object.entries(live.bodies).map(([value, {title}]) => make('option', {value, title}, value));
  const select = make('select', {id: 'body', onchange: () => lesson.set('body', select.value)}, ...options);
  host.append(make('div', {className: 'knob'}, make('label', {htmlFor: 'body'}, make('b', {}, 'body')), select));
  return () => {
    select.value = lesson.chosen.body;
    select.title = live.bodies[lesson.chosen.body].title;
  };
}

/** Buttons that act while they are held: text, variable, value in parts of the torque, tooltip. */
const HELD = [
  ['◀ push back', 'M_3', 1, 'Torque about the axle, backward'],
  ['brake', 'M_brake', 1, 'A dry brake that holds, up to its torque'],
  ['push forward ▶', 'M_3', -1, 'Torque about the axle, forward'],
];
/** Their torque, N m: 6 N m for the paper's wheel, for others as their weight times radius. */
const torqueOf = (wheel) => Number((6 * strength(wheel)).toPrecision(6));

function makeHeld([text, name, part, what], lesson) {
  let before = null;  // the value to return to; null while the button is not held
  const press = ({pointerId, timeStamp}) => {
    if (before !== null) return;
    lesson.page.tick(timeStamp);  // the clock goes on to the instant at which the button was pressed, not drawn
    if (pointerId) button.setPointerCapture(pointerId);
    before = lesson.present(name);
    lesson.hold(true);
    lesson.setNow(name, part * torqueOf(lesson.wheel.parameters));
    lesson.page.player.play();
  };
  const release = ({timeStamp}) => {
    if (before === null) return;
    lesson.page.tick(timeStamp);
    lesson.setNow(name, before);
    lesson.hold(false);
    before = null;
  };
  const title = `${what}, as long as you hold it (6 N m for the paper's wheel)`;
  const button = makeButton({className: 'push', textContent: text, title});
  button.onpointerdown = press;
  button.onkeydown = (event) => {  // returns nothing: false would swallow Tab and all other keys
    if ([' ', 'Enter'].includes(event.key)) press(event);
  };
  button.onpointerup = button.onpointercancel = button.onkeyup = button.onblur = release;
  return button;
}

/** The buttons that are held stand beside the clock for good. */
export const setUpHeld = (lesson) => $('#push').append(...HELD.map((held) => makeHeld(held, lesson)));

/** The controls of a step by name in a host; returns what shows the values chosen, for a wheel's parameters. */
export function makeControls(host, names, lesson) {
  host.replaceChildren();
  $('#push').hidden = !names.includes('push');
  const shows = names.filter((name) => name !== 'push')
                    .map((name) => (name === 'body' ? makeBodies(host, lesson) : makeKnob(host, name, lesson)));
  return (wheel) => shows.forEach((show) => show(wheel));
}
