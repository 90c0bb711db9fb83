// Light, dark, or as the reader's system says; the colours are those of style.css.

const CHOICES = ['auto', 'light', 'dark'];

/** The value of a colour variable of style.css, as text. */
export function colour(name) { return getComputedStyle(document.documentElement).getPropertyValue(name).trim(); }

/** The colour of the i-th wheel. */
export function wheelColour(i) { return colour(`--wheel-${i % 6}`); }

/** Sets up the button; `changed` is called after every change, also of the system's own. */
export function watchTheme(button, changed) {
  const dark = matchMedia('(prefers-color-scheme: dark)');
  let choice = 'auto';
  const apply = () => {
    const system = dark.matches ? 'dark' : 'light';
    document.documentElement.dataset.theme = choice === 'auto' ? system : choice;
    button.textContent = {auto: '◐', light: '☀', dark: '☾'}[choice];
    button.title = `Colours: ${choice === 'auto' ? 'as the system' : choice}. Click to change`;
    button.setAttribute('aria-label', button.title);
    changed();
  };
  button.addEventListener('click', () => {
    choice = CHOICES[(CHOICES.indexOf(choice) + 1) % CHOICES.length];
    apply();
  });
  dark.addEventListener('change', apply);
  apply();
}
