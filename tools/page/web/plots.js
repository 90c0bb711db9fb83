// All diagrams: the curves over time, and beside them one portrait. They share the clock and, while the reader pushes
// the wheel, keep their axes.
import {Curve, SIGNALS} from '#curve';
import {Portrait} from '#portrait';

export class Plots {
  constructor(host, player) {
    Object.assign(this, {player, wheels: [], axis: 'fitted'});
    this.plots = SIGNALS.map((signal) => new Curve(signal, host, player));
    this.portrait = new Portrait(host, player);
    new ResizeObserver(() => this.prepare()).observe(host);
  }

  /** wheels: [{table, phases, colour}], those that are shown. */
  show(wheels) {
    this.wheels = wheels;
    this.prepare();
  }

  prepare() {
    for (const plot of this.plots) plot.take(this.wheels);  // all of them first: they share the width
    this.portrait.take(this.wheels, this.axis);
    for (const plot of this.plots) plot.prepare(this.axis);
    this.draw(this.player.t);
  }

  draw(t) {
    if (this.axis === 'held' && this.plots.some((plot) => plot.leaves(t))) {
      for (const plot of this.plots) plot.prepare('held');
      this.portrait.prepare('held');
    }
    for (const plot of this.plots) plot.draw(t);
    this.portrait.draw(t);
  }
}
