// The card "Export": the values and a picture.
import {$, colour, make, write} from '#dom';
import {POSE} from '#table';

const GAP = 10;  // CSS pixels
const wordOf = (name) => name.replace(/[^\w]+/g, '_');

/** Hands a file to the reader. */
function save(download, blob) {
  const href = URL.createObjectURL(blob);
  make('a', {href, download}).click();
  setTimeout(() => URL.revokeObjectURL(href), 10_000);
}

/**
 * Wheels as CSV files [[name, content]] in the columns that `./scripts/view` reads back: SI, numbers with all their
 * digits, and every parameter but the start; wheels that share their instants share a file.
 */
function csvFiles(wheels) {
  const groups = Map.groupBy(wheels, ({table}) => table.time.join());
  return [...groups.values()].map((group) => {
    const [{name, table: {time, rows}}] = group;
    const plain = group.length === 1 && POSE.every((column) => group[0].table.has(column));
    const columns = group.flatMap(({name: own, table, parameters}) => {
      const prefix = plain ? '' : `${wordOf(own)}.`;
      const given = Object.entries(parameters).filter(([column]) => !column.endsWith('_start') && !table.has(column));
      const fixed = given.map(([column, value]) => [column, Array(rows).fill(value)]);
      const moving = Object.entries(table.columns).filter(([column]) => column !== 'time');
      return [...moving, ...fixed].map(([column, values]) => [prefix + column, values]);
    });
    const all = [['time', time], ...columns];
    const lines = Array.from({length: rows}, (_, i) => all.map(([, values]) => values[i]).join(','));
    const head = all.map(([column]) => `"${column}"`).join(',');
    const text = `${head}\n${lines.join('\n')}\n`;
    return [groups.size > 1 ? `${wordOf(name)}.csv` : 'motion.csv', new Blob([text], {type: 'text/csv'})];
  });
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

/** The page at the present instant on a canvas: scene, key of the arrows, diagrams. */
function compose(page) {
  const {stage, plots, player} = page;
  const {ratio} = stage;
  const {clientWidth: width, clientHeight: height} = stage.canvas;
  const host = $('#plots').getBoundingClientRect();
  const scale = (width - GAP) / host.width;
  const [right, below] = [width, height + 3 * GAP + scale * host.height + GAP].map((edge) => Math.round(ratio * edge));
  const canvas = make('canvas', {width: right, height: below});
  const pen = canvas.getContext('2d', {alpha: false});
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.fillStyle = colour('--paper');
  pen.fillRect(0, 0, canvas.width, canvas.height);
  pen.drawImage(stage.canvas, 0, 0, width, height);
  Object.assign(pen, {textBaseline: 'middle', textAlign: 'left'});
  drawLabels(pen, page);
  write(pen, `t = ${player.t.toFixed(2)} s`, width - 106, height - 20, 15);
  write(pen, [...$('#legend').children].map(({textContent}) => textContent).join(' · '), GAP, height + 1.3 * GAP, 13);
  for (const {canvas: drawn, kind} of plots.all.filter(({figure}) => !figure.hidden)) {
    const place = drawn.getBoundingClientRect();
    const [x, y] = [scale * (place.left - host.left), height + 3 * GAP + scale * (place.top - host.top)];
    pen.drawImage(drawn, x, y, scale * place.width, scale * place.height);
    write(pen, kind.unit ? `${kind.title} [${kind.unit}]` : kind.title, x + 6, y - 10 * scale, 13 * scale);
  }
  return canvas;
}

/** What the buttons of the card do. */
export function setUpTaking(page) {
  const host = $('#take');
  const on = (name, act) => $(`[name=${name}]`, host).addEventListener('click', act);
  on('csv', () => csvFiles([...new Set(page.views.flat())]).forEach((file) => save(...file)));
  on('png', () => {
    page.draw();
    const name = `wheel_${page.player.t.toFixed(2)}s.png`;
    compose(page).toBlob((blob) => save(name, blob), 'image/png');
  });
}
