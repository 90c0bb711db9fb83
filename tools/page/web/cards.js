// Cards that open from a button of the header, one at a time; Escape or a click elsewhere closes them. The card
// "Values" lists the parameters of the wheels that are shown.

export function setUpCards() {
  const cards = [...document.querySelectorAll('details.popup')];
  const close = (kept) => cards.filter((card) => card !== kept).forEach((card) => (card.open = false));
  addEventListener('pointerdown', ({target}) => close(cards.find((card) => card.contains(target))));
  addEventListener('keydown', ({key}) => {
    const open = cards.find((card) => card.open);
    if (key !== 'Escape' || !open) return;
    close();
    open.querySelector('summary').focus();
  });
  for (const card of cards) card.addEventListener('toggle', () => card.open && close(card));
}

/** variables: of the description; wheels(): those shown, with their parameters {name: value}. */
export function setUpValues(variables, wheels) {
  const card = document.querySelector('#values');
  const cell = (row, tag, text) => {
    const place = row.appendChild(document.createElement(tag));
    place.textContent = text;
    return place;
  };
  card.addEventListener('toggle', () => {
    if (!card.open) return;
    const table = document.createElement('table');
    const shown = wheels().filter(({parameters}) => parameters);
    const head = table.appendChild(document.createElement('tr'));
    for (const text of ['', ...shown.map(({label}) => label), '']) cell(head, 'th', text);
    for (const name of Object.keys(variables)) {
      const values = shown.map(({parameters}) => parameters[name]);
      if (values.every((value) => value === undefined)) continue;
      const row = table.appendChild(document.createElement('tr'));
      row.title = variables[name].meaning;
      cell(row, 'th', name);
      for (const value of values) cell(row, 'td', value === undefined ? '' : String(Number(value.toPrecision(6))));
      cell(row, 'td', variables[name].unit);
    }
    card.querySelector('.card').replaceChildren(table);
  });
}
