// Pictures of the page: the scene with its labels above, the diagrams beneath, as one PNG or as a video, whose
// pictures are drawn at instants of the motion and written into a WebM file with these instants.
import {$, colour, make, write} from '#dom';

const RATE = 25;         // pictures per second
const BITS = 8_000_000;  // per second
const CODEC = 'vp09.00.51.08';
const KEY = 60;  // pictures from one that stands alone to the next
const GAP = 10;  // CSS pixels

/** Whether this browser encodes films. */
export async function encodes() {
  return (await window.VideoEncoder?.isConfigSupported({codec: CODEC, width: 640, height: 360}))?.supported;
}

/** The wheels' labels where they stand over the scene. */
function drawLabels(pen, {stage, shown}) {
  const scene = stage.canvas.getBoundingClientRect();
  for (const {tag, label, colour: fillStyle} of shown) {
    const {x, y, height} = tag.getBoundingClientRect();
    const [left, line] = [x - scene.x + 12, y - scene.y + height / 2];
    Object.assign(pen, {fillStyle}).beginPath();
    pen.arc(left + 6, line, 6, 0, 7);
    pen.fill();
    pen.fillStyle = colour('--ink');
    write(pen, [label, tag.title].filter(Boolean).join(' – '), left + 20, line, 15);
  }
}

/** One picture of the page at the present instant, on a canvas that is made or used again. */
export function compose(page, canvas = make('canvas')) {
  const {stage, plots, player} = page;
  const {ratio} = stage;
  const {clientWidth: width, clientHeight: height} = stage.canvas;
  const host = $('#plots').getBoundingClientRect();
  const scale = (width - GAP) / host.width;
  const size = [width, height + GAP + scale * host.height + GAP].map((edge) => 2 * Math.round(ratio * edge / 2));
  if (canvas.width !== size[0] || canvas.height !== size[1]) [canvas.width, canvas.height] = size;
  const pen = canvas.getContext('2d', {alpha: false});
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.fillStyle = colour('--paper');
  pen.fillRect(0, 0, canvas.width, canvas.height);
  pen.drawImage(stage.canvas, 0, 0, width, height);
  Object.assign(pen, {textBaseline: 'middle', textAlign: 'left'});
  drawLabels(pen, page);
  write(pen, `t = ${player.t.toFixed(2)} s`, width - 106, height - 20, 15);
  for (const plot of plots.all.filter(({figure}) => !figure.hidden)) {
    const place = plot.canvas.getBoundingClientRect();
    const [x, y] = [scale * (place.left - host.left), height + GAP + scale * (place.top - host.top)];
    pen.drawImage(plot.canvas, x, y, scale * place.width, scale * place.height);
    write(pen, plot.title, x + 6, y - 10 * scale, 13 * scale);
  }
  return canvas;
}

/** Eight bytes of a whole number, or of a real one. */
function bytes(value, real = false) {
  const view = new DataView(new ArrayBuffer(8));
  real ? view.setFloat64(0, value) : view.setBigUint64(0, BigInt(value));
  return new Uint8Array(view.buffer);
}

/** An element of a WebM file: id, length in eight bytes, and content: texts, bytes, whole numbers, other elements. */
function element(id, ...content) {
  const body = new Blob(content.map((part) => (typeof part === 'number' ? bytes(part) : part)));
  const length = bytes(body.size);
  length[0] = 1;  // eight bytes
  return new Blob([bytes(id).slice(id < 256 ? 7 : id < 65536 ? 6 : id < 2 ** 24 ? 5 : 4), length, body]);
}

/** A WebM file of pictures [{data, time: ms, key}] in VP9, `duration` ms long. */
function webm({width, height}, pictures, duration) {
  const clusters = pictures.map(({data, time, key}) => {
    const head = Uint8Array.of(0x81, 0, 0, key ? 0x80 : 0);  // track 1, at the time of the cluster, whether a key
    return element(0x1f43b675, element(0xe7, time), element(0xa3, head, data));
  });
  const header = element(0x1a45dfa3, element(0x4282, 'webm'), element(0x4287, 4), element(0x4285, 2));
  const names = [element(0x4d80, 'wheel'), element(0x5741, 'wheel')];
  const info = element(0x1549a966, element(0x2ad7b1, 1_000_000), element(0x4489, bytes(duration, true)), ...names);
  const video = element(0xe0, element(0xb0, width), element(0xba, height));
  const track = [element(0xd7, 1), element(0x73c5, 1), element(0x83, 1), element(0x86, 'V_VP9'), video];
  const segment = element(0x18538067, info, element(0x1654ae6b, element(0xae, ...track)), ...clusters);
  return new Blob([header, segment], {type: 'video/webm'});
}

/**
 * A video of the motion from its start to its end at the speed of the clock, as a Blob, however long a picture takes to
 * draw. left(seconds): called before each picture with the time that the rest will take; false ends it.
 */
export async function film(page, left) {
  const {start, end, speed, t} = page.player;
  const [canvas, pictures] = [make('canvas'), []];
  const output = (chunk) => {
    const data = new Uint8Array(chunk.byteLength);
    chunk.copyTo(data);
    pictures.push({data, time: Math.round(chunk.timestamp / 1000), key: chunk.type === 'key'});
  };
  const encoder = new VideoEncoder({output, error: console.error});
  page.player.pause();
  const count = Math.floor((end - start) / speed * RATE) + 1;
  const begin = performance.now();
  let k = 0;
  for (; k < count && left((performance.now() - begin) / 1000 / k * (count - k)); ++k) {
    page.player.seek(start + k * speed / RATE);
    page.draw();
    const {width, height} = compose(page, canvas);
    if (k === 0) encoder.configure({codec: CODEC, width, height, bitrate: BITS, framerate: RATE});
    const picture = new VideoFrame(canvas, {timestamp: Math.round(1e6 * k / RATE)});
    encoder.encode(picture, {keyFrame: k % KEY === 0});
    picture.close();
    await new Promise((next) => setTimeout(next));  // the page stays alive
  }
  page.player.seek(t);
  await encoder.flush();
  return webm(canvas, pictures, 1000 * k / RATE);
}
