// The controls of the live page: presets, the start, and what the reader does to the wheel while it rolls.
/** Sliders: name, symbol, unit, lowest, highest and step as shown (angles in degrees), and what it is. */
const START = [
  ['theta_start', 'θ', '°', 5, 175, 0.5, 'tilt'],
  ['phi_dot_start', 'φ̇', 'rad/s', -12, 12, 0.05, 'spin'],
  ['psi_dot_start', 'ψ̇', 'rad/s', -12, 12, 0.05, 'precession'],
];
const NOW = [
  ['s', 's', 'm', 0, 0.1, 0.0005, 'friction'],
  ['M_3', 'M₃', 'N m', -8, 8, 0.1, 'axle torque'],
  ['M_brake', 'M<sub>b</sub>', 'N m', 0, 8, 0.1, 'brake'],
];
/** Buttons that act as long as they are held: text, variable, value in N m. */
const HELD = [['◀ push', 'M_3', -6], ['brake', 'M_brake', 6], ['push ▶', 'M_3', 6]];

/** One slider; take(value in SI) when it moves. Returns a function that shows a value in SI. */
function makeKnob(host, [name, symbol, unit, low, high, step, what], take) {
  const scale = unit === '°' ? 180 / Math.PI : 1;
  const digits = Math.ceil(-Math.log10(step) - 1e-9);
  const label = document.createElement('label');
  label.className = 'knob';
  label.innerHTML = `<span><b><i>${symbol}</i></b> <small>${what}</small></span>` +
      `<input type="range" name="${name}" min="${low}" max="${high}" step="${step}"><output></output>`;
  host.append(label);
  const [output, input] = [label.querySelector('output'), label.querySelector('input')];
  input.addEventListener('input', () => take(Number(input.value) / scale));
  // A finger that scrolls the page has first moved the slider that it began on.
  let before = 0;
  input.addEventListener('pointerdown', () => (before = Number(input.value)));
  input.addEventListener('pointercancel', () => take(before / scale));
  return (value) => {
    input.value = value * scale;
    output.textContent = `${(value * scale).toFixed(digits).replace('-', '−')} ${unit}`;
  };
}

/** A button that sets a variable as long as it is held, by pointer or by key. */
function makeHeld(host, [text, name, value], live) {
  const button = document.createElement('button');
  button.type = 'button';
  button.className = 'push';
  button.textContent = text;
  host.append(button);
  let before = null;  // the value to return to; null while the button is not held
  const press = () => {
    if (before !== null) return;
    before = live.present(name);
    live.setNow(name, value);
    live.page.player.play();
  };
  const release = () => {
    if (before === null) return;
    live.setNow(name, before);
    before = null;
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
  document.body.classList.add('live');
  host.innerHTML = '<h2>Begin with</h2><div id="presets"></div><p class="note" id="about"></p>' +
      '<h2>Start</h2><div id="start"></div><h2>While it rolls, from now on</h2><div id="now"></div>' +
      '<div class="row" id="push" title="As long as you hold it"></div>' +
      '<label class="keep"><input type="checkbox" id="keep"> Keep this motion to compare with</label>' +
      '<p class="note" id="message"></p>';
  const $ = (id) => host.querySelector(`#${id}`);
  const mark = makePresets($, presets, live);
  const knobs = (place, list, change) => list.map((knob) => {
    const take = (value) => {
      mark(null);
      change(knob[0], value);
    };
    return [knob[0], makeKnob($(place), knob, take)];
  });
  const starts = knobs('start', START, (name, value) => live.setStart(name, value));
  const nows = knobs('now', NOW, (name, value) => live.setNow(name, value));
  for (const held of HELD) makeHeld($('push'), held, live);
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
