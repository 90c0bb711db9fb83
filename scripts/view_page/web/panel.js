// The controls of the live page: presets, the start, and what the reader does to the wheel while it rolls.
const DEGREES = 180 / Math.PI;

/** Sliders: shown value = variable * scale. */
const START = [
  {
    name: 'theta_start',
    label: 'θ',
    unit: '°',
    scale: DEGREES,
    low: 5,
    high: 175,
    step: 0.5,
    digits: 1,
    what: 'tilt; 90° is upright'
  },
  {
    name: 'phi_dot_start',
    label: 'φ̇',
    unit: 'rad/s',
    scale: 1,
    low: -12,
    high: 12,
    step: 0.05,
    digits: 2,
    what: 'spin rate'
  },
  {
    name: 'psi_dot_start',
    label: 'ψ̇',
    unit: 'rad/s',
    scale: 1,
    low: -12,
    high: 12,
    step: 0.05,
    digits: 2,
    what: 'precession rate'
  },
];
const NOW = [
  {name: 's', label: 's', unit: 'm', scale: 1, low: 0, high: 0.1, step: 0.0005, digits: 4, what: 'rolling friction'},
  {
    name: 'M_3',
    label: 'M₃',
    unit: 'N m',
    scale: 1,
    low: -8,
    high: 8,
    step: 0.1,
    digits: 1,
    what: 'torque about the axle'
  },
  {
    name: 'M_brake',
    label: 'M<sub>b</sub>',
    unit: 'N m',
    scale: 1,
    low: 0,
    high: 8,
    step: 0.1,
    digits: 1,
    what: 'brake'
  },
];
const PUSH = 6;  // N m, of the buttons

function makeKnob(host, knob, take) {
  const label = document.createElement('label');
  label.className = 'knob';
  label.innerHTML = `<span><b><i>${knob.label}</i></b> <small>${knob.what}</small></span><output></output>` +
      `<input type="range" name="${knob.name}" min="${knob.low}" max="${knob.high}" step="${knob.step}">`;
  host.append(label);
  const [output, input] = [label.querySelector('output'), label.querySelector('input')];
  input.addEventListener('input', () => take(Number(input.value) / knob.scale));
  return (value) => {
    const shown = value * knob.scale;
    input.value = shown;
    output.textContent = `${shown.toFixed(knob.digits).replace('-', '−')} ${knob.unit}`;
  };
}

/** A button that pushes as long as it is held, by pointer or by key. */
function makePush(host, text, torque, live) {
  const button = document.createElement('button');
  button.type = 'button';
  button.className = 'push';
  button.innerHTML = text;
  host.append(button);
  let held = false;
  const press = () => {
    if (held) return;
    held = true;
    live.setNow('M_3', torque);
    live.page.player.play();
  };
  const release = () => {
    if (!held) return;
    held = false;
    live.setNow('M_3', 0);
  };
  button.addEventListener('pointerdown', (event) => {
    button.setPointerCapture(event.pointerId);
    press();
  });
  for (const kind of ['pointerup', 'pointercancel', 'blur']) button.addEventListener(kind, release);
  const isKey = (event) => event.key === ' ' || event.key === 'Enter';
  button.addEventListener('keydown', (event) => isKey(event) && press());
  button.addEventListener('keyup', (event) => isKey(event) && release());
}

/** A button for each preset, into #presets; returns a function that marks one of them, or none. */
function makePresets($, presets, live) {
  const buttons = presets.map((preset) => {
    const button = document.createElement('button');
    button.type = 'button';
    button.textContent = preset.label;
    button.addEventListener('click', () => {
      $('about').textContent = preset.about ?? '';
      mark(button);
      live.page.player.seek(0);
      live.load(preset);
      live.page.player.play();
    });
    $('presets').append(button);
    return button;
  });
  const mark = (chosen) => buttons.forEach((button) => button.setAttribute('aria-pressed', button === chosen));
  mark(buttons[0]);
  return mark;
}

/** Builds the panel; returns {show()}, called once a frame. */
export function setUpPanel(live, presets) {
  const host = document.querySelector('#live');
  host.hidden = false;
  host.innerHTML = '<h2>Begin with</h2><div id="presets"></div><p class="note" id="about"></p>' +
      '<h2>Start</h2><div id="start"></div><h2>While it rolls, from now on</h2><div id="now"></div>' +
      '<div class="row" id="push"></div>' +
      '<label class="keep"><input type="checkbox" id="keep"> Keep this motion to compare with</label>' +
      '<p class="note" id="message"></p>';
  const $ = (id) => host.querySelector(`#${id}`);
  const mark = makePresets($, presets, live);
  const knobs = (place, list, take) => list.filter(({name}) => name in live.fmu.variables)
                                           .map((knob) => [knob.name, makeKnob($(place), knob, (value) => {
                                                             mark(null);
                                                             take(knob.name, value);
                                                           })]);
  const starts = knobs('start', START, (name, value) => live.setStart(name, value));
  const nows = knobs('now', NOW, (name, value) => live.setNow(name, value));
  makePush($('push'), '◀ hold to push', -PUSH, live);
  makePush($('push'), 'hold to push ▶', PUSH, live);
  $('keep').addEventListener('change', () => live.keep($('keep').checked));
  return {
    show() {
      for (const [name, set] of starts) set(live.value(name));
      for (const [name, set] of nows) set(live.present(name));
      const steps = `${live.stop} s computed in ${live.took?.toFixed(0) ?? '…'} ms, here in the page.`;
      $('message').textContent = live.trouble ?? steps;
      $('message').classList.toggle('trouble', Boolean(live.trouble));
    },
  };
}
