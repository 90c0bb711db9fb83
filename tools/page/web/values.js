// What is shown as CSV, in the columns that `./scripts/view` reads back: SI, numbers with all their digits.

const POSE = ['X_O', 'Y_O', 'Z_O', 'psi', 'theta', 'phi'];

/** The columns of one body, with a wheel's radii and its road's slope; prefix: '' or the body's name and a dot. */
function columnsOf(body, prefix) {
  const {table} = body;
  const names = Object.keys(table.columns).filter((name) => name !== 'time');
  const columns = names.map((name) => [prefix + name, (row) => table.columns[name][row]]);
  const fixed = ['r_0', 'r', 'slope', 'slope_direction'].filter((name) => name in body);
  return [...columns, ...fixed.map((name) => [prefix + name, () => body[name]])];
}

const sameTime = (a, b) => a.length === b.length && a.every((t, i) => t === b[i]);

/** Files [{name, text}]: bodies that share their instants share a file. */
export function csvFiles(bodies) {
  const groups = [];
  for (const body of bodies) {
    const group = groups.find(([first]) => sameTime(first.table.time, body.table.time));
    if (group)
      group.push(body);
    else
      groups.push([body]);
  }
  return groups.map((group) => {
    const {time, rows} = group[0].table;
    const plain = group.length === 1 && POSE.every((name) => group[0].table.has(name));
    const columns = group.flatMap((body) => columnsOf(body, plain ? '' : `${body.name.replace(/[^\w]+/g, '_')}.`));
    const lines = Array.from({length: rows}, (_, i) => [time[i], ...columns.map(([, at]) => at(i))].join(','));
    const head = ['time', ...columns.map(([name]) => name)].map((name) => `"${name}"`).join(',');
    return {
      name: groups.length > 1 ? group[0].name.replace(/[^\w]+/g, '_') : 'motion',
      text: `${head}\n${lines.join('\n')}\n`
    };
  });
}
