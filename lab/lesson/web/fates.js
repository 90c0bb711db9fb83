// The map of fates: what becomes of a wheel in ten seconds, over the lean and the spin that it starts with, without
// precession. The pointer over a point of the map plays that wheel.
import {$, clearCanvas, colour, DEGREES, degrees} from '#dom';
import {criticalSpin} from '#mechanics';
import {extent} from '#table';

const [COLUMNS, ROWS] = [28, 14];
const MOST = 56;        // degrees of lean
const SPINS = 2;        // critical spins
const STOP = 10;        // s
const INTERVAL = 0.05;  // s
const PATIENCE = 6;     // ms of a frame for runs of the map
const FLAT = 1e-3;      // rad
const OTHER = -1;       // the fate of a run that ended before the wheel lay flat

/** The largest lean of a run in degrees, 90 where the wheel falls flat, or OTHER. */
export function fateOf(fmu, values) {
  const {table: {columns: {theta}}, ended} =
      fmu.run({values, changes: [], stop: STOP, record: ['theta'], interval: INTERVAL});
  if (ended) return Math.min(theta.at(-1), Math.PI - theta.at(-1)) < FLAT ? 90 : OTHER;
  return extent(theta.map((angle) => Math.abs(angle - Math.PI / 2)))[1] * DEGREES;
}

/** Sets up the map; returns what goes on with it, once a frame. */
export function setUpFates(live) {
  const host = $('#fates');
  const canvas = $('canvas', host);
  let [values, key, fates, size, drawn] = [{}, '', [], [1, 1], ''];
  const at = (column, row, spin) => ({
    theta_start: degrees(90 - MOST * (1 - (row + 0.5) / ROWS)),
    phi_dot_start: -Number((SPINS * spin * (column + 0.5) / COLUMNS).toPrecision(4)),
  });
  let before = '';
  canvas.onpointermove = ({offsetX, offsetY}) => {
    const [column, row] = [[offsetX, COLUMNS], [offsetY, ROWS]].map(
        ([x, count], i) => Math.min(count - 1, Math.max(0, Math.floor(x / size[i] * count))));
    if (before === `${column} ${row}`) return;
    before = `${column} ${row}`;
    live.start({...at(column, row, criticalSpin(live.parameters())), psi_dot_start: 0});
  };
  canvas.onpointerdown = canvas.onpointermove;
  const draw = (spin) => {
    size = [canvas.clientWidth, canvas.clientHeight];
    const pen = clearCanvas(canvas, ...size);
    const [width, height] = [size[0] / COLUMNS, size[1] / ROWS];
    fates.forEach((fate, i) => {
      const place = [i % COLUMNS * width, Math.floor(i / COLUMNS) * height, width + 0.5, height + 0.5];
      const fill = (name, globalAlpha) => Object.assign(pen, {globalAlpha, fillStyle: colour(name)}).fillRect(...place);
      fill(fate === OTHER ? '--slide' : fate === 90 ? '--ink' : '--above', 1);
      if (fate > 0 && fate < 90) fill('--below', fate / 90);
    });
    Object.assign(pen, {globalAlpha: 1, strokeStyle: colour('--paper'), lineWidth: 2}).setLineDash([5, 4]);
    pen.beginPath();
    pen.moveTo(size[0] / SPINS, 0);
    pen.lineTo(size[0] / SPINS, size[1]);
    pen.stroke();
    const [theta, rate] = ['theta_start', 'phi_dot_start'].map((name) => live.value(name));
    const [x, y] = [Math.abs(rate) / (SPINS * spin), 1 - Math.abs(90 - theta * DEGREES) / MOST];
    pen.setLineDash([]);
    pen.beginPath();
    pen.arc(x * size[0], y * size[1], 5, 0, 7);
    pen.stroke();
  };
  return (wheel) => {
    host.hidden = live.open || Boolean(wheel.guided);
    if (host.hidden) return;
    const spin = criticalSpin(wheel);
    const others = {...live.plan.values, psi_dot_start: 0, theta_start: 0, phi_dot_start: 0};
    if (key !== JSON.stringify(others)) [key, values, fates] = [JSON.stringify(others), others, []];
    try {
      for (const end = performance.now() + PATIENCE; fates.length < COLUMNS * ROWS && performance.now() < end;) {
        const i = fates.length;
        fates.push(fateOf(live.fmu, {...values, ...at(i % COLUMNS, Math.floor(i / COLUMNS), spin)}));
      }
    } catch {  // values that cannot be: the panel has the wheel's own sentence
      fates = Array(COLUMNS * ROWS).fill(OTHER);
    }
    const now = [
      key, fates.length, live.value('theta_start'), live.value('phi_dot_start'), canvas.clientWidth,
      document.documentElement.dataset.theme
    ].join();
    if (now !== drawn) draw(spin);
    drawn = now;
  };
}
