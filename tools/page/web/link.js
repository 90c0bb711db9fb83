// The address of the live page follows what the reader does, and the page follows the address.
import {read, write} from '#address';

const REST = 300;      // ms between two changes of the address
const PLAYING = 1000;  // the same while the clock runs: browsers refuse more than some hundred in half a minute

export class Link {
  constructor(live) {
    Object.assign(this, {live, text: null, at: 0, states: live.steps.map(({state}) => state)});
    addEventListener('hashchange', () => location.hash.slice(1) !== this.text && this.follow());
    this.follow();
  }

  /** The address of what is shown, without #. */
  write() { return write(this.live.state(), this.live.narrated ? this.live.step + 1 : null, this.states); }

  /** The whole link. */
  get href() { return `${location.href.split('#')[0]}#${this.write()}`; }

  /** Shows what the address says; a wrong one gives the first step of the story and a sentence. */
  follow() {
    this.text = location.hash.slice(1);
    try {
      const {state, step} = read(this.text || 'step=1', this.states);
      this.live.apply(state, step && step - 1);
    } catch (fault) {
      this.live.apply(this.states[0], 0);
      this.live.refusal = `This address cannot be shown: ${fault.message} Here is the first scene instead.`;
    }
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
