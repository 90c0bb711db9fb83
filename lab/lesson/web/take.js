// The card "Export": the values, a picture, a video, and of the live page its link and the commands that make the
// same run.
import {commands} from '#commands';
import {$, make, makeChoice} from '#dom';
import {compose, encodes, film} from '#film';
import {POSE} from '#table';

const FIXED = ['r_0', 'r', 'slope', 'slope_direction'];
const wordOf = (name) => name.replace(/[^\w]+/g, '_');

/** Hands a file to the reader. */
function save(download, blob) {
  const href = URL.createObjectURL(blob);
  make('a', {href, download}).click();
  setTimeout(() => URL.revokeObjectURL(href), 10_000);
}

async function copy(text, {currentTarget: button}) {
  const before = button.textContent;
  try {
    await navigator.clipboard.writeText(text);
    button.textContent = 'Copied';
    setTimeout(() => (button.textContent = before), 1200);
  } catch {  // a page opened from the disk has no clipboard in every browser
    prompt('To copy:', text);
  }
}

/**
 * Bodies as CSV files [[name, content]] in the columns that `./scripts/view` reads back: SI, numbers with all their
 * digits; bodies that share their instants share a file.
 */
function csvFiles(bodies) {
  const groups = Map.groupBy(bodies, ({table}) => table.time.join());
  return [...groups.values()].map((group) => {
    const [{name, table: {time, rows}}] = group;
    const plain = group.length === 1 && POSE.every((column) => group[0].table.has(column));
    const columns = group.flatMap((body) => {
      const prefix = plain ? '' : `${wordOf(body.name)}.`;
      const given = Object.entries(body.parameters ?? {}).filter(([column]) => FIXED.includes(column));
      const fixed = given.map(([column, value]) => [column, Array(rows).fill(value)]);
      const moving = Object.entries(body.table.columns).filter(([column]) => column !== 'time');
      return [...moving, ...fixed].map(([column, values]) => [prefix + column, values]);
    });
    const all = [['time', time], ...columns];
    const lines = Array.from({length: rows}, (_, i) => all.map(([, values]) => values[i]).join(','));
    const head = all.map(([column]) => `"${column}"`).join(',');
    const text = `${head}\n${lines.join('\n')}\n`;
    return [groups.size > 1 ? `${wordOf(name)}.csv` : 'motion.csv', new Blob([text], {type: 'text/csv'})];
  });
}

/** What the buttons of the card do. */
export function setUpTaking(page) {
  const host = $('#take');
  const {live} = page;
  const on = (name, act) => $(`[name=${name}]`, host).addEventListener('click', act);
  on('csv', () => csvFiles([...new Set(page.views.flat())]).forEach((file) => save(...file)));
  on('png', () => {
    page.draw();
    const name = `wheel_${page.player.t.toFixed(2)}s.png`;
    compose(page).toBlob((blob) => save(name, blob), 'image/png');
  });
  let filming = false;
  on('film', async ({currentTarget: button}) => {  // a second click ends it
    filming = !filming;
    if (!filming) return;
    const left = (seconds) => {
      button.textContent = `End the video${seconds < Infinity ? `: ${Math.ceil(seconds)} s left` : ''}`;
      return filming;
    };
    const blob = await film(page, left);
    filming = false;
    button.textContent = 'Video (WebM)';
    save('wheel.webm', blob);
  });
  const title = 'Videos need Chrome or Edge 94, Firefox 130, or later: this browser encodes no VP9';
  encodes().then((can) => can || Object.assign($('[name=film]', host), {disabled: true, title}));
  if (!live) return;
  on('link', (event) => copy(live.link.href, event));
  on('copy', (event) => copy($('pre', host).textContent, event));
  const titles = {fmpy: 'The command line of FMPy', Python: 'A script with FMPy', C: 'A program without any library'};
  const options = Object.entries(titles).map(([name, title]) => ({name, title, textContent: name}));
  const mark = makeChoice($('.tabs', host), options, (name) => {
    mark(name);
    $('pre', host).textContent = commands(live.plan, live.interval, live.fmu.guid)[name];
  });
  mark('fmpy');
  host.addEventListener('beforetoggle', () => $('[aria-checked=true]', host).click());  // for the present plan
}
