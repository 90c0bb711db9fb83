// What rights a wheel: the moments about e1 as bars beside the picture, which has them as arrows (bodies.js).
import {$, fixed, make, subscripted} from '#dom';
import {balance} from '#mechanics';

const TERMS = [
  ['weight', 'weight', '−N r_0 cos θ'],
  ['side', 'side force', 'λ_y Z_O'],
  ['gyro', 'gyroscopic', '−(J_z ω_z − J_x ψ̇ cos θ) ψ̇ sin θ'],
  ['sum', 'sum', 'J_x θ̈'],
];

/** Values in tenths, of which the last is the sum of the others. */
function tenths(values) {
  const terms = values.slice(0, -1).map((value) => Math.round(10 * value));
  return [...terms, terms.reduce((sum, value) => sum + value)].map((value) => fixed(value / 10, 1));
}

/** The moments about e1 as bars beside the picture of what rights the wheel: to the right those that right it. */
export function setUpBalance(live) {
  const host = $('#balance');
  const rows = TERMS.map(([className, name, formula]) => {
    const [bar, number] = [make('i'), make('output')];
    const words = make(
        'span', {title: formula.replaceAll('_', '')}, make('b', {}, name), ' ',
        make('small', {}, ...subscripted(formula)));
    host.append(make(
        'p', {className, style: `--own: var(--${className})`}, words, make('span', {className: 'bar'}, bar), number));
    return {bar, number};
  });
  return (wheel) => {
    host.hidden = !live.drawsBalance;
    if (host.hidden) return;
    const at = (name) => live.wheel.table.value(name, live.instant());
    const moments = balance(wheel, at);
    const values = TERMS.map(([name]) => moments[name]);
    const side = Math.cos(at('theta')) < 0 ? -1 : 1;  // a moment along e1 rights a wheel that leans with theta < 90 deg
    const whole = wheel.m * wheel.g * wheel.r_0;
    tenths(values).forEach((text, i) => {
      const {bar, number} = rows[i];
      const part = Math.max(-0.5, Math.min(0.5, side * values[i] / whole));
      if (number.textContent !== text) number.textContent = text;
      Object.assign(bar.style, {left: `${50 + 100 * Math.min(0, part)}%`, width: `${100 * Math.abs(part)}%`});
    });
  };
}
