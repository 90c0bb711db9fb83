// Ranks the documents of Sphinx's search by how often the words asked for, and above all the whole phrase, stand in
// them, and adds an excerpt to each. TEXTS: {document: its text}, written by conf.py.
const asked = (new URLSearchParams(location.search).get('q') ?? '').toLowerCase().trim();
const words = asked.split(/\s+/).filter(Boolean);
const count = (text, piece) => piece ? text.toLowerCase().split(piece).length - 1 : 0;

/** Sphinx's score counts a word once, wherever it stands; a title that holds it counts most. */
Scorer.score = ([name, , , , score]) => {
  const text = TEXTS[name] ?? '';
  const often = words.reduce((sum, word) => sum + Math.log1p(count(text, word)), 0);
  return score + 2 * often + (words.length > 1 ? 12 * Math.log1p(count(text, asked)) : 0);
};

/** The surroundings of the phrase, or of its first word that is there, with the words marked. */
function excerpt(text) {
  const low = text.toLowerCase();
  const at = [asked, ...words].map((piece) => low.indexOf(piece)).find((place) => place >= 0) ?? 0;
  const [from, to] = [Math.max(0, text.lastIndexOf(' ', Math.max(0, at - 90)) + 1), Math.min(text.length, at + 170)];
  const part = document.createElement('p');
  const marks = words.map((word) => word.replace(/[^\w]/g, '\\$&')).join('|');
  part.append(from > 0 ? '… ' : '');
  text.slice(from, to).split(new RegExp(`(${marks})`, 'i')).forEach((piece, i) => {
    const mark = document.createElement(i % 2 ? 'mark' : 'span');
    mark.textContent = piece;
    part.append(mark);
  });
  part.append(to < text.length ? ' …' : '');
  return part;
}

new MutationObserver((changes) => {
  for (const item of changes.flatMap(({addedNodes}) => [...addedNodes])) {
    const name = item.querySelector?.(':scope > a')?.getAttribute('href')?.replace(/\.html.*/, '');
    if (item.tagName === 'LI' && TEXTS[name] && !item.querySelector('p')) item.append(excerpt(TEXTS[name]));
  }
}).observe(document.querySelector('#search-results'), {childList: true, subtree: true});
