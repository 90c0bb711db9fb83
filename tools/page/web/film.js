// Pictures of what is shown: the scene with its labels above, the diagrams beneath, as one PNG or as a film, whose
// pictures are drawn at instants of the motion and encoded as WebM.
import {short} from '#labels';
import {colour} from '#theme';

const CODECS = {
  V_VP9: 'vp09.00.51.08',
  V_VP8: 'vp8'
};
const RATE = 30;         // pictures per second of the film
const BITS = 8_000_000;  // per second
const KEY = 60;          // pictures from one that stands alone to the next
const GAP = 10;          // CSS pixels

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
  for (const plot of page.plots.all) {
    if (plot.figure.hidden) continue;
    const place = plot.canvas.getBoundingClientRect();
    const [x, y] = [scale * (place.left - host.left), height + GAP + scale * (place.top - host.top)];
    pen.drawImage(plot.canvas, x, y, scale * place.width, scale * place.height);
    pen.fillStyle = colour('--ink');
    write(pen, plot.title, x + 6, y - 10 * scale, 13 * scale);
  }
  return canvas;
}

/**
 * An element of a WebM file: its id, eight bytes of length, its content: a list of parts, a text, or a whole number.
 */
function element(id, content) {
  const digits = id.toString(16);
  const name = Uint8Array.from(digits.match(/../g), (byte) => parseInt(byte, 16));
  const number = (value) => {
    const bytes = new Uint8Array(8);
    new DataView(bytes.buffer).setBigUint64(0, BigInt(value));
    return bytes;
  };
  const parts = typeof content === 'string' ? [new TextEncoder().encode(content)] :
      Array.isArray(content)                ? content :
                                              [number(content)];
  const body = new Blob(parts);
  const length = number(body.size);
  length[0] = 1;  // eight bytes
  return new Blob([name, length, body]);
}

/** A WebM file of pictures [{data, time: ms, key}] in a codec, `duration` ms long. */
function webm(codec, [width, height], pictures, duration) {
  const seconds = new Uint8Array(8);
  new DataView(seconds.buffer).setFloat64(0, duration);
  const clusters = [];
  for (const {data, time, key} of pictures) {
    if (key) clusters.push({time, blocks: []});
    const cluster = clusters.at(-1);
    const head = new DataView(new ArrayBuffer(4));
    head.setUint8(0, 0x81);  // track 1
    head.setInt16(1, time - cluster.time);
    head.setUint8(3, key ? 0x80 : 0);
    cluster.blocks.push(element(0xa3, [head, data]));
  }
  const info =
      [element(0x2ad7b1, 1_000_000), element(0x4489, [seconds]), element(0x4d80, 'wheel'), element(0x5741, 'wheel')];
  const video = element(0xe0, [element(0xb0, width), element(0xba, height)]);
  const track = [element(0xd7, 1), element(0x73c5, 1), element(0x83, 1), element(0x86, codec), video];
  return new Blob(
      [
        element(0x1a45dfa3, [element(0x4282, 'webm'), element(0x4287, 4), element(0x4285, 2)]),
        element(
            0x18538067,
            [
              element(0x1549a966, info),
              element(0x1654ae6b, [element(0xae, track)]),
              ...clusters.map(({time, blocks}) => element(0x1f43b675, [element(0xe7, time), ...blocks])),
            ]),
      ],
      {type: 'video/webm'});
}

/**
 * {add(draw, k), end(count)}: draws the k-th picture and encodes it at its instant, where the browser has WebCodecs.
 */
async function encoder(canvas) {
  const {width, height} = canvas;
  const settings = {width, height, bitrate: BITS, framerate: RATE};
  const pictures = [];
  const output = (chunk) => {
    const data = new Uint8Array(chunk.byteLength);
    chunk.copyTo(data);
    pictures.push({data, time: Math.round(chunk.timestamp / 1000), key: chunk.type === 'key'});
  };
  for (const [name, codec] of Object.entries(window.VideoEncoder ? CODECS : {})) {
    if (!(await VideoEncoder.isConfigSupported({...settings, codec})).supported) continue;
    const inner = new VideoEncoder({output, error: console.error});
    inner.configure({...settings, codec});
    const add = (draw, k) => {
      draw();
      const picture = new VideoFrame(canvas, {timestamp: Math.round(1e6 * k / RATE)});
      inner.encode(picture, {keyFrame: k % KEY === 0});
      picture.close();
    };
    return {add, end: (count) => inner.flush().then(() => webm(name, [width, height], pictures, 1000 * count / RATE))};
  }
  return null;
}

/** The same by MediaRecorder, whose clock runs only while a picture is drawn and shown to it. */
function recorder(canvas) {
  const inner = new MediaRecorder(canvas.captureStream(RATE), {mimeType: 'video/webm', videoBitsPerSecond: BITS});
  const parts = [];
  inner.addEventListener('dataavailable', ({data}) => parts.push(data));
  inner.start();
  inner.pause();
  const pen = canvas.getContext('2d');
  const add = async (draw) => {
    draw();
    inner.resume();
    const begin = performance.now();
    pen.resetTransform();
    pen.drawImage(canvas, 0, 0);  // the browser takes what was drawn since its last picture of the page
    await new Promise(requestAnimationFrame);
    await new Promise((done) => setTimeout(done, 1000 / RATE - (performance.now() - begin)));
    inner.pause();
  };
  const end = () => new Promise((done) => {
    inner.addEventListener('stop', () => done(new Blob(parts, {type: 'video/webm'})));
    inner.stop();
  });
  return {add, end};
}

/** Whether this browser makes films. */
export const films = () => Boolean(window.VideoEncoder) || Boolean(window.MediaRecorder?.isTypeSupported('video/webm'));

/**
 * A film of the motion from its start to its end at the speed of the clock, as a Blob, however long a picture takes to
 * draw; going() false: it ends there.
 */
export async function film(page, going) {
  const {player} = page;
  const {start, end, speed, t} = player;
  player.pause();
  player.seek(start);
  page.draw();
  const canvas = compose(page);
  const writer = await encoder(canvas) ?? recorder(canvas);
  const count = Math.floor((end - start) / speed * RATE) + 1;
  let k = 0;
  for (; k < count && going(); ++k) {
    player.seek(start + k * speed / RATE);
    page.draw();
    await writer.add(() => compose(page, canvas), k);
    await new Promise((next) => setTimeout(next));  // the page stays alive
  }
  player.seek(t);
  return writer.end(k);
}
