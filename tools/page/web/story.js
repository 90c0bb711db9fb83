// The card that tells the story beside the picture: text, something to try, one step on or back.

export class Story {
  constructor(host, live) {
    Object.assign(this, {host, live, step: 0, open: true});
    host.innerHTML = '<p class="count"></p><h3></h3><p class="text"></p><p class="try"></p><div class="row">' +
        '<button type="button" name="back" title="The step before (key B)">◀ Back</button>' +
        '<button type="button" name="next" title="The next step (key N)">Next ▶</button></div>';
    const button = (name) => host.querySelector(`[name=${name}]`);
    button('back').addEventListener('click', () => this.move(-1));
    button('next').addEventListener('click', () => this.move(1));
  }

  /** The story at step 1, 2 ..., or closed (null). */
  enter(step) {
    this.open = step !== null;
    if (this.open) this.step = step - 1;
  }

  /** One step on (1) or back (-1), shown from its beginning. */
  move(by) {
    const {live} = this;
    const next = this.open ? this.step + by : this.step;
    if (!live.steps[next]) return;
    this.enter(next + 1);
    const {state, names, speed} = live.steps[next];
    live.refusal = null;
    live.apply(state, names);
    live.page.player.setSpeed(speed ?? 1);
    live.page.player.play();
    this.tell();
  }

  /** Writes the step's text, with the figures of its motion. */
  tell() {
    const {live: {steps, page, panel}, host, step} = this;
    panel.turn(this.open);
    if (!this.open) return;
    const {title, text, attempt} = steps[step];
    const put = (place, html) => (host.querySelector(place).innerHTML = html);
    put('.count', `${step + 1} of ${steps.length}`);
    put('h3', title);
    put('.text', text(...page.wheels));
    put('.try', `<b>Try</b> ${attempt}`);
    host.querySelector('[name=back]').disabled = step === 0;
    host.querySelector('[name=next]').disabled = step === steps.length - 1;
  }
}
