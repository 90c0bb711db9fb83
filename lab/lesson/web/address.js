// A link is a step of the lesson and what was chosen there: #step=3&spin=4&lean=10. Values are those of the controls
// that the step has, as they show them; without a step it is free play. What is not there is as the step begins.
import {CONTROLS, limitsOf} from '#controls';
import {live} from '#dom';

const REST = 400;  // ms between two changes of the address: browsers refuse more than some hundred in half a minute
const NUMBER = /^[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?$/;

/** Ends the reading with one sentence for the reader. */
function refuse(sentence) { throw new Error(sentence); }

function valueOf(name, text) {
  if (name === 'body')
    return Object.hasOwn(live.bodies, text) ? text : refuse(`there is no body ${text.slice(0, 20)}.`);
  if (!NUMBER.test(text)) refuse(`${name} = ${text.slice(0, 20)} is no number.`);
  const [low, high] = limitsOf(name);
  const value = Number(text);
  return value >= low && value <= high ? value : refuse(`${name} = ${value} is not between ${low} and ${high}.`);
}

/** {step: 0, 1 ..., chosen: {name: value}} of an address without #; throws one sentence. */
export function read(text, steps) {
  const {step, ...given} = Object.fromEntries(new URLSearchParams(text.replaceAll('+', '%2B')));
  const number = step ?? (Object.keys(given).length ? steps.length : 1);
  const found = steps[number - 1] ?? refuse(`there is no step ${String(step).slice(0, 20)}.`);
  const chosen = Object.entries(given).map(([name, value]) => {
    if (!Object.hasOwn(CONTROLS, name) || !found.controls.includes(name))
      refuse(`step ${number} has no ${name.slice(0, 30)} to set.`);
    return [name, valueOf(name, value)];
  });
  return {step: number - 1, chosen: Object.fromEntries(chosen)};
}

/** The address, without #, of a step 0, 1 ... with chosen values. */
export function write(step, chosen, defaults) {
  const changed = Object.entries(chosen).filter(([name, value]) => value !== defaults[name]);
  return [['step', step + 1], ...changed].map((part) => part.join('=')).join('&');
}

/** The address of the page follows what the reader does, and the page follows the address. */
export class Link {
  constructor(lesson) {
    Object.assign(this, {lesson, text: null, at: 0});
    addEventListener('hashchange', () => location.hash.slice(1) !== this.text && this.follow());
    this.follow();
  }

  write() {
    const {step, chosen, steps} = this.lesson;
    return write(step, chosen, steps[step].start);
  }

  /** Writes an address, which a page inside another may not. */
  put(text, how = 'replaceState') {
    try {
      history[how](null, '', `#${text}`);
      this.text = location.hash.slice(1);  // a browser may ignore changes that come too fast
    } catch {
    }
  }

  /** The step that is shown stays a place of the browser's history. */
  leave() { this.put(this.write()); }

  /** The one that has come is another, in the address at once: the way back is a change of it. */
  arrive() { this.put(this.write(), 'pushState'); }

  /** Shows what the address says; a wrong one gives the first step and a sentence. */
  follow() {
    this.text = location.hash.slice(1);
    const {lesson} = this;
    try {
      const {step, chosen} = read(this.text, lesson.steps);
      lesson.open(step, chosen);
    } catch (fault) {
      lesson.open(0);
      lesson.refusal = `This address cannot be shown: ${fault.message} Here is the first step instead.`;
    }
  }

  /** Once a frame: writes what has changed. */
  frame() {
    const now = performance.now();
    if (this.lesson.wanted || now - this.at < REST) return;
    this.at = now;
    const text = this.write();
    // An address that has come and is not followed yet stays, and a wrong one until the reader does something.
    if (text === this.text || this.text !== location.hash.slice(1) || (this.lesson.refusal && text === 'step=1'))
      return;
    this.put(text);
  }
}
