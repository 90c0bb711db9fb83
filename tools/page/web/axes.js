// What every diagram shares: round numbers along an axis, the frame, and a canvas as sharp as the screen.
import {colour} from '#theme';

export const MARGIN = {
  left: 46,
  right: 8,
  top: 10,
  bottom: 20
};

/** Round numbers, at most about `count` of them, that span low to high. */
export function ticksOf(low, high, count) {
  const raw = (high - low) / Math.max(1, count);
  const power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((size) => size >= raw) ?? 10 * power;
  const ticks = [];
  for (let tick = Math.ceil(low / step - 1e-9) * step; tick <= high + 1e-9 * step; tick += step) ticks.push(tick);
  return {ticks, digits: Math.max(0, -Math.floor(Math.log10(step) + 1e-9))};
}

/** The smallest and the largest of some values, or [Infinity, -Infinity]. */
export function extent(values) {
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) {
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return [low, high];
}

/** The bounds of an axis that shows low to high; what hardly changes is a line, not its last digit. */
export function bounds(low, high) {
  if (!(low <= high)) return [0, 1];
  const least = 1e-3 * Math.max(1, Math.abs(low), Math.abs(high));
  const pad = 0.06 * Math.max(high - low, least) + 0.5 * Math.max(0, least - (high - low));
  return [low - pad, high + pad];
}

/**
 * Bounds that hold low to high and change as seldom as possible: those before, where they are wide enough, else widened
 * by a quarter of their span beyond what is asked for.
 */
export function widened([before, after], low, high) {
  const reserve = 0.25 * (Math.max(high, after) - Math.min(low, before));
  return [low < before ? low - reserve : before, high > after ? high + reserve : after];
}

/** Fits canvases to the size and the sharpness of the one on the page; returns {width, height, ratio} in CSS pixels. */
export function fit(shown, canvases) {
  const {clientWidth: width, clientHeight: height} = shown;
  const ratio = Math.min(2, devicePixelRatio);
  for (const canvas of canvases) [canvas.width, canvas.height] = [width * ratio, height * ratio];
  return {width, height, ratio};
}

/** A pen in CSS pixels for a canvas of `fit`. */
export function penOf(canvas, ratio) {
  const pen = canvas.getContext('2d');
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  return pen;
}

function prepare(pen) {
  pen.font = '11px system-ui, sans-serif';
  pen.lineWidth = 1;
  pen.strokeStyle = colour('--rule');
  pen.fillStyle = colour('--soft');
}

/** Grid and numbers of the vertical axis. y: from a value to CSS pixels. */
export function drawLevels(pen, [low, high], y, {width, height}) {
  const {ticks, digits} = ticksOf(low, high, Math.min(5, height / 26));
  prepare(pen);
  pen.textAlign = 'right';
  pen.textBaseline = 'middle';
  for (const tick of ticks) {
    const level = Math.round(y(tick)) + 0.5;
    pen.beginPath();
    pen.moveTo(MARGIN.left, level);
    pen.lineTo(width - MARGIN.right, level);
    pen.stroke();
    pen.fillText(tick.toFixed(digits), MARGIN.left - 6, level);
  }
}

/** Numbers of the horizontal axis, the last with its unit; with `grid` lines too. x: from a value to CSS pixels. */
export function drawColumns(pen, [low, high], x, {width, height}, unit, grid = false) {
  const {ticks, digits} = ticksOf(low, high, Math.min(6, width / 48));
  prepare(pen);
  pen.textAlign = 'center';
  pen.textBaseline = 'top';
  for (const tick of ticks) {
    const text = tick.toFixed(digits);
    const last = tick === ticks.at(-1) && unit;
    pen.fillText(last ? `${text} ${unit}` : text, Math.min(x(tick), width - 14), height - 15);
    if (!grid) continue;
    const line = Math.round(x(tick)) + 0.5;
    pen.beginPath();
    pen.moveTo(line, MARGIN.top);
    pen.lineTo(line, height - MARGIN.bottom);
    pen.stroke();
  }
}

/** A symbol such as ω_z in HTML. */
export function symbolOf(text) { return text.replace(/_(.)/g, '<sub>$1</sub>'); }
