// The address of the live page follows what the reader does, and the page follows the address.
import {EMPTY, planParts, read, write} from '#address';
import {PORTRAITS} from '#diagrams';

const REST = 300;      // ms between two changes of the address
const PLAYING = 1000;  // the same while the clock runs: browsers refuse more than some hundred in half a minute

export class Link {
  constructor(live) {
    Object.assign(this, {live, text: null, at: 0});
    addEventListener('hashchange', () => location.hash.slice(1) !== this.text && this.follow());
  }

  /** The step of the story whose motion is shown, 1, 2 ..., or null. */
  step(state) {
    const {story, fmu: {variables}} = {...this.live.panel, fmu: this.live.fmu};
    if (!story.open) return null;
    const same = (a, b) =>
        JSON.stringify(a && planParts(a, variables)) === JSON.stringify(b && planParts(b, variables));
    const {state: there} = this.live.steps[story.step];
    return same(state.plan, there.plan) && same(state.kept, there.kept) ? story.step + 1 : null;
  }

  /** The address of what is shown, without #. */
  write() {
    const state = this.live.state();
    const step = this.step(state);
    const base = step ? this.live.steps[step - 1].state : EMPTY;
    return write(state, base, step, this.live.fmu.variables);
  }

  /** The whole link. */
  get href() { return `${location.href.split('#')[0]}#${this.write()}`; }

  /** Shows what the address says; a wrong one gives the first step of the story and a sentence. */
  follow() {
    const {live} = this;
    this.text = location.hash.slice(1);
    live.refusal = null;
    try {
      const names = PORTRAITS.map(({name}) => name);
      const states = live.steps.map(({state}) => state);
      const {state, step} = this.text ? read(this.text, states, names, live.fmu.variables) : {step: 1};
      live.panel.story.enter(step);
      live.apply(state ?? states[0], step ? live.steps[step - 1].names : []);
    } catch (fault) {
      live.refusal = `This address cannot be shown: ${fault.message} Here is the first scene instead.`;
      live.panel.story.enter(1);
      live.apply(live.steps[0].state);
    }
    live.panel.story.tell();
  }

  /** Once a frame: writes what has changed. */
  frame() {
    const now = performance.now();
    if (this.live.wanted || now - this.at < (this.live.page.player.playing ? PLAYING : REST)) return;
    this.at = now;
    const text = this.write();
    if (text === this.text) return;
    if (this.live.refusal && this.text === location.hash.slice(1) && text === 'step=1') return;
    this.text = text;
    try {
      history.replaceState(null, '', `#${text}`);
    } catch {  // a page inside another may not change its address; the button still copies the link
    }
  }
}
