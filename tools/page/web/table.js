// One motion as columns over time (SI, fixed axes X, Y, Z, Z up), and its values between the rows.
// Angles are never wrapped, so between two rows they are interpolated as numbers, not as attitudes: a slerp would take
// the short way round, and a fast wheel would seem to run backwards.

/** Bytes of a base64 text. */
export function bytesOf(text) { return Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0)); }

export class Table {
  /** columns: {name: Float64Array}, all of one length, `time` rising. */
  constructor(columns) {
    this.columns = columns;
    this.time = columns.time;
    this.rows = this.time.length;
    this.last = 0;
  }

  /** From base64 of little-endian doubles, as the page carries them. */
  static decode(texts) {
    const columns = {};
    for (const [name, text] of Object.entries(texts)) columns[name] = new Float64Array(bytesOf(text).buffer);
    return new Table(columns);
  }

  has(name) { return name in this.columns; }

  get start() { return this.time[0]; }

  get end() { return this.time[this.rows - 1]; }

  /** The row at or before t, at most the last but one. */
  row(t) {
    const {time, rows} = this;
    let i = this.last;
    if (!(time[i] <= t && t < time[Math.min(i + 1, rows - 1)])) {
      let low = 0;
      let high = rows - 1;
      while (high - low > 1) {
        const middle = (low + high) >> 1;
        if (time[middle] <= t)
          low = middle;
        else
          high = middle;
      }
      i = low;
    }
    this.last = Math.max(0, Math.min(i, rows - 2));
    return this.last;
  }

  /**
   * A column at t: the cubic through both rows' values and rates where the column `<name>_dot` is there, else a line.
   */
  value(name, t) {
    const values = this.columns[name];
    const i = this.row(t);
    const h = this.time[i + 1] - this.time[i];
    const x = h > 0 ? Math.min(1, Math.max(0, (t - this.time[i]) / h)) : 1;
    const [a, b] = [values[i], values[i + 1]];
    const rates = this.columns[`${name}_dot`];
    if (!rates) return a + x * (b - a);
    const y = 1 - x;
    return a * y * y * (1 + 2 * x) + b * x * x * (3 - 2 * x) + h * x * y * (y * rates[i] - x * rates[i + 1]);
  }
}

/** Contact with the ground, O - (r_0 + r sin theta) e2 - r cos theta e3, seen from above; r drops out. */
export function contactOf(r_0, X_O, Y_O, psi, theta) {
  const across = r_0 * Math.cos(theta);
  return [X_O + across * Math.sin(psi), Y_O - across * Math.cos(psi)];
}
