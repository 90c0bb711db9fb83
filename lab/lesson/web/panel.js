// The controls of the live page: the story or the scenes to begin with, the start, and what the reader does to the
// wheel while it rolls. Each sets up its elements and returns a function that shows the present state.
import {setUpBalance} from '#balance';
import {$, DEGREES, fixed, make, makeButton, makeChoice, onChange, say, subscripted} from '#dom';
import {setUpFates} from '#fates';
import {GRIP, HELD, NOW, shownLimits, START, STEERING, torqueOf, WHEEL} from '#knobs';
import {bodies, criticalSpin} from '#mechanics';
import {scenes} from '#scenes';
import {setUpStory} from '#story';
import {slipOf, tipsByRounding} from '#table';

const NEAR = 10;  // degrees of lean, up to which the critical spin of upright rolling is a measure

/** The tabs, story or scenes, and a button for each scene. */
function setUpScenes(live) {
  const tabs = [
    {name: 'story', textContent: 'Story', title: 'What the wheel does and why, step by step; back to its wheel'},
    {name: 'scenes', textContent: 'Scenes', title: 'Scenes to begin with'},
  ];
  const markTab = makeChoice($('#live .tabs'), tabs, (name) => {
    if (name === 'story') live.turn(0);
    live.open = name === 'story';
  });
  const all = scenes(live.parameters(), live.steps);
  const options =
      all.map(({label, about = 'A scene of the paper'}, name) => ({name, textContent: label, title: about}));
  const mark = makeChoice($('#presets'), options, (scene) => {
    live.link.leave();
    say($('#about'), all[scene].about);
    live.page.player.seek(0);
    live.load(all[scene].plan);
    live.scene = scene;
    live.page.player.play();
  });
  return () => {
    markTab(live.open ? 'story' : 'scenes');
    [$('#story').hidden, $('#scenes').hidden] = [!live.open, live.open];
    mark(live.scene);
  };
}

/**
 * One quantity's slider, and its number to be typed: take(name, value in SI) when one is set, hold(on) while the slider
 * is dragged, present(name) for what they show.
 */
function makeKnob(host, knob, {take, present, hold = () => {}}) {
  const {name, symbol, unit, what, range} = knob;
  const [min, max] = shownLimits(knob);
  const scale = unit === '°' ? DEGREES : 1;
  const about = what.replace('_', '');
  const slider = make('input', {type: 'range', name, id: `slider_${name}`});
  const title = `${about}: type a number from ${min} to ${max} ${unit}`;
  const looks = {type: 'number', className: 'number', autocomplete: 'off', step: 'any', required: true, min, max};
  const number = make('input', {...looks, name: `${name}_number`, title, ariaLabel: title});
  const words = make(
      'label', {htmlFor: slider.id}, make('b', {}, make('i', {}, ...subscripted(symbol))), ' ',
      make('small', {}, ...subscripted(what)));
  host.append(make('div', {className: 'knob'}, words, slider, number, make('span', {}, unit)));
  let ratios = false;
  const place = (value) => (ratios ? Math.log10(value) : value * scale);
  const at = (position) => (ratios ? Number((10 ** position).toPrecision(3)) : position / scale);
  const write = () => {
    const value = Number((present(name) * scale).toPrecision(6));
    number.value = value && Math.abs(value) < 1e-3 ? value.toExponential() : value;  // as short as the field is wide
  };
  let before = 0;  // a finger that scrolls the page has first moved the slider that it began on
  slider.oninput = () => take(name, at(Number(slider.value)));
  slider.onpointerdown = () => {
    before = Number(slider.value);
    hold(true);
  };
  slider.onpointerup = () => hold(false);
  slider.onpointercancel = () => {
    take(name, at(before));
    hold(false);
  };
  number.onchange = () => number.reportValidity() && take(name, number.value / scale);
  number.onblur = () => number.validity.valid && write();  // else the text stays, to be mended
  number.onkeydown = ({key}) => {
    if (key === 'Escape') write();
    if (['Enter', 'Escape'].includes(key)) number.blur();
  };
  let shown = '';
  return (wheel) => {
    const [value, [from, to, step]] = [present(name), range(wheel)];
    if (shown === [value, from, to].join()) return;
    shown = [value, from, to].join();
    ratios = step === 'log';
    const [least, most] = ratios ? [from, to].map(place) : [from, to];
    Object.assign(slider, {min: least, max: most, step: ratios ? 0.01 : step});
    Object.assign(slider, {title: `${about}: ${from} to ${to} ${unit}`, value: place(value)});
    if (document.activeElement !== number) write();
  };
}

/** A button that sets a variable as long as it is held, by pointer or by key. */
function makeHeld([text, name, part, what], live) {
  let before = null;  // the value to return to; null while the button is not held
  const press = ({pointerId, timeStamp}) => {
    if (before !== null) return;
    live.page.tick(timeStamp);  // the clock goes on to the instant at which the button was pressed, not drawn
    if (pointerId) button.setPointerCapture(pointerId);
    before = live.present(name);
    live.hold(true);
    live.setNow(name, part(live.spin()) * torqueOf(live.parameters()));
    live.page.player.play();
  };
  const release = ({timeStamp}) => {
    if (before === null) return;
    live.page.tick(timeStamp);
    live.setNow(name, before);
    live.hold(false);
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

/** The list of bodies, whose moments follow from mass and radii, and of preset wheels. */
function setUpReady(live, wheels) {
  const host = $('#ready');
  const option = (kind) => ([name, {title, source}]) =>
      make('option', {value: `${kind}:${name}`, title: source}, title);
  const group = (label, kind, list) => make('optgroup', {label}, ...Object.entries(list).map(option(kind)));
  const none = make('option', {value: ''}, 'Preset bodies and wheels …');
  host.append(none, group('Bodies: J follows from m, r₀ and r', 'body', bodies), group('Wheels', 'wheel', wheels));
  host.onchange = () => {
    const [kind, name] = host.value.split(':');
    if (kind === 'body') live.setBody(name);
    if (kind === 'wheel') live.setWheel(wheels[name]);
  };
  const shown = onChange((value) => {
    host.value = value;
    host.title = host.selectedOptions[0].title || 'Preset bodies and wheels, with their sources';
  });
  const same = ([, {parameters}]) => Object.entries(parameters).every(([name, value]) => live.value(name) === value);
  return () => {
    const {plan: {body}} = live;
    const [wheel] = body ? [] : Object.entries(wheels).find(same) ?? [];
    shown(body ? `body:${body}` : wheel ? `wheel:${wheel}` : '');
  };
}

/** The switch of the wheel carrier, which turns heading and tilt at the rates of two sliders instead of the start's. */
function setUpCarrier(live) {
  const box = $('#guided');
  const rowOf = (name) => $(`#live [name=${name}]`).parentElement;
  const [precession, ...steering] = ['psi_dot_start', ...STEERING].map(rowOf);
  box.onchange = () => live.setStart('guided', Number(box.checked));
  return () => {
    box.checked = live.value('guided') > 0;
    for (const part of steering) part.hidden = !box.checked;
    precession.hidden = box.checked;
  };
}

/** Where the present spin is beside the critical one; a guided wheel has none. */
function setUpCritical(live) {
  const host = $('#critical');
  return (wheel) => {
    const [now, limit] = [(name) => live.wheel.table.value(name, live.instant()), criticalSpin(wheel)];
    const [spin, lean] = [Math.abs(now('omega_z')), Math.abs(now('theta') * DEGREES - 90)];
    const apart = live.slides ? 'slides' : lean > NEAR ? `leans by ${lean.toFixed(0)}°` : null;
    const side = spin > limit ? 'above' : 'below';
    host.dataset.side = apart ? 'none' : side;
    const [is, needed] = [`Now |ω_z| = ${spin.toFixed(2)} rad/s`, `ω_crit = ${limit.toFixed(2)} rad/s`];
    const kind = spin > limit ? 'stable' : 'unstable';
    const text = apart ? `${is}. ${needed} is for a wheel that rolls nearly upright; this one ${apart}.` :
                         `${is}, ${side} ${needed}: upright rolling on a level road is ${kind}.`;
    say(host, wheel.guided ? '' : text);
  };
}

/** The friction coefficient that rolling needs beside the static one, or the slip. */
function setUpGrip(live) {
  const host = $('#grip-now');
  const open = onChange((limited) => ($('#grip').open = limited));
  return ({mu_max, mu_slide}) => {
    open(mu_max > 0);
    const {wheel: {table}, slides} = live;
    const now = (name) => table.value(name, live.instant());
    const needed = Math.hypot(now('lambda_1'), now('lambda_2')) / now('lambda_3');
    const [along, across] = ['slip_x', 'slip_y'].map((name) => fixed(now(name), 2));
    const slip = slipOf(table, live.instant()).toFixed(2);
    host.dataset.state = slides ? 'slides' : 'rolls';
    const text = slides ?
        `It slides at ${slip} m/s (${along} along, ${across} across); the road gives μ_slide = ${mu_slide} of N.` :
        `Rolling needs μ = ${needed.toFixed(3)} now${mu_max > 0 ? `, of μ_max = ${mu_max}` : ''}.`;
    say(host, needed >= 0 ? text : '');
  };
}

/** The message on the last run and on a wrong address, and the box that keeps a motion. */
function setUpNotes(live) {
  const [keep, message, refusal, doubt] = ['#keep', '#message', '#refusal', '#doubt'].map((place) => $(place));
  keep.onchange = () => live.keep(keep.checked);
  return (wheel) => {
    keep.checked = Boolean(live.kept);
    const seconds = Number(live.wheel.table.end.toPrecision(4));
    say(message, live.trouble ?? `${seconds} s computed in ${live.took.toFixed(0)} ms, here in the page.`);
    message.classList.toggle('trouble', Boolean(live.trouble));
    say(refusal, live.refusal);
    const chance = tipsByRounding(live.wheel.table) &&
        'Rounding alone tips this exactly upright wheel and decides time and side. On its wheel carrier (guided) it stays upright.';
    say(doubt, chance || '');
  };
}

/** Builds the panel; returns what shows the present state, once a frame. */
export function setUpPanel(live, wheels) {
  $('#live').hidden = false;
  document.body.classList.add('live');
  const start = {take: live.setStart.bind(live), present: live.value.bind(live)};
  const now = {take: live.setNow.bind(live), present: live.present.bind(live), hold: live.hold.bind(live)};
  const knobs = [
    ['#start', START, start], ['#grip', GRIP, start], ['#wheel', WHEEL, start], ['#now', NOW, now]
  ].flatMap(([place, list, acts]) => list.map((knob) => makeKnob($(place), knob, acts)));
  $('#push').append(...HELD.map((held) => makeHeld(held, live)));
  const ready = setUpReady(live, wheels);
  const all = [
    setUpStory(live), setUpScenes(live), setUpFates(live), ready, setUpCarrier(live), setUpCritical(live),
    setUpGrip(live), setUpBalance(live), setUpNotes(live), ...knobs
  ];
  return () => {
    const wheel = live.parameters();
    all.forEach((show) => show(wheel));
  };
}
