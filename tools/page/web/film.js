// Pictures of what is shown: the scene with its labels above, the diagrams beneath, as one PNG or as frames of a film.
import {short} from '#labels';
import {colour} from '#theme';

const FORMATS = ['video/webm;codecs=vp9', 'video/webm;codecs=vp8', 'video/webm'];
const GAP = 10;  // CSS pixels

/** The film format that this browser records, or undefined. */
export const filmFormat = () =>
    window.MediaRecorder ? FORMATS.find((format) => MediaRecorder.isTypeSupported(format)) : undefined;

/** A text such as "ω_z rad/s" with its subscript; returns its width. */
function write(pen, text, x, y, size) {
  let at = x;
  for (const [i, part] of text.split('_').entries()) {
    const [low, rest] = i === 0 ? ['', part] : [part[0], part.slice(1)];
    pen.font = `${0.72 * size}px system-ui, sans-serif`;
    if (low) pen.fillText(low, at, y + 0.22 * size);
    at += low ? pen.measureText(low).width : 0;
    pen.font = `${size}px system-ui, sans-serif`;
    pen.fillText(rest, at, y);
    at += pen.measureText(rest).width;
  }
  return at - x;
}

function drawLabels(pen, page) {
  pen.textBaseline = 'middle';
  page.stage.rectangles(page.views.length).forEach(({x, y}, v) => {
    page.shown.filter((wheel) => page.views[v].includes(wheel)).forEach((wheel, i) => {
      const line = y + 24 + 26 * i;
      pen.fillStyle = wheel.colour;
      pen.beginPath();
      pen.arc(x + 22, line, 6, 0, 7);
      pen.fill();
      pen.fillStyle = colour('--ink');
      const state = {sticks: 'held: ω_z = 0', ended: short(wheel.ended ?? '')}[wheel.tag.dataset.state];
      write(pen, [wheel.label, state].filter(Boolean).join(' – '), x + 36, line, 15);
    });
  });
}

/** One picture of the page at the present instant, on a canvas that is made or used again. */
export function compose(page, canvas = document.createElement('canvas')) {
  const ratio = page.stage.renderer.getPixelRatio();
  const {clientWidth: width, clientHeight: height} = page.stage.canvas;
  const host = document.querySelector('#plots').getBoundingClientRect();
  const scale = (width - GAP) / host.width;
  const size = [width, height + GAP + scale * host.height + GAP].map((edge) => 2 * Math.round(ratio * edge / 2));
  if (canvas.width !== size[0] || canvas.height !== size[1]) [canvas.width, canvas.height] = size;
  const pen = canvas.getContext('2d', {alpha: false});
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.fillStyle = colour('--paper');
  pen.fillRect(0, 0, canvas.width, canvas.height);
  pen.drawImage(page.stage.canvas, 0, 0, width, height);
  drawLabels(pen, page);
  pen.textAlign = 'right';
  pen.fillText(`t = ${page.player.t.toFixed(2)} s`, width - 16, height - 20);
  pen.textAlign = 'left';
  for (const plot of [...page.plots.plots, page.plots.portrait]) {
    if (plot.figure.hidden) continue;
    const place = plot.canvas.getBoundingClientRect();
    const [x, y] = [scale * (place.left - host.left), height + GAP + scale * (place.top - host.top)];
    pen.drawImage(plot.canvas, x, y, scale * place.width, scale * place.height);
    pen.fillStyle = colour('--ink');
    write(pen, plot.title, x + 6, y - 10 * scale, 13 * scale);
  }
  return canvas;
}

/** Records the motion from its start to its end, at the speed of the clock; done(blob) at the end. */
export class Film {
  constructor(page, done) {
    Object.assign(this, {page, canvas: compose(page), parts: []});
    const {player} = page;
    this.recorder =
        new MediaRecorder(this.canvas.captureStream(30), {mimeType: filmFormat(), videoBitsPerSecond: 8_000_000});
    this.recorder.addEventListener('dataavailable', ({data}) => this.parts.push(data));
    this.recorder.addEventListener('stop', () => done(new Blob(this.parts, {type: 'video/webm'})));
    player.seek(player.start);
    page.draw();
    this.recorder.start();
    player.play();
  }

  /** Once for each picture of the page; false when the film has ended. */
  frame() {
    compose(this.page, this.canvas);
    if (this.page.player.playing) return true;
    this.stop();
    return false;
  }

  stop() {
    if (this.recorder.state !== 'inactive') this.recorder.stop();
  }
}
