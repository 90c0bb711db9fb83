// The card "Take with you": the values, a picture, a film, and of the live page its link and the commands that make the
// same run.
import {commands} from '#commands';
import {compose, film, films} from '#film';
import {STEP} from '#live';
import {csvFiles} from '#values';

/** Hands a file to the reader. */
function save(name, blob) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

async function copy(text, button) {
  const before = button.textContent;
  try {
    await navigator.clipboard.writeText(text);
  } catch {  // a page opened from the disk has no clipboard in every browser
    const area = document.createElement('textarea');
    area.value = text;
    document.body.append(area);
    area.select();
    document.execCommand('copy');
    area.remove();
  }
  button.textContent = 'Copied';
  setTimeout(() => (button.textContent = before), 1200);
}

class Taking {
  constructor(page, host) {
    Object.assign(this, {page, host, filming: false});
    this.on('csv', () => this.saveValues());
    this.on('png', () => this.savePicture());
    this.on('film', () => this.record());
    if (!films()) Object.assign(this.button('film'), {disabled: true, title: 'This browser records no WebM'});
    const {live} = page;
    this.button('link').hidden = host.querySelector('#commands').hidden = !live;
    if (!live) return;
    this.on('link', (button) => copy(live.link.href, button));
    this.on('copy', (button) => copy(host.querySelector('pre').textContent, button));
    for (const tab of host.querySelectorAll('.tabs button')) tab.addEventListener('click', () => this.tell(tab.name));
    host.addEventListener('toggle', () => host.open && this.tell(this.kind ?? 'fmpy'));
  }

  button(name) { return this.host.querySelector(`button[name=${name}]`); }

  on(name, act) {
    const button = this.button(name);
    button.addEventListener('click', () => act(button));
  }

  /** The commands of one kind, for the motion that is shown now. */
  tell(kind) {
    const {live} = this.page;
    this.kind = kind;
    const run = {plan: live.plan, step: STEP, guid: live.fmu.guid};
    this.host.querySelector('pre').textContent = commands(run, live.fmu.variables)[kind];
    for (const tab of this.host.querySelectorAll('.tabs button')) tab.setAttribute('aria-checked', tab.name === kind);
  }

  saveValues() {
    const bodies = [...new Set(this.page.views.flat())];
    for (const {name, text} of csvFiles(bodies)) save(`${name}.csv`, new Blob([text], {type: 'text/csv'}));
  }

  savePicture() {
    this.page.draw();
    const name = `wheel_${this.page.player.t.toFixed(2)}s.png`;
    compose(this.page).toBlob((blob) => save(name, blob), 'image/png');
  }

  /** Begins a film of the whole motion at the chosen speed; again: ends it there. */
  async record() {
    this.filming = !this.filming;
    if (!this.filming) return;
    const button = this.button('film');
    button.textContent = 'End the film';
    const blob = await film(this.page, () => this.filming);
    this.filming = false;
    button.textContent = 'Film (WebM)';
    save('wheel.webm', blob);
  }
}

export function setUpTaking(page) { return new Taking(page, document.querySelector('#take')); }
