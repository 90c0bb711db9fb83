// Elements of the page: found, made, and rows of radio buttons; the colours of style.css; the data.

export const $ = (selector, host = document) => host.querySelector(selector);

/**
 * What the page was made with: recorded bodies and how many files they come from, the variables of the description by
 * name, and of the lesson the wheel itself.
 */
export const {bodies, sources, variables, live} = JSON.parse($('#data').textContent);

export const DEGREES = 180 / Math.PI;  // to a radian

/** A new element with these properties and children. */
export function make(tag, properties, ...children) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}

export const makeButton = (properties, onclick) => make('button', {type: 'button', onclick, ...properties});

let groups = 0;

/**
 * Fills a row with radio buttons [{name, label, title, key}], which arrow keys move through; returns mark(name), which
 * checks one.
 */
export function makeChoice(row, options, act) {
  const group = `group_${++groups}`;
  const buttons = options.map(
      ({name, key = null}) =>
          make('input', {type: 'radio', name: group, value: name, ariaKeyShortcuts: key, onchange: () => act(name)}));
  row.replaceChildren(...options.map(
      ({label, title}, i) => make('label', {title}, buttons[i], make('span', {}, ...subscripted(label)))));
  return (chosen) => buttons.forEach((button, i) => (button.checked = options[i].name === chosen));
}

const SUBSCRIPT = /_(crit|guide|max|slide|\w(?!\w))/;  // not that of a variable's name, theta_start

/** A text such as ω_z or ω_crit as nodes, with its subscript. */
export const subscripted = (text) => text.split(SUBSCRIPT).map((part, i) => (i % 2 ? make('sub', {}, part) : part));

/** Fills boxes [x, y, width, height] with a colour. */
export const fill = (pen, fillStyle, ...boxes) =>
    boxes.forEach((box) => Object.assign(pen, {fillStyle}).fillRect(...box));

/** Writes a text with its subscripts on a canvas, beginning at x, in a font of size $; returns where it ends. */
export function write(pen, text, x, y, size, font = '$ system-ui, sans-serif') {
  text.split(SUBSCRIPT).forEach((part, i) => {
    const low = i % 2;
    pen.font = font.replace('$', `${size * (low ? 0.7 : 1)}px`);
    pen.fillText(part, x, y + 0.22 * size * low);
    x += pen.measureText(part).width;
  });
  return x;
}

/** Shows a text in an element, or hides the element; writes only what is new. */
export function say(host, text) {
  if (host.said === (text ?? '')) return;
  host.said = text ?? '';
  host.hidden = !text;
  host.replaceChildren(...subscripted(text ?? ''));
}

/** A number with the sign of mathematics, none of a zero. */
export const fixed = (value, digits) => value.toFixed(digits).replace(/^-([0.]+)$/, '$1').replace('-', '−');

/** A canvas of this size in CSS pixels, cleared, and a pen in CSS pixels. */
export function clearCanvas(canvas, width, height) {
  const ratio = Math.min(2, devicePixelRatio);
  [canvas.width, canvas.height] = [width * ratio, height * ratio];
  const pen = canvas.getContext('2d');
  pen.scale(ratio, ratio);
  return pen;
}

/** The value of a colour variable of style.css, as text. */
export const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
