// What the reader can switch on and off in the scene, and the keys of the page.
import {setUpKeys} from '#transport';

/** Builds on the boxes of page.html; returns {show: {name: on}, flip(name, on)}. */
export function setUpSwitches(page) {
  const boxes = Object.fromEntries([...document.querySelectorAll('#toggles input')].map((box) => [box.name, box]));
  const show = Object.fromEntries(Object.entries(boxes).map(([name, box]) => [name, box.checked]));
  const flip = (name, on) => {
    boxes[name].checked = show[name] = on;
    page.stage.dirty = true;
  };
  for (const [name, box] of Object.entries(boxes)) box.addEventListener('change', () => flip(name, box.checked));
  const toggle = (name) => () => flip(name, !show[name]);
  const actions = {f: toggle('follow'), p: toggle('path'), a: toggle('axes'), g: toggle('force')};
  actions.r = () => page.stage.home();
  actions.d = () => page.plots.portrait.next();
  actions.n = () => page.live?.panel.story.move(1);
  actions.b = () => page.live?.panel.story.move(-1);
  for (let i = 0; i < 9; ++i) actions[i + 1] = () => i < page.choices.length && page.choose(i);
  setUpKeys(page.player, actions);
  return {show, flip};
}
