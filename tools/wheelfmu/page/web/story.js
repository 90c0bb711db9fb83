// The card of the story beside the picture: text, something to try, one step on or back, and what a step asks.
import {$, makeButton, onChange} from '#dom';

/** What the motion says of the reader's guess. */
function verdictOf({guess, steps, step, page: {wheels, plots: {curves: [tilt]}}}) {
  const {fates, right} = steps[step].question;
  if (fates) {
    const fate = fates[right(...wheels)];
    return guess.picked === undefined ? '' :
        fates[guess.picked] === fate  ? `As you guessed: ${fate}` :
                                        `Not so: ${fate}`;
  }
  if (!(tilt.sketch?.length > 1)) return '';
  const off = tilt.lines[0].points.map(([t, theta]) => Math.abs(tilt.guessed(t) - theta)).filter((error) => error >= 0);
  return `Your line (dashed) is off by ${
      (off.reduce((sum, error) => sum + error, 0) / off.length).toFixed(1)}° in the mean.`;
}

/** The card with the story beside the picture: text, something to try, one step on or back. */
export function setUpStory(live) {
  const host = $('#story');
  const [count, back, next, again] =
      ['.count', '[name=back]', '[name=next]', '[name=again]'].map((place) => $(`#live ${place}`));
  [back.onclick, next.onclick, again.onclick] = [-1, 1, 0].map((by) => () => live.turn(by));
  const write = onChange((words) => {
    const {steps, step, steps: {[step]: {title, attempt}}} = live;
    const html = [title, words, `<b>Try</b> ${attempt}`];
    ['h2', '.text', '.try'].forEach((place, i) => ($(place, host).innerHTML = html[i]));
    count.textContent = `${step + 1} of ${steps.length}`;
    [back.disabled, next.disabled] = [step === 0, step === steps.length - 1];
  });
  const fates = $('.guess', host);
  const ask = onChange((question) => {
    const options =
        question?.fates?.map((textContent, name) => ({name, textContent, title: 'Your guess; then it plays'}));
    fates.replaceChildren(...options?.map((option) => makeButton(option, () => live.pick(option.name))) ?? []);
  });
  const judge = onChange((words) => {
    $('.verdict', host).hidden = !words;
    $('.verdict', host).textContent = words;
  });
  return () => {
    const {guess, steps, step} = live;
    const question = guess && !guess.told ? steps[step].question : null;
    if (live.open) write(question ? question.text : live.text);
    ask(question);
    fates.hidden = !guess?.asks || !question?.fates;
    judge(guess?.told ? verdictOf(live) : '');
    $('.try', host).hidden = Boolean(question);
    document.body.classList.toggle('asks', Boolean(guess?.asks));
    document.body.classList.toggle('draws', Boolean(guess?.asks && !question?.fates));
    for (const part of [count, back, next]) part.hidden = !live.open;
    const apart = live.open && !live.narrated;  // the text describes the step's own motion
    host.classList.toggle('apart', apart);
    again.hidden = !apart;
  };
}
