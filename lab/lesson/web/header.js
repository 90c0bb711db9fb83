// The header: the parameters of what is shown in the card "Values", and the button for light, dark, or as the system.
import {$, make, variables} from '#dom';

const THEMES = [['as the system', '◐'], ['light', '☀'], ['dark', '☾']];

/** A unit as one writes it: kg m², nothing for 1. */
const written = (unit) => (unit === '1' ? '' : unit.replace('.', ' ').replace(/2$/, '²'));

export function setUpValues(page) {
  const row = (title, kind, first, ...cells) =>
      make('tr', {title}, make('th', {}, first), ...cells.map((text) => make(kind, {}, text)));
  $('[popovertarget=values]').hidden = !page.wheels.length;
  $('#values').addEventListener('beforetoggle', ({newState}) => {
    if (newState !== 'open') return;
    const {shown} = page;
    const known = Object.entries(variables).filter(([name]) => shown.some(({parameters}) => name in parameters));
    const rows = known.map(([name, {description, unit}]) => {
      const values = shown.map(({parameters}) => parameters[name]?.toPrecision(6));
      return row(description, 'td', name, ...values.map((text) => (text ? String(Number(text)) : '')), written(unit));
    });
    $('#values').replaceChildren(
        make('table', {}, row('', 'th', 'parameter', ...shown.map(({label}) => label), 'unit'), ...rows));
  });
}

/** Sets up the button for the theme; `changed` is called after every change, also of the system's own. */
export function watchTheme(changed) {
  const button = $('#theme');
  const dark = matchMedia('(prefers-color-scheme: dark)');
  let choice = 0;
  const apply = () => {
    const [name, symbol] = THEMES[choice];
    document.documentElement.dataset.theme = choice > 0 ? name : dark.matches ? 'dark' : 'light';
    button.textContent = symbol;
    button.title = button.ariaLabel = `Colours: ${name}. Click to change`;
    changed();
  };
  button.addEventListener('click', () => {
    choice = (choice + 1) % THEMES.length;
    apply();
  });
  dark.addEventListener('change', apply);
  addEventListener('message', ({source, data}) => {  // of a page that shows this one, and has a button itself
    const asked = THEMES.findIndex(([name]) => name === data?.theme);
    if (source !== parent || asked < 1) return;
    choice = asked;
    button.hidden = true;
    apply();
  });
  apply();
}
