// The address of the live page follows what the reader does, and the page follows the address.
import {EMPTY, planParts, read, write} from '#address';
import {PORTRAITS} from '#diagrams';

const REST = 300;      // ms between two changes of the address
const PLAYING = 1000;  // the same while the clock runs: browsers refuse more than some hundred in half a minute

export class Link {
  constructor(live) {
    Object.assign(this, {live, text: null, at: 0, states: live.steps.map(({state}) => state)});
    addEventListener('hashchange', () => location.hash.slice(1) !== this.text && this.follow());
  }

  /** The step of the story whose motion is shown, 1, 2 ..., or null. */
  step({plan, kept}) {
    const {story} = this.live.panel;
    const there = this.states[story.step];
    const textOf = (plans) => JSON.stringify(plans.map((one) => one && planParts(one, this.live.fmu.variables)));
    return story.open && textOf([plan, kept]) === textOf([there.plan, there.kept]) ? story.step + 1 : null;
  }

  /** The address of what is shown, without #. */
  write() {
    const state = this.live.state();
    const step = this.step(state);
    return write(state, this.states[step - 1] ?? EMPTY, step, this.live.fmu.variables);
  }

  /** The whole link. */
  get href() { return `${location.href.split('#')[0]}#${this.write()}`; }

  /** Shows what the address says; a wrong one gives the first step of the story and a sentence. */
  follow() {
    const {live, states} = this;
    this.text = location.hash.slice(1);
    const open = (state, step) => {
      live.panel.story.enter(step);
      live.apply(state, live.steps[step - 1]?.names);
    };
    live.refusal = null;
    try {
      const {state, step} = read(this.text || 'step=1', states, Object.keys(PORTRAITS), live.fmu.variables);
      open(state, step);
    } catch (fault) {
      live.refusal = `This address cannot be shown: ${fault.message} Here is the first scene instead.`;
      open(states[0], 1);
    }
    live.panel.story.tell();
  }

  /** Once a frame: writes what has changed. */
  frame() {
    const now = performance.now();
    if (this.live.wanted || now - this.at < (this.live.page.player.playing ? PLAYING : REST)) return;
    this.at = now;
    const text = this.write();
    // An address that has come and is not followed yet stays, and a wrong one until the reader does something.
    if (text === this.text || this.text !== location.hash.slice(1) || (this.live.refusal && text === 'step=1')) return;
    try {
      history.replaceState(null, '', `#${text}`);
      this.text = location.hash.slice(1);  // a browser may ignore changes that come too fast
    } catch {  // a page inside another may not change its address; the button still copies the link
    }
  }
}
