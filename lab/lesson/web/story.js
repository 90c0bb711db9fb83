// The card of the story beside the picture: text, something to try, one step on or back, and what a step asks.
import {$, makeButton, onChange, say} from '#dom';
import {Table} from '#table';

/** What the motion says of the reader's guess. */
function verdictOf({guess: {picked}, steps, step, page: {wheels, plots: {curves: [tilt]}}}) {
  const {fates, right} = steps[step].question;
  const fate = fates?.[right(...wheels)];
  if (picked !== undefined) return `${fates[picked] === fate ? 'As you guessed' : 'Not so'}: ${fate}`;
  if (!(tilt.sketch?.length > 1)) return '';
  const [time, theta] = [0, 1].map((i) => tilt.sketch.map((point) => point[i]));
  const drawn = new Table({time, theta});
  const shown = tilt.lines[0].points.filter(([t]) => t <= drawn.end);
  const off = shown.reduce((sum, [t, moved]) => sum + Math.abs(drawn.value('theta', t) - moved), 0);
  return `Your line (dashed) is off by ${(off / shown.length).toFixed(1)}° on average.`;
}

/** The card with the story beside the picture: text, something to try, one step on or back. */
export function setUpStory(live) {
  const host = $('#story');
  const [count, back, next] = ['.count', '[name=back]', '[name=next]'].map((place) => $(`#live ${place}`));
  [back.onclick, next.onclick] = [-1, 1].map((by) => () => live.turn(by));
  const write = onChange((words) => {
    const {steps, step, steps: {[step]: {title, attempt}}} = live;
    const html = [title, words, `<b>Try</b> ${attempt}`];
    ['h2', '.text', '.try'].forEach((place, i) => ($(place, host).innerHTML = html[i]));
    count.textContent = `${step + 1} of ${steps.length}`;
    [back.disabled, next.disabled] = [step === 0, step === steps.length - 1];
  });
  const fates = $('.guess', host);
  const ask = onChange((question) => {
    const button = (textContent, k) =>
        makeButton({textContent, title: 'Your guess; then it plays'}, () => live.pick(k));
    fates.replaceChildren(...(question?.fates ?? []).map(button));
  });
  return () => {
    const {guess, steps, step} = live;
    const question = guess && !guess.told ? steps[step].question : null;
    if (live.open) write(question ? question.text : live.text);
    ask(question);
    fates.hidden = !guess?.asks || !question?.fates;
    say($('.verdict', host), guess?.told ? verdictOf(live) : '');
    $('.try', host).hidden = Boolean(question);
    document.body.classList.toggle('asks', Boolean(guess?.asks));
    document.body.classList.toggle('draws', Boolean(guess?.asks && !question?.fates));
    for (const part of [count, back, next]) part.hidden = !live.open;
    host.classList.toggle('apart', live.open && !live.narrated);  // the text describes the step's own motion
  };
}
