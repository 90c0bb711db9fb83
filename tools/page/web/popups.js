// Cards that open from a button of the header: one at a time; Escape or a click elsewhere closes them.

export function setUpPopups() {
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
