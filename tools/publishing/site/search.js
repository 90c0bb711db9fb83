// Ranks the documents of Sphinx's search by how often the words asked for, and above all the whole phrase, stand in
// them. TEXTS: {address of a page: its text}, written by conf.py.
const asked = (new URLSearchParams(location.search).get('q') ?? '').toLowerCase().trim();
const words = asked.split(/\s+/).filter(Boolean);
const often = (text, piece) => Math.log1p(text.toLowerCase().split(piece).length - 1);

/** Sphinx's score counts a word once, wherever it stands; a title that holds it counts most. */
Scorer.score = ([name, , , , score]) => {
  const text = TEXTS[`./${name}.html`] ?? '';
  const single = words.reduce((sum, word) => sum + often(text, word), 0);
  return score + 2 * single + (words.length > 1 ? 12 * often(text, asked) : 0);
};

/** Sphinx takes the excerpt from the main part of a page; a page opened from the disk may fetch none. */
window.fetch = async (address) => new Response(`<p role="main">${_escapeHTML(TEXTS[address] ?? '')}</p>`);
