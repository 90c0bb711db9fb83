// The clock of the page: play, pause, speed, seek. Time in s.

export const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4];

export class Player extends EventTarget {
  constructor() {
    super();
    this.t = 0;
    this.start = 0;
    this.end = 1;
    this.speed = 1;
    this.playing = false;
  }

  /** The span of time that can be shown; t stays inside. */
  span(start, end) {
    [this.start, this.end] = [start, end];
    this.seek(this.t);
  }

  seek(t) {
    this.t = Math.min(this.end, Math.max(this.start, t));
    this.tell('time');
  }

  play() {
    if (this.t >= this.end) this.t = this.start;
    this.playing = true;
    this.tell('state');
  }

  pause() {
    this.playing = false;
    this.tell('state');
  }

  toggle() {
    if (this.playing)
      this.pause();
    else
      this.play();
  }

  setSpeed(speed) {
    this.speed = speed;
    this.tell('state');
  }

  /** The next faster (+1) or slower (-1) speed. */
  shift(direction) {
    const i = SPEEDS.indexOf(this.speed) + direction;
    if (i >= 0 && i < SPEEDS.length) this.setSpeed(SPEEDS[i]);
  }

  /** A frame that lasted dt seconds of the reader's time. */
  advance(dt) {
    if (!this.playing) return;
    this.seek(this.t + Math.min(dt, 0.1) * this.speed);
    if (this.t >= this.end) this.pause();
  }

  tell(what) { this.dispatchEvent(new Event(what)); }
}
